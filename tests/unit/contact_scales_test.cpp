#include "integrators/exponential/contact_scales.hpp"

#include <butee/dynamics/dynamics.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::contact_scales_test {
namespace {

using integrators::ContactScales;
using integrators::ModalState;

/// A stop between masses of 4 kg and 1 kg, and one between the first mass and ground.
const std::string kScene = two_masses(R"(
[[element]]
type = "spring"
node = "a"
stiffness = 8.0
[[element]]
type = "spring"
node = "b"
stiffness = 3.0
[[contact]]
type = "stop"
between = ["a", "b"]
gap = 0.1
stiffness = 3.0
[[contact]]
type = "stop"
nodes = "a"
gap = 0.1
stiffness = 3.0
)");

struct Scene {
  SceneRun run{kScene};
  dynamics::ModalSystem& modal = run.dynamics().modal(0);
  ContactScales scales{modal, run.dynamics().stops()};

  ModalState state_of(double a, double b, double va, double vb) {
    ModalState state;
    state.resize(modal);
    Vector x(2), v(2);
    x[run.dof("a")] = a, x[run.dof("b")] = b, v[run.dof("a")] = va, v[run.dof("b")] = vb;
    modal.to_modal(x, state.q.matrix());
    modal.to_modal(v, state.v.matrix());
    state.find_stops(modal.stop_shapes());
    return state;
  }
};

/// A force of the stop moves the masses by 1/5 and 4/5 of the stop's relative displacement.
TEST(ContactScales, OfAPairAreThoseOfTheBodyThatItsForceMovesMostForItsScale) {
  Scene scene;
  scene.scales.load(std::vector<double>(12, 0.0).data(), {1.0, 10.0});
  ASSERT_EQ(scene.scales.memory_size(), 8);
  scene.scales.raise(scene.state_of(0.5, 0.9, 2.0, -3.0));
  integrators::ContactScale scale = scene.scales.of(0, {}, 1.0);
  EXPECT_NEAR(scale.displacement, std::min(0.5 / 0.2, 0.9 / 0.8), 1e-14);
  EXPECT_NEAR(scale.speed, std::min(2.0 / 0.2, 3.0 / 0.8), 1e-14);
  scene.scales.raise(scene.state_of(-0.1, -8.0, 0.0, 0.0));  // Scales never decrease.
  scale = scene.scales.of(0, {}, 1.0);
  EXPECT_NEAR(scale.displacement, 0.5 / 0.2, 1e-14);
}

/// At a start from rest nothing else gives a pair a scale; an error of the step could otherwise not be relative to one.
TEST(ContactScales, OfAPairAtRestComeFromTheStepUnderTrial) {
  Scene scene;
  scene.scales.load(std::vector<double>(12, 0.0).data(), {0.0, 0.0});
  const integrators::ContactScale scale = scene.scales.of(0, {1e-9, 1e-6}, 1e-9);
  EXPECT_NEAR(scale.displacement, 1e-12 / 0.8, 1e-26);
  EXPECT_NEAR(scale.speed, 1e-9 / 0.8, 1e-23);
}

TEST(ContactScales, OfAStopAreItsLargestValuesSoFarAndAThousandthOfAllOthers) {
  Scene scene;
  scene.scales.load(std::vector<double>(8, 0.0).data(), {1.0, 10.0});
  EXPECT_EQ(scene.scales.of(1, {}, 1.0).displacement, 1e-3);
  EXPECT_EQ(scene.scales.of(1, {}, 1.0).speed, 1e-2);
  EXPECT_EQ(scene.scales.of(1, {0.3, 0.4}, 1.0).displacement, 0.3);
  scene.scales.raise(scene.state_of(-0.5, 0.9, 2.0, -3.0));
  EXPECT_NEAR(scene.scales.of(1, {0.3, 0.4}, 1.0).displacement, 0.5, 1e-15);
  EXPECT_NEAR(scene.scales.of(1, {0.3, 0.4}, 1.0).speed, 2.0, 1e-14);
}

/// The residual force of a stop between two bodies is weighted by the scale of the body that it moves most.
TEST(ContactScales, TellTheShareOfEachStop) {
  Scene scene;
  scene.scales.load(std::vector<double>(12, 0.0).data(), {1.0, 10.0});
  scene.scales.raise(scene.state_of(0.01, 0.9, 2.0, -3.0));
  Eigen::ArrayXd shares;
  scene.scales.find_shares(Eigen::ArrayXd::Zero(scene.state_of(0.0, 0.0, 0.0, 0.0).w.size()), 1.0, shares);
  EXPECT_NEAR(shares[0], 0.01 / 0.2, 1e-14);  // fraction of |w| = 0.89
  EXPECT_NEAR(shares[1], 0.01, 1e-14);
}

TEST(ContactScales, AreAPartOfTheState) {
  Scene scene;
  std::vector<double> memory(8), other(8);
  const ModalState state = scene.state_of(0.5, -0.9, 2.0, -3.0);
  const std::vector<double> w = {state.w[0], state.w[1], state.wv[0], state.wv[1]};
  scene.scales.start(state.q.data(), state.v.data(), w.data(), memory.data());
  scene.scales.load(memory.data(), {1.0, 1.0});
  scene.scales.save(other.data());
  EXPECT_EQ(memory, other);
  EXPECT_NEAR(other[4], 0.5, 1e-15);  // |x_a|, |x_b|, |v_a|, |v_b| of the pair
  EXPECT_NEAR(other[5], 0.9, 1e-15);
  EXPECT_NEAR(other[6], 2.0, 1e-14);
  EXPECT_NEAR(other[7], 3.0, 1e-14);
}

}  // namespace
}  // namespace butee::test::contact_scales_test
