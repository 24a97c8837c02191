// Large scenes: cost of set-up and of a step from 1e3 to 1e6 DOFs, for one long beam and for 16 coupled
// beams.
#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <sys/resource.h>

#include <benchmark/benchmark.h>

#include "suite.hpp"
#include "support/large_scenes.hpp"
#include "support/scene_run.hpp"

namespace butee::benchmarks {
namespace {

/// Number of timed steps; the smallest time counts.
constexpr int kSteps = 20;

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// The peak memory of this process, GiB.
double most_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / (1024.0 * 1024.0);
}

/// Reads, assembles, factorizes and takes some steps; each part is timed once.
void measure(benchmark::State& state, const std::string& scene, const std::string& method) {
  std::optional<scene::Scene> session;
  std::optional<model::System> system;
  const double read = seconds_of([&] { session.emplace(test::read_scene(scene, {"integrator.type=" + method})); });
  const double assembly = seconds_of([&] { system.emplace(assemble(session->model)); });
  dynamics::Dynamics dynamics(*system);
  const auto& choice = session->integrator;
  const auto integrator = session->catalogue.load(choice.name).make(choice.parameters, dynamics);
  time::Simulation simulation(dynamics, *integrator, choice.options);
  const double start = seconds_of([&] { simulation.start(); });
  const double first_step = seconds_of([&] { simulation.advance(); });
  double step = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps; ++i) step = std::min(step, seconds_of([&] { simulation.advance(); }));

  state.counters["DOFs"] = static_cast<double>(system->size());
  state.counters["read_s"] = read;
  state.counters["assemble_s"] = assembly;
  state.counters["start_s"] = start;
  state.counters["first_step_s"] = first_step;
  state.counters["set_up_s"] = read + assembly + start + first_step - step;
  state.counters["ns_per_step_and_DOF"] = 1e9 * step / static_cast<double>(system->size());
  state.counters["GiB"] = most_memory();
}

void add(const std::string& name, const std::function<std::string()>& scene) {
  for (const std::string method : {"NM1", "RK4-1"})
    benchmark::RegisterBenchmark(("scale/" + name + "/" + method).c_str(),
                                 [scene, method](benchmark::State& state) {
                                   const std::string text = scene();
                                   for (auto _ : state) measure(state, text, method);
                                 })
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
}

}  // namespace

void register_scale() {
  for (const int dofs : {1000, 10000, 100000, 1000000}) {
    add("beam/" + std::to_string(dofs), [dofs] { return test::long_beam(test::elements_of_long_beam(dofs)); });
    add("tied/" + std::to_string(dofs), [dofs] { return test::tied_beams(test::elements_of_tied_beams(dofs)); });
  }
}

}  // namespace butee::benchmarks
