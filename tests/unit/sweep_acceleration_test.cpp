#include "integrators/exponential/sweep_acceleration.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace butee::integrators {
namespace {

using Values = Eigen::ArrayXd;

/// The number of sweeps until g(x) differs from x by less than 1e-10, at most 60.
template <class Map>
int sweeps(const Map& map, Values x, bool accelerated, Values& end) {
  SweepAcceleration acceleration;
  acceleration.begin(x.size());
  // Weights only change the norm.
  const Values weights = Values::LinSpaced(x.size(), 0.5, 2.0);
  for (int sweep = 1; sweep <= 60; ++sweep) {
    Values g = map(x);
    end = g;
    if ((g - x).abs().maxCoeff() < 1e-10) return sweep;
    if (accelerated) acceleration.accelerate(x, g, weights);
    x = g;
  }
  return 61;
}

/// x = A x + b with eigenvalues of A up to -3: plain iteration diverges, and the solution is known.
TEST(SweepAcceleration, SolvesLinearProblemsThatPlainIterationDoesNot) {
  const Values slopes = (Values(5) << -3.0, -1.5, -0.5, 0.3, 0.9).finished(), target = Values::LinSpaced(5, 1.0, 5.0);
  Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(5, 5);
  for (Eigen::Index i = 0; i + 1 < 5; ++i) turn(i, i + 1) = 0.7;
  const Eigen::MatrixXd a = turn * slopes.matrix().asDiagonal() * turn.inverse();
  const auto map = [&](const Values& x) -> Values {
    return (target.matrix() + a * (x.matrix() - target.matrix())).array();
  };
  Values end;
  EXPECT_EQ(sweeps(map, Values::Zero(5), false, end), 61);
  // Five iterates determine A; rounding takes a few more sweeps.
  EXPECT_LE(sweeps(map, Values::Zero(5), true, end), 10);
  EXPECT_LT((end - target).abs().maxCoeff(), 1e-9);
}

/// Steep friction at three nodes of a step: x_j = tanh of the speed left by the forces before it.
TEST(SweepAcceleration, SolvesSteepFriction) {
  const auto map = [](const Values& x) -> Values {
    Values g(3);
    double speed = 1.0;
    for (Eigen::Index j = 0; j < 3; ++j) {
      speed -= 0.4 * x[j];
      g[j] = std::tanh(6.0 * speed);
    }
    return g;
  };
  Values plain, end;
  const int without = sweeps(map, Values::Zero(3), false, plain), with = sweeps(map, Values::Zero(3), true, end);
  EXPECT_EQ(without, 61);
  EXPECT_LE(with, 20);
  EXPECT_LT((map(end) - end).abs().maxCoeff(), 1e-9);
}

TEST(SweepAcceleration, ForgetsEarlierIterates) {
  const auto map = [](const Values& x) -> Values { return 0.5 * x + 1.0; };
  Values first, second;
  const int once = sweeps(map, Values::Zero(2), true, first), again = sweeps(map, Values::Zero(2), true, second);
  EXPECT_EQ(once, again);
  EXPECT_EQ(first[0], second[0]);
}

}  // namespace
}  // namespace butee::integrators
