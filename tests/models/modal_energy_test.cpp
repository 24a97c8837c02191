#include <butee/record/energy.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::modal_energy_test {
namespace {

/// The motion is accurate to 1e-6, and the integrals of `exact` to rounding. Modes that oscillate within a
/// step have a larger error in the dissipation, especially with stiffness-proportional damping; relative to
/// the energy it is 1e-5.
constexpr double kOfWork = 1e-4, kOfDissipation = 1e-3, kOfBalance = 1e-5;

struct Followed {
  double work, dissipated, balance_error;
  record::Energy end;
};

Followed follow(const std::string& scene, const std::string& method) {
  std::vector<std::string> overrides = {"integrator.type=" + method, "integrator.end_time=0.2",
                                        "damping.stiffness_proportional=1e-6"};
  if (method == "exponential") overrides.push_back("integrator.tolerance=1e-6");
  SceneRun run(scene, overrides);
  record::EnergyRecorder energy(run.dynamics());
  run.simulation().add(energy);
  EXPECT_TRUE(run.run().completed);
  return {energy.work(), energy.dissipated(), energy.balance_error(),
          record::energy_of(run.simulation().state(), run.dynamics())};
}

/// The work of the loads, the dissipation and the energies that `exponential` computes from its modes,
/// compared with those of `exact`, integrated in physical coordinates.
class ModalEnergy : public testing::TestWithParam<std::string> {};

TEST_P(ModalEnergy, IsThatOfTheMotionInPhysicalCoordinates) {
  const std::string scene = with_linear_law(GetParam());
  const Followed modal = follow(scene, "exponential"), physical = follow(scene, "exact");
  EXPECT_NEAR(modal.work, physical.work, kOfWork * std::abs(physical.work));
  EXPECT_NEAR(modal.dissipated, physical.dissipated, kOfDissipation * physical.dissipated);
  EXPECT_NEAR(modal.balance_error, 0.0, kOfBalance);
  EXPECT_NEAR(physical.balance_error, 0.0, 1e-10);
  EXPECT_NEAR(modal.end.total(), physical.end.total(), kOfWork * physical.end.total());
}

INSTANTIATE_TEST_SUITE_P(Scenes, ModalEnergy, testing::Values("oscillator", "beam1", "beam3"),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace butee::test::modal_energy_test
