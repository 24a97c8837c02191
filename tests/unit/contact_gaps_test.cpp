#include "integrators/exponential/contact_gaps.hpp"

#include <limits>
#include <random>

#include <butee/dynamics/dynamics.hpp>
#include <gtest/gtest.h>

#include "integrators/exponential/contact_path.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::contact_gaps_test {
namespace {

using integrators::ContactGaps;
using integrators::kBump;
using integrators::TriedStep;

/// Three stops: on both sides, on the positive side, and on the negative side.
const std::string kScene = mass_on_spring("1.0", R"(
[[contact]]
type = "stop"
nodes = "m"
gap = 0.5
stiffness = 3.0
[[contact]]
type = "stop"
nodes = "m"
gap = 0.25
stiffness = 3.0
sides = "positive"
[[contact]]
type = "stop"
nodes = "m"
gap = 0.125
stiffness = 3.0
sides = "negative"
)");

struct Stops {
  SceneRun run{kScene};
  ContactGaps gaps{run.dynamics().stops()};
  TriedStep step;

  Stops() {
    for (integrators::ModalState* state : {&step.from, &step.to}) state->resize(run.dynamics().modal(0));
  }
};

TEST(ContactGaps, KnowWhenStopsCloseOrOpen) {
  const Stops stops;
  EXPECT_TRUE(stops.gaps.changes(0, 0.4, 0.6, 0.1));
  EXPECT_TRUE(stops.gaps.changes(0, 0.6, -0.6, 0.2));
  EXPECT_FALSE(stops.gaps.changes(0, 0.6, 0.7, 0.2));
  EXPECT_TRUE(stops.gaps.changes(0, 0.4, 0.4, 0.01));  // closes and opens
  EXPECT_FALSE(stops.gaps.changes(0, 0.4, 0.4, -0.01));
  EXPECT_FALSE(stops.gaps.changes(1, -0.6, -0.7, -0.8));
  SceneRun spring(mass_on_spring("1.0", "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.0\nstiffness = 3.0\n"));
  const ContactGaps none(spring.dynamics().stops());
  EXPECT_FALSE(none.changes(0, 0.4, -0.4, 0.4));
  EXPECT_FALSE(none.changes(0, 0.0, 0.4, 0.4));
}

TEST(ContactGaps, KnowTheSidesOnWhichStopsAct) {
  const Stops stops;
  EXPECT_EQ(stops.gaps.closed_side(0, 0.6), 1.0);
  EXPECT_EQ(stops.gaps.closed_side(0, -0.6), -1.0);
  EXPECT_EQ(stops.gaps.closed_side(0, 0.4), 0.0);
  EXPECT_EQ(stops.gaps.closed_side(1, 0.6), 1.0);
  EXPECT_EQ(stops.gaps.closed_side(1, -0.6), 0.0);
  EXPECT_EQ(stops.gaps.closed_side(2, -0.6), -1.0);
  EXPECT_TRUE(stops.gaps.stays_closed(0, 0.6, 0.7));
  EXPECT_FALSE(stops.gaps.stays_closed(0, 0.6, -0.6));
  EXPECT_FALSE(stops.gaps.stays_closed(1, -0.6, -0.7));
}

TEST(ContactGaps, TellTheTimeToTheFirstStopThatIsApproached) {
  Stops stops;
  auto& now = stops.step.from;
  EXPECT_EQ(stops.gaps.time_to_contact(now), std::numeric_limits<double>::infinity());
  now.w.head(3).setConstant(0.1);
  now.wv.head(3).setConstant(0.5);
  EXPECT_NEAR(stops.gaps.time_to_contact(now), 0.3, 1e-15);  // the second stop
  now.wv.head(3).setConstant(-0.5);
  EXPECT_NEAR(stops.gaps.time_to_contact(now), 0.45, 1e-15);  // the third
}

/// Compared with samples of the cubics through random end states.
TEST(ContactGaps, BoundCubicPathsOnTheSidesOnWhichStopsAct) {
  Stops stops;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Eigen::ArrayXd bounds;
  stops.step.h = 0.7;
  for (int i = 0; i < 200; ++i) {
    auto &from = stops.step.from, &to = stops.step.to;
    for (Index j = 0; j < 3; ++j) {
      from.w[j] = number(random), from.wv[j] = 4.0 * number(random);
      to.w[j] = number(random), to.wv[j] = 4.0 * number(random);
    }
    stops.gaps.bound_displacements(from.w, to.w, (kBump * 0.7) * (from.wv.abs() + to.wv.abs()) + 0.01, bounds);
    for (Index j = 0; j < 3; ++j) {
      const integrators::ContactPath path(from.w[j], 0.7 * from.wv[j], to.w[j], 0.7 * to.wv[j], 0.0);
      double highest = -1e9, lowest = 1e9;
      for (double s = 0.0; s <= 1.0; s += 0.01) {
        highest = std::max(highest, path.value(s));
        lowest = std::min(lowest, path.value(s));
      }
      EXPECT_GE(bounds[j], (j == 0 ? std::max(highest, -lowest) : j == 1 ? highest : -lowest) + 0.01) << i << " " << j;
    }
  }
}

TEST(DisplacementBounds, FindStopsThatForcesOfOthersCarryToTheirGap) {
  Stops stops;
  dynamics::ModalSystem& modal = stops.run.dynamics().modal(0);
  integrators::DisplacementBounds bounds(modal, stops.run.dynamics().stops());
  stops.step.h = 1e-3;
  bounds.find(modal.odd(1e-3), stops.step);
  stops.step.iterated = {0};
  dynamics::StopMotion path;
  const Eigen::ArrayXd none = Eigen::ArrayXd::Zero(stops.step.from.w.size());
  path.end = path.speed = path.middle = none;
  EXPECT_FALSE(bounds.find_carried(none, path, stops.step));
  EXPECT_FALSE(bounds.is_near(1));
  // 0.3 m is beyond the gap of the positive side only; a fast path that returns passes all gaps.
  path.end.setConstant(0.3);
  EXPECT_TRUE(bounds.find_carried(none, path, stops.step));
  EXPECT_EQ(stops.step.carried, std::vector<Index>{1});
  bounds.update(stops.step);
  EXPECT_TRUE(bounds.is_near(1));
  EXPECT_FALSE(bounds.is_near(2));
  path.end.setZero();
  path.speed.setConstant(-2.0);
  stops.step.iterated = {0, 1};
  EXPECT_TRUE(bounds.find_carried(-path.speed, path, stops.step));
  EXPECT_EQ(stops.step.carried, (std::vector<Index>{1, 2}));
}

}  // namespace
}  // namespace butee::test::contact_gaps_test
