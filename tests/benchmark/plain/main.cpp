#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "plain.hpp"

namespace {

using namespace plain;

constexpr const char* kUsage =
    "usage: plain methods                          both laws, all cases, all methods as CSV\n"
    "       plain reference CASE                   the exact solution with the linear law as CSV\n"
    "       plain run CASE METHOD [LAW] [REPEAT]   one line with the fastest time of REPEAT runs\n"
    "cases: oscillator oscillator-1e-6 beam1 beam2 beam3 beam4 (to 0.3 s: beam4-short)\n"
    "methods: RK4-1 RK4-2 RK4-3 NM1 NM2 NMM1 NMM2; laws: arctan linear\n";

void print_row(Law law, const Case& chosen, Method method, const Result& r) {
  std::printf("%s,%s,%s,%g,%g,%ld,%ld,%ld,%.17g,%.17g,%.17g,%.17g\n", to_string(law).c_str(), chosen.name.c_str(),
              to_string(method).c_str(), chosen.time_step, chosen.end_time, r.steps, r.rejected, r.newton, r.u_end,
              r.v_end, r.peak_u, r.peak_v);
}

int print_methods() {
  bool good = true;
  std::puts("# made by: plain methods");
  std::puts("law,case,method,time_step,end_time,steps,rejected,newton_iterations,u_end,v_end,peak_u,peak_v");
  for (const Law law : {Law::kArctan, Law::kLinear})
    for (const Case& chosen : cases()) {
      const Problem problem = make_problem<double>(chosen.name, law);
      for (const Method method : methods()) {
        const Result result = run(problem, method, make_options(chosen, method));
        good = good && result.completed && result.newton_failures == 0;
        print_row(law, chosen, method, result);
        std::fflush(stdout);
      }
    }
  return good ? 0 : 1;
}

int print_reference(const std::string& name) {
  const auto problem = make_problem<long double>(name, Law::kLinear);
  const bool beam = problem.observed >= 0;
  const int per_second = beam ? 100 : 1000;
  const int count = name == "beam4" ? 50 : beam ? 100 : 200;
  const Reference reference = solve_reference(problem, 1.0L / per_second, count);
  std::printf("# made by: plain reference %s (%ld changes of contact)\n", name.c_str(), reference.changes);
  std::puts(beam ? "t,u0,v0,fc0,u1,v1,fc1" : "t,u0,v0,fc0");
  for (const ReferenceRow& r : reference.rows) {
    std::printf("%.17g,%.17Lg,%.17Lg,%.17Lg", static_cast<double>(r.t), r.u0, r.v0, r.fc0);
    if (beam) std::printf(",%.17Lg,%.17Lg,%.17Lg", r.u1, r.v1, r.fc1);
    std::puts("");
  }
  return static_cast<int>(reference.rows.size()) == count + 1 ? 0 : 1;
}

const Case& case_of(const std::string& name) {
  const std::vector<std::string> names = {"oscillator", "oscillator-1e-6", "beam1", "beam2",
                                          "beam3",      "beam4-short",     "beam4"};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return cases()[i];
  throw std::invalid_argument("no case " + name);
}

int print_run(const std::vector<std::string>& arguments) {
  const Case& chosen = case_of(arguments[1]);
  const Method method = method_of(arguments[2]);
  const Law law = law_of(arguments.size() > 3 ? arguments[3] : "arctan");
  const int repeat = arguments.size() > 4 ? std::atoi(arguments[4].c_str()) : 1;
  const Problem problem = make_problem<double>(chosen.name, law);
  Result best = run(problem, method, make_options(chosen, method));
  for (int i = 1; i < repeat; ++i) {
    const Result again = run(problem, method, make_options(chosen, method));
    if (again.seconds < best.seconds) best = again;
  }
  std::printf("%s %s %s: %.6g s, %ld steps, %ld rejected, %ld solves of Newton, u_end %.17g\n", arguments[1].c_str(),
              arguments[2].c_str(), to_string(law).c_str(), best.seconds, best.steps, best.rejected, best.newton,
              best.u_end);
  return best.completed ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 1 && arguments[0] == "methods") return print_methods();
    if (arguments.size() == 2 && arguments[0] == "reference") return print_reference(arguments[1]);
    if (arguments.size() >= 3 && arguments.size() <= 5 && arguments[0] == "run") return print_run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "plain: %s\n", error.what());
    return 2;
  }
  std::fputs(kUsage, stderr);
  return 2;
}
