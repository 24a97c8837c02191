#include "integrators/exponential/exponential_step.hpp"

#include <cmath>

#include <butee/dynamics/dynamics.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::exponential_step_test {
namespace {

using namespace integrators;

/// Two masses that strike their stops; the stops open and close within steps.
const std::string kScene = masses_in_stops(R"(
[[load]]
type = "harmonic"
node = "b"
amplitude = 3.0
angular_frequency = 5.0
)");

struct Steps {
  SceneRun run{kScene};
  dynamics::ModalSystem& modal = run.dynamics().modal(0);
  ExponentialStep step{run.dynamics(), modal, {1e-4, 1e-4, 1e-4, 1.0}, 32};
  int contacts = 0, flights = 0;

  Steps() {
    std::vector<double> memory(static_cast<std::size_t>(step.memory_size()));
    Vector x(2), v(2);
    x << 0.03, 0.01;
    v << 1.0, -0.7;
    const Index n = modal.size();
    modal.to_modal(x, Eigen::Map<Vector>(memory.data(), n));
    modal.to_modal(v, Eigen::Map<Vector>(memory.data() + n, n));
    step.complete(0.0, memory.data());
    step.begin(0.0, memory.data(), {0.1, 1.0});
    for (int k = 0; k < 31; ++k) {
      int index = -11;
      while (index > -40 && step.attempt_index(index) != Trial::accepted) --index;
      ++(step.outcome().is_contact_free ? flights : contacts);
      step.accept(step.t() + dynamics::ModalSystem::grid_step(index));
    }
  }
};

/// Outputs within a step join the end state continuously, whether stops are open, closed or change their
/// status.
TEST(ExponentialStep, HasContinuousOutputs) {
  Steps steps;
  EXPECT_GT(steps.contacts, 5);
  EXPECT_GT(steps.flights, 5);
  constexpr double kBefore = 1e-9;
  std::vector<double> times;
  for (const double t : steps.step.breakpoints()) times.insert(times.end(), {t - kBefore, t});
  std::vector<double> x(2 * times.size()), v(x);
  const std::vector<Index> dofs = {0, 1};
  steps.step.interpolate(times, dofs, {x, v, {}});
  for (std::size_t i = 0; i < times.size(); i += 2)
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_NEAR(x[2 * i + j], x[2 * i + 2 + j], 20.0 * kBefore) << times[i];  // speeds of 10 m/s
      EXPECT_NEAR(v[2 * i + j], v[2 * i + 2 + j], 1e3 * kBefore) << times[i];   // accelerations of 100 m/s2
    }
}

/// The work of the load equals the energy gained by masses, springs and stops.
TEST(ExponentialStep, BalancesItsEnergies) {
  Steps steps;
  const std::vector<double> instants = {0.25 * steps.step.t(), 0.5 * steps.step.t(), steps.step.t()};
  const auto energies = steps.step.energies(instants);
  ASSERT_GE(energies.size(), 3u);
  const double start = 0.5 * (4.0 * 1.0 + 1.0 * 0.49) + 0.5 * (8.0 * 0.03 * 0.03 + 3.0 * 0.02 * 0.02);
  for (const time::EnergyAt& at : energies)
    EXPECT_NEAR(at.kinetic + at.strain + at.contact - at.work, start, 1e-3 * start) << at.t;
}

}  // namespace
}  // namespace butee::test::exponential_step_test
