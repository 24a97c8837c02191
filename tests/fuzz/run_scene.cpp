#include <cmath>
#include <cstdlib>

#include <butee/core/error.hpp>
#include <butee/record/energy.hpp>
#include <butee/record/history.hpp>
#include <butee/record/impacts.hpp>
#include <butee/scene/assembly.hpp>

#include "scene_input.hpp"

namespace {

using namespace butee;

constexpr Index kMostDofs = 24;
constexpr int kMostSteps = 12;
/// Most rows of the history; it bounds the output within one long step.
constexpr double kMostRows = 2000.0;

void run(scene::Scene& scene) {
  if (number_dofs(scene.model).free_count() > kMostDofs) return;
  scene::Assembly assembly(scene);
  dynamics::Dynamics& dynamics = assembly.dynamics;
  time::Simulation& simulation = assembly.simulation;
  const double end_time = scene.integrator.options.end_time;
  const bool has_history = !scene.output.interval || end_time / *scene.output.interval < kMostRows;
  record::HistoryRecorder history(scene.output, end_time, dynamics, nullptr);
  record::EnergyRecorder energy(dynamics);
  record::ImpactRecorder impacts(dynamics);
  if (has_history) simulation.add(history);
  if (scene.output.energy) simulation.add(energy);
  if (scene.output.impacts) simulation.add(impacts);
  for (int i = 0; i < kMostSteps && simulation.advance(); ++i)
    if (!simulation.state().x.allFinite() || !simulation.state().v.allFinite()) std::abort();
}

}  // namespace

/// Any bytes that form a scene can be run: the first steps end in finite states or in an error message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto input = fuzz::read_scene_input(data, size);
  if (!input) return 0;
  try {
    run(*input);
  } catch (const InputError&) {
    return 0;
  }
  return 0;
}
