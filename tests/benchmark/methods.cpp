// Times of whole methods: assembly, first factorization and all steps, in memory, without reading. Both
// programs track the largest |u| and |v| of the loaded DOF at every step, and record nothing else.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "plain/plain.hpp"
#include "suite.hpp"
#include "support/scene_run.hpp"

namespace butee::benchmarks {
namespace {

struct Chosen {
  std::string name;  ///< name in the table
  plain::Case its;   ///< name, step and end
};

std::vector<Chosen> chosen_cases() {
  std::vector<Chosen> all;
  for (const plain::Case& one : plain::cases()) {
    const bool fine = one.name == "oscillator" && one.time_step < 1e-5;
    const bool long_chaos = one.name == "beam4" && one.end_time > 0.3;
    if (!fine && !long_chaos) all.push_back({one.name == "beam4" ? "beam4-short" : one.name, one});
  }
  return all;
}

/// Records the same quantities as the plain program at every step.
class Peaks final : public time::Observer {
 public:
  explicit Peaks(Index dof) : dof_(dof) {}
  void start(const time::State& state) override { look(state); }
  void step(const time::AcceptedStep& step) override { look(step.to); }

  double u = 0.0, v = 0.0;

 private:
  void look(const time::State& state) {
    u = std::max(u, std::abs(state.x[dof_]));
    v = std::max(v, std::abs(state.v[dof_]));
  }

  Index dof_;
};

time::RunReport run_once(scene::Scene& session) {
  scene::Assembly assembly(session);
  time::Simulation& simulation = assembly.simulation;
  Peaks peaks(assembly.system.loads.front().dofs.front());
  simulation.add(peaks);
  const time::RunReport report = simulation.run();
  benchmark::DoNotOptimize(peaks.u + peaks.v);
  return report;
}

/// Attempted steps; used to compare methods whose steps depend on rounding.
void show_steps(benchmark::State& state, double steps, double rejected, double newton) {
  state.counters["attempts"] = steps + rejected;
  if (newton > 0.0) state.counters["newton"] = newton;  // JSON cannot hold the relative scatter of zeros
}

void time_butee(benchmark::State& state, const Chosen& chosen, const std::string& method) {
  scene::Scene session =
      test::read_scene(test::read_file(test::model_path(chosen.its.name)),
                       {"integrator.type=" + method, "integrator.end_time=" + std::to_string(chosen.its.end_time)});
  time::RunReport report;
  for (auto _ : state) report = run_once(session);
  if (!report.completed) state.SkipWithError(report.message.c_str());
  show_steps(state, static_cast<double>(report.steps), static_cast<double>(report.rejected),
             static_cast<double>(report.newton_iterations));
}

void time_plain(benchmark::State& state, const Chosen& chosen, plain::Method method) {
  const plain::Problem problem = plain::make_problem<double>(chosen.its.name, plain::Law::kArctan);
  const plain::Options options = plain::make_options(chosen.its, method);
  plain::Result result;
  for (auto _ : state) result = plain::run(problem, method, options);
  if (!result.completed) state.SkipWithError("the step fell below its floor");
  show_steps(state, static_cast<double>(result.steps), static_cast<double>(result.rejected),
             static_cast<double>(result.newton));
}

}  // namespace

void register_methods() {
  for (const Chosen& chosen : chosen_cases())
    for (const plain::Method method : plain::methods()) {
      const std::string short_name = plain::to_string(method);
      const std::string name = "method/" + chosen.name + "/" + short_name + "/";
      benchmark::RegisterBenchmark((name + "butee").c_str(), time_butee, chosen, short_name)
          ->Unit(benchmark::kMillisecond);
      benchmark::RegisterBenchmark((name + "plain").c_str(), time_plain, chosen, method)->Unit(benchmark::kMillisecond);
    }
}

}  // namespace butee::benchmarks
