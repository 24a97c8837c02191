// The derivatives of a motion with respect to its initial state and its loads, against finite differences and
// the determinant due to damping.
#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "integrators/piecewise.hpp"
#include "models/piecewise_scenes.hpp"
#include "support/scene_run.hpp"

namespace butee::test::piecewise_derivative_test {
namespace {

/// The derivatives of a run over all its steps, and its end state.
struct Derivatives {
  Eigen::MatrixXd by_start;
  Vector by_loads, end;
};

Derivatives follow(const std::string& scene, const Vector& start = Vector(), double end_time = 0.4) {
  SceneRun run(scene, {"integrator.type=piecewise"});
  auto& method = dynamic_cast<integrators::Piecewise&>(run.integrator());
  time::State from, to;
  const Index n = run.system().size();
  from.t = 0.0;
  from.x = start.size() > 0 ? Vector(start.head(n)) : run.system().initial_displacement;
  from.v = start.size() > 0 ? Vector(start.tail(n)) : run.system().initial_velocity;
  method.start(from);
  Derivatives all{Eigen::MatrixXd::Identity(2 * n, 2 * n), Vector::Zero(2 * n), {}};
  while (from.t < end_time) {
    EXPECT_EQ(method.step(from, {end_time - from.t, end_time}, to).status, time::StepStatus::ok);
    const Eigen::MatrixXd step = method.derivative(from, to);
    all.by_start = step * all.by_start;
    all.by_loads = step * all.by_loads + method.derivative_by_loads(from, to);
    std::swap(from, to);
  }
  all.end.resize(2 * n);
  all.end << from.x, from.v;
  return all;
}

TEST(Piecewise, DerivativeHasTheDeterminantOfTheDamping) {
  for (const double dashpot : {0.0, 100.0, 2000.0})
    // Forces are continuous, so the phase-space volume decreases with c/m alone; the derivative is the
    // product of some 30 matrices.
    EXPECT_NEAR(follow(one_mass(dashpot)).by_start.determinant() / std::exp(-dashpot / 156.0 * 0.4), 1.0, 1e-9);
}

TEST(Piecewise, DerivativeMeetsDifferences) {
  constexpr double kEnd = 1.5, kDifference = 1e-6;
  int compared = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    const RandomChain chain(seed, seed % 2 == 1);
    SceneRun run(chain.scene());
    const Index n = run.system().size();
    Vector start(2 * n);
    start << run.system().initial_displacement, run.system().initial_velocity;
    const Derivatives here = follow(chain.scene(), start, kEnd);
    Eigen::MatrixXd difference(2 * n, 2 * n);
    double bend = 0.0;
    for (Index i = 0; i < 2 * n; ++i) {
      Vector ahead = start, back = start;
      ahead[i] += kDifference;
      back[i] -= kDifference;
      const Vector up = follow(chain.scene(), ahead, kEnd).end, down = follow(chain.scene(), back, kEnd).end;
      difference.col(i) = (up - down) / (2.0 * kDifference);
      bend = std::max(bend, (up + down - 2.0 * here.end).cwiseAbs().maxCoeff() / kDifference);
    }
    // If one side of the difference meets another contact, or the second derivative is large, the difference
    // is not usable.
    if (bend > 1e-3 * difference.cwiseAbs().maxCoeff()) continue;
    EXPECT_LT((here.by_start - difference).cwiseAbs().maxCoeff(), 1e-4 * difference.cwiseAbs().maxCoeff())
        << "seed " << seed << "\n"
        << here.by_start << "\n\n"
        << difference << chain.scene();
    ++compared;
  }
  EXPECT_GE(compared, 14);
}

TEST(Piecewise, DerivativeByLoadsMeetsDifferences) {
  constexpr double kPart = 1e-7;
  const Vector up = follow(one_mass(100.0, 3000.0 * (1.0 + kPart))).end,
               down = follow(one_mass(100.0, 3000.0 * (1.0 - kPart))).end;
  const Vector difference = (up - down) / (2.0 * kPart), ours = follow(one_mass(100.0)).by_loads;
  for (Index i = 0; i < 2; ++i) EXPECT_NEAR(ours[i] / difference[i], 1.0, 1e-4);
}

}  // namespace
}  // namespace butee::test::piecewise_derivative_test
