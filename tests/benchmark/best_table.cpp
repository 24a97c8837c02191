// Compares exponential with the fastest method of the plain program at equal error, each at the best value of
// its parameter. Linear law; errors are the relative rms of the loaded node's displacement against stored
// solutions in 80-bit arithmetic; times are the minimum of several rounds in which both programs run
// alternately.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "plain/plain.hpp"
#include "support/scene_run.hpp"

namespace butee::benchmarks {
namespace {

using Clock = std::chrono::steady_clock;

/// Longest time of a single run of a sweep, s.
constexpr double kTimeLimit = 0.3;
constexpr int kRounds = 15;

struct Outcome {
  double error = std::numeric_limits<double>::infinity(), seconds = 0.0;
};

/// A method with one value of its parameter.
struct Candidate {
  std::string name;
  double value;
  std::function<Outcome()> run;
  Outcome outcome;
};

struct Reference {
  std::vector<double> times, u;
};

struct Chosen {
  std::string scene;
  double end_time;
};

Reference reference_of(const Chosen& chosen) {
  const test::CsvTable table(std::string(BUTEE_TEST_DATA) + "/models/reference/" + chosen.scene + "-linear.csv");
  Reference all{table.column("t"), table.column("u0")};
  const auto last = std::upper_bound(all.times.begin(), all.times.end(), chosen.end_time * (1.0 + 1e-9));
  const auto rows = last - all.times.begin();
  // Row 0 is the initial state.
  return {{all.times.begin() + 1, last}, {all.u.begin() + 1, all.u.begin() + rows}};
}

double error_of(const std::vector<double>& u, const Reference& reference) {
  if (u.size() != reference.u.size()) return std::numeric_limits<double>::infinity();
  const double error = test::relative_rms(u, reference.u);
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

Outcome run_plain(const plain::Problem& problem, plain::Method method, const plain::Options& options,
                  const Reference& reference) {
  const plain::Result result = plain::run(problem, method, options);
  return {result.completed ? error_of(result.u_samples, reference) : std::numeric_limits<double>::infinity(),
          result.seconds};
}

Outcome run_butee(scene::Scene& session, const Reference& reference) {
  const auto begin = Clock::now();
  scene::Assembly assembly(session);
  time::Simulation& simulation = assembly.simulation;
  test::Sampler sampler(assembly.system.loads.front().dofs.front(), reference.times);
  simulation.add(sampler);
  const bool completed = simulation.run().completed;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return {completed ? error_of(sampler.x, reference) : std::numeric_limits<double>::infinity(), seconds};
}

/// Runs values of a parameter, each smaller by the factor `ratio`, until the error is small enough or the run
/// too long.
void sweep(std::vector<Candidate>& all, const std::string& name, double first, double ratio,
           const std::function<std::function<Outcome()>(double)>& at) {
  for (double value = first; value > 1e-14; value *= ratio) {
    Candidate candidate{name, value, at(value), {}};
    candidate.outcome = candidate.run();
    const Outcome outcome = candidate.outcome;
    all.push_back(std::move(candidate));
    if (outcome.error < 3e-5 || outcome.seconds > kTimeLimit) return;
  }
}

std::vector<Candidate> plain_candidates(const Chosen& chosen, const plain::Problem& problem,
                                        const Reference& reference) {
  std::vector<Candidate> all;
  for (const plain::Method method : plain::methods()) {
    plain::Options base = plain::make_options({chosen.scene, 1e-5, chosen.end_time}, method);
    base.samples = reference.times;
    const auto with = [&](double plain::Options::*key) {
      return [&, method, base, key](double value) -> std::function<Outcome()> {
        plain::Options options = base;
        options.*key = value;
        return [&, method, options] { return run_plain(problem, method, options, reference); };
      };
    };
    const std::string name = plain::to_string(method);
    using plain::Method;
    if (method == Method::kRk41 || method == Method::kNm1 || method == Method::kNmm1)
      sweep(all, name, chosen.scene == "oscillator" ? 2e-4 : 1e-2, 0.8, with(&plain::Options::time_step));
    else if (method == Method::kRk42 || method == Method::kRk43)
      sweep(all, name, 1.0, 0.5, with(&plain::Options::tolerance));
    else
      sweep(all, name, 0.1, 0.7, with(&plain::Options::target_error));
  }
  return all;
}

std::vector<Candidate> own_candidates(const Chosen& chosen, const Reference& reference) {
  std::vector<Candidate> all;
  sweep(all, "exponential", 1e-1, 0.8, [&](double value) -> std::function<Outcome()> {
    char tolerance[32];
    std::snprintf(tolerance, sizeof tolerance, "%.6e", value);
    auto session = std::make_unique<scene::Scene>(
        test::read_scene(test::with_linear_law(chosen.scene),
                         {"integrator.type=exponential", "integrator.end_time=" + std::to_string(chosen.end_time),
                          std::string("integrator.tolerance=") + tolerance}));
    return [own = std::shared_ptr<scene::Scene>(std::move(session)), &reference] { return run_butee(*own, reference); };
  });
  return all;
}

Candidate* fastest(std::vector<Candidate>& all, double target) {
  Candidate* best = nullptr;
  for (Candidate& one : all)
    if (one.outcome.error <= target && (best == nullptr || one.outcome.seconds < best->outcome.seconds)) best = &one;
  return best;
}

void compare(const Chosen& chosen) {
  const Reference reference = reference_of(chosen);
  const auto problem = plain::make_problem<double>(chosen.scene, plain::Law::kLinear);
  std::vector<Candidate> by_hand = plain_candidates(chosen, problem, reference),
                         own = own_candidates(chosen, reference);
  for (const double target : {1e-2, 1e-3, 1e-4}) {
    // The fastest time of a sweep may be an outlier: all candidates near it are timed again.
    for (int round = 0; round < kRounds; ++round)
      for (std::vector<Candidate>* side : {&by_hand, &own}) {
        const Candidate* best = fastest(*side, target);
        if (best == nullptr) continue;
        const double limit = 1.5 * best->outcome.seconds;
        for (Candidate& one : *side)
          if (one.outcome.error <= target && one.outcome.seconds <= limit)
            one.outcome.seconds = std::min(one.outcome.seconds, one.run().seconds);
      }
    const Candidate *a = fastest(by_hand, target), *b = fastest(own, target);
    if (a == nullptr || b == nullptr) {
      std::printf("| %s, %g | - |\n", chosen.scene.c_str(), target);
      continue;
    }
    std::printf("| %s | %g | %s at %.2g | %.3f | %.2g | %.3f | %.1f |\n", chosen.scene.c_str(), target, a->name.c_str(),
                a->value, a->outcome.seconds * 1e3, b->value, b->outcome.seconds * 1e3,
                a->outcome.seconds / b->outcome.seconds);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace butee::benchmarks

int main() {
  using namespace butee::benchmarks;
  try {
    std::puts(
        "| scene | error | fastest by hand | ms | tolerance of exponential | ms | ratio "
        "|\n|---|---|---|---|---|---|---|");
    for (const Chosen& chosen :
         {Chosen{"oscillator", 0.1}, {"beam1", 1.0}, {"beam2", 1.0}, {"beam3", 1.0}, {"beam4", 0.3}})
      compare(chosen);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "best-table: %s\n", error.what());
    return 1;
  }
  return 0;
}
