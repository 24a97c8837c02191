#include <cmath>
#include <cstdlib>

#include <butee/core/error.hpp>
#include <butee/record/energy.hpp>
#include <butee/record/history.hpp>
#include <butee/record/impacts.hpp>

#include "scene_input.hpp"

namespace {

using namespace butee;

constexpr Index kMostDofs = 24;
constexpr int kMostSteps = 12;
/// Rows of the history; more would fall into one long step.
constexpr double kMostRows = 2000.0;

void run(fuzz::SceneInput& input) {
  const plugin::IntegratorChoice& choice = *input.scene.integrator;
  const model::System system = assemble(input.scene.model);
  if (system.size() > kMostDofs) return;
  dynamics::Dynamics dynamics(system);
  const auto method = fuzz::catalogue().load(choice.name).make(choice.parameters, dynamics);
  time::Simulation simulation(dynamics, *method, choice.options);
  const bool has_history = !input.output.interval || choice.options.end_time / *input.output.interval < kMostRows;
  record::HistoryRecorder history(input.output, choice.options.end_time, dynamics, nullptr);
  record::EnergyRecorder energy(dynamics);
  record::ImpactRecorder impacts(dynamics);
  if (has_history) simulation.add(history);
  if (input.output.energy) simulation.add(energy);
  if (input.output.impacts) simulation.add(impacts);
  for (int i = 0; i < kMostSteps && simulation.advance(); ++i)
    if (!simulation.state().x.allFinite() || !simulation.state().v.allFinite()) std::abort();
}

}  // namespace

/// Any bytes that are a scene can be run: the first steps end in states that are finite, or in a diagnosis.
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
