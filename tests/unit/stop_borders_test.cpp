// The borders of stops, at which steps of collocation end, and the force beyond the middle of a gap.
#include "integrators/exponential/stop_borders.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::stop_borders_test {
namespace {

using integrators::StepNodes;
using integrators::StopBorders;

constexpr double kGap = 1e-3, kStiffness = 1e5, kRegularization = 1e4;
/// b = 1/(pi lambda), the width of the transition of arctan.
constexpr double kWidth = 1.0 / (std::numbers::pi * kRegularization);

SceneRun scene_with(const std::string& contact) {
  return SceneRun(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 100.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 1e-3\n" +
      contact + "[integrator]\ntype = \"dopri5\"\nend_time = 1.0\n");
}

/// w(s) = from + (to - from) s
StepNodes::Row line(double from, double to) {
  StepNodes::Row coefficients = StepNodes::Row::Zero();
  coefficients[0] = from;
  coefficients[1] = to - from;
  return coefficients;
}

double first_w(SceneRun& run, double from, double to) {
  const StopBorders borders(run.dynamics().stops());
  return from + (to - from) * borders.first_crossing(0, line(from, to), {});
}

TEST(StopBorders, AreTheGapsOfALawWithoutForceWhileOpen) {
  for (const std::string law : {"stiffness = 1e5\n", "law = \"hertz\"\nstiffness = 1e5\n"}) {
    SceneRun run = scene_with(law);
    EXPECT_NEAR(first_w(run, -0.5e-3, 2e-3), kGap, 1e-12);
    EXPECT_NEAR(first_w(run, 0.5e-3, -2e-3), -kGap, 1e-12);
    EXPECT_EQ(first_w(run, -0.5e-3, 0.5e-3), 0.5e-3);
    EXPECT_TRUE(StopBorders(run.dynamics().stops()).jumping().empty());
  }
}

TEST(StopBorders, LieBesideATransitionAndInTheMiddle) {
  SceneRun run = scene_with("law = \"arctan\"\nstiffness = 1e5\nregularization = 1e4\n");
  EXPECT_NEAR(first_w(run, 0.1e-3, 2e-3), kGap - 4.0 * kWidth, 1e-12);
  EXPECT_NEAR(first_w(run, kGap - 3.0 * kWidth, 2e-3), kGap, 1e-12);
  EXPECT_NEAR(first_w(run, kGap + 0.5 * kWidth, 2e-3), kGap + 4.0 * kWidth, 1e-12);
  EXPECT_NEAR(first_w(run, 0.1e-3, -0.1e-3), 0.0, 1e-12);
  EXPECT_EQ(StopBorders(run.dynamics().stops()).jumping().size(), 1U);
  SceneRun one_sided = scene_with("law = \"arctan\"\nstiffness = 1e5\nregularization = 1e4\nsides = \"positive\"\n");
  EXPECT_EQ(first_w(one_sided, 0.1e-3, -0.1e-3), -0.1e-3);
  EXPECT_TRUE(StopBorders(one_sided.dynamics().stops()).jumping().empty());
}

TEST(StopBorders, ContinueTheForceOfASideBeyondTheMiddle) {
  SceneRun run = scene_with("law = \"arctan\"\nstiffness = 1e5\nregularization = 1e4\n");
  const StopBorders borders(run.dynamics().stops());
  const auto force = [](double side, double w) {
    const double g = side * w - kGap;
    return -side * kStiffness * g * (0.5 + std::atan(g / kWidth) / std::numbers::pi);
  };
  for (const double side : {1.0, -1.0})
    for (const double w : {-2e-4, -1e-6, 1e-6, 2e-4})
      EXPECT_NEAR(run.dynamics().stops().force_of(0, w) + borders.continuation(0, side, w), force(side, w), 1e-9)
          << side << " " << w;
  // The jump is twice k b/pi.
  EXPECT_NEAR(borders.continuation(0, 1.0, -1e-12), 2.0 * kStiffness * kWidth / std::numbers::pi, 1e-3);
  EXPECT_EQ(borders.continuation(0, 0.0, 1e-4), 0.0);
}

TEST(StopBorders, TakeTheSideOfTheStartUnlessThatIsTheMiddle) {
  EXPECT_EQ(StopBorders::side_of_step(2e-4, -1e-3), 1.0);
  EXPECT_EQ(StopBorders::side_of_step(1e-9, -1e-3), -1.0);
  EXPECT_EQ(StopBorders::side_of_step(0.0, 1e-9), 1.0);
  EXPECT_EQ(StopBorders::side_of_step(0.0, 0.0), 0.0);
}

}  // namespace
}  // namespace butee::test::stop_borders_test
