// Tests of Promise itself, with closed forms and deliberately wrong trajectories.
#include "stress/suite/promise.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "stress/suite/reference.hpp"

namespace butee::stress::promise_test {
namespace {

constexpr Index kRows = 101;
constexpr double kTolerance = 1e-4;

/// Two displacements, the second a hundredth of the first, and a much smaller rotation: sin t, t from 0 to
/// 10.
Trajectory oscillation(double late = 0.0) {
  Trajectory motion(3, kRows);
  const double size[] = {1.0, 1e-2, 1e-6};
  for (Index row = 0; row < kRows; ++row)
    for (Index i = 0; i < 3; ++i) {
      motion.x(i, row) = size[i] * std::sin(0.1 * static_cast<double>(row) - late);
      motion.v(i, row) = size[i] * std::cos(0.1 * static_cast<double>(row) - late);
    }
  motion.rows = kRows;
  return motion;
}

Promise promise(double allowance = 1.0) {
  Trajectory largest = oscillation();
  for (Eigen::MatrixXd* all : {&largest.x, &largest.v}) {
    *all = all->cwiseAbs();
    for (Index row = 1; row < kRows; ++row) all->col(row) = all->col(row).cwiseMax(all->col(row - 1));
  }
  return {oscillation(), largest, {false, false, true}, kTolerance, allowance};
}

TEST(StressPromise, TakesTheReferenceForRight) {
  const Judgement found = promise().judge(oscillation());
  EXPECT_EQ(found.error, 0.0);
  EXPECT_EQ(found.excess, 0.0);
}

TEST(StressPromise, AllowsTenTolerancesAndNoMore) {
  Trajectory motion = oscillation();
  motion.x(0, 50) += 9.9 * kTolerance;
  EXPECT_NEAR(promise().judge(motion).excess, 0.99, 1e-3);
  motion.x(0, 50) += 0.2 * kTolerance;
  const Judgement found = promise().judge(motion);
  EXPECT_GT(found.excess, 1.0);
  EXPECT_EQ(found.row, 50);
  EXPECT_EQ(found.component, 0);
  EXPECT_FALSE(found.in_velocity);
}

TEST(StressPromise, LooksAtEveryComponentByItsOwnScale) {
  for (Index i = 0; i < 3; ++i) {
    Trajectory motion = oscillation();
    motion.x(i, 80) += 20.0 * kTolerance * std::abs(motion.x.row(i).cwiseAbs().maxCoeff());
    EXPECT_GT(promise().judge(motion).excess, 1.9) << i;
    motion = oscillation();
    motion.v(i, 80) += 20.0 * kTolerance * std::abs(motion.v.row(i).cwiseAbs().maxCoeff());
    const Judgement found = promise().judge(motion);
    EXPECT_GT(found.excess, 1.9) << i;
    EXPECT_TRUE(found.in_velocity);
  }
}

TEST(StressPromise, ScalesAreThoseSoFarAndAThousandthOfTheKind) {
  const Promise judge = promise();
  EXPECT_DOUBLE_EQ(judge.scales().x(0, 0), 1e-3 * judge.scales().x(0, kRows - 1));
  EXPECT_NEAR(judge.scales().x(0, 5), std::sin(0.5), 1e-15);
  EXPECT_DOUBLE_EQ(judge.scales().x(1, 0), judge.scales().x(0, 0));
  // Displacements do not enter the scale of a rotation.
  EXPECT_LT(judge.scales().x(2, kRows - 1), 1.01e-6);
}

TEST(StressPromise, GrowthOfDisturbancesIsAllowedFromThenOn) {
  Trajectory disturbed = oscillation(), motion = oscillation();
  for (Index row = 40; row < kRows; ++row) disturbed.x(0, row) += 5.0 * kTolerance;
  for (Index row = 0; row < kRows; ++row) motion.x(1, row) += 0.3 * kTolerance * 1e-2;
  motion.x(0, 60) += 45.0 * kTolerance;
  Promise judge = promise();
  EXPECT_GT(judge.judge(motion).excess, 4.0);
  judge.raise_growth(disturbed, 1, kTolerance, true, true);
  EXPECT_EQ(judge.growth(39), 0.0);
  EXPECT_NEAR(judge.growth(90), 5.0, 1e-2);
  EXPECT_NEAR(judge.judge(motion).excess, 0.9, 1e-2);
  motion.x(0, 30) += 45.0 * kTolerance;
  EXPECT_GT(judge.judge(motion).excess, 4.0);
}

TEST(StressPromise, EndsWhereATenthWouldBeAllowed) {
  Promise judge = promise();
  Trajectory disturbed = oscillation(), motion = oscillation();
  for (Index row = 70; row < kRows; ++row) disturbed.x(0, row) += 101.0 * kTolerance;
  judge.raise_growth(disturbed, 0, kTolerance, true, true);
  EXPECT_EQ(judge.rows(), 70);
  motion.x(0, 75) = 100.0;
  EXPECT_EQ(judge.judge(motion).excess, 0.0);
}

TEST(StressPromise, ARunThatWasNotOverHasGrownBeyondBounds) {
  Promise judge = promise();
  Trajectory disturbed = oscillation();
  disturbed.rows = 30;
  judge.raise_growth(disturbed, 0, kTolerance, true, true);
  EXPECT_EQ(judge.rows(), kRows);
  judge.raise_growth(disturbed, 0, kTolerance, false, true);
  EXPECT_EQ(judge.rows(), 30);
}

TEST(StressPromise, VelocitiesAreComparedWithTheirBand) {
  Promise judge = promise();
  Trajectory motion = oscillation();
  motion.v.col(20) = -motion.v.col(20);
  EXPECT_GT(judge.judge(motion).excess, 1.0);
  judge.set_band(20, -oscillation().v.col(20).cwiseAbs(), oscillation().v.col(20).cwiseAbs());
  EXPECT_EQ(judge.judge(motion).excess, 0.0);
  motion.v(0, 20) = 1.1;
  EXPECT_GT(judge.judge(motion).excess, 1.0);
}

TEST(StressPromise, LongRunsGetTheirAllowance) {
  Trajectory motion = oscillation();
  motion.x(0, 50) += 25.0 * kTolerance;
  EXPECT_GT(promise().judge(motion).excess, 1.0);
  EXPECT_NEAR(promise(3.0).judge(motion).excess, 2.5 / 3.0, 1e-3);
}

constexpr const char* kImpacts = R"(schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 1e2
[[contact]]
type = "stop"
nodes = "m"
gap = 0.1
stiffness = 1e8
[initial]
velocity = [{ nodes = "m", value = 3.0 }]
)";

TEST(StressReference, AllowsAShiftInTimeAtAnImpactAndNoWrongSpeedInFlight) {
  Scene scene;
  scene.toml = kImpacts;
  scene.end_time = 0.5;
  scene.tolerance = 1e-4;
  Reference reference(scene, 1000000);
  ASSERT_TRUE(reference.exists());
  const Promise& judge = reference.promise();
  EXPECT_GT(judge.rows(), 150);
  EXPECT_EQ(judge.judge(judge.reference()).excess, 0.0);
  // The reference conserves energy, so it is a solution.
  const auto x = judge.reference().x.row(0), v = judge.reference().v.row(0);
  for (Index row = 0; row < judge.rows(); ++row) {
    const double depth = std::max(0.0, std::abs(x[row]) - 0.1);
    EXPECT_NEAR(0.5 * v[row] * v[row] + 50.0 * x[row] * x[row] + 5e7 * depth * depth, 4.5, 1e-12);
  }
  for (Index row = 1; row < judge.rows(); row += 10) {
    Trajectory motion = judge.reference();
    motion.v(0, row) *= 1.0 + 12.0 * scene.tolerance * std::max(1.0, judge.growth(row));
    if (std::abs(x[row]) > 0.09) continue;
    EXPECT_GT(judge.judge(motion).excess, 1.0) << row;
    motion.v(0, row) = -v[row];
    EXPECT_GT(judge.judge(motion).excess, 1.0) << row;
  }
}

TEST(StressReference, GrowsByRefinementAlone) {
  Scene scene;
  scene.toml = kImpacts;
  scene.end_time = 0.5;
  scene.tolerance = 1e-6;
  Reference reference(scene, 1000000);
  std::vector<double> before;
  for (Index row = 0; row < 100; ++row) before.push_back(reference.promise().growth(row));
  int times = 0;
  for (; reference.can_refine(); ++times) reference.refine(100);
  EXPECT_EQ(times, Reference::kLevels);
  for (Index row = 0; row < 100; ++row)
    EXPECT_GE(reference.promise().growth(row), before[static_cast<std::size_t>(row)]);
}

TEST(StressReference, SaysWhyASceneIsNone) {
  Scene scene;
  scene.toml = "schema = 1\n";
  scene.end_time = 1.0;
  const Reference reference(scene, 1000);
  EXPECT_FALSE(reference.exists());
  EXPECT_NE(reference.complaint(), "");
}

}  // namespace
}  // namespace butee::stress::promise_test
