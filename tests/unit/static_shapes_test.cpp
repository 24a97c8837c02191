#include "butee/dynamics/static_shapes.hpp"

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::static_shapes_test {
namespace {

constexpr Index kKept = 6;

class StaticShapes : public testing::Test {
 protected:
  /// Unit forces at nodes of a pinned beam.
  Eigen::MatrixXd forces(const std::vector<std::string>& nodes) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(system().size(), static_cast<Index>(nodes.size()));
    for (std::size_t j = 0; j < nodes.size(); ++j) all(scene_.dof(nodes[j]), static_cast<Index>(j)) = 1.0;
    return all;
  }
  const model::System& system() const { return scene_.system(); }
  dynamics::Modes lowest() const { return *dynamics::lowest_modes(system(), kKept); }

 private:
  SceneRun scene_{kHeader + kSteelBar + beam("pipe", "length = 8.0\nelements = 40") +
                  support(R"(["pipe:first", "pipe:last"])", R"(["u"])")};
};

TEST_F(StaticShapes, HoldTheStaticResponseToTheirForces) {
  const Eigen::MatrixXd loads = forces({"pipe:7", "pipe:20", "pipe:21"});
  dynamics::Modes modes = lowest();
  const auto response = [&] {
    const Vector square = modes.frequencies.array().square();
    return Eigen::MatrixXd(modes.shapes * square.cwiseInverse().asDiagonal() * modes.shapes.transpose() * loads);
  };
  const Eigen::MatrixXd exact = Eigen::MatrixXd(system().stiffness).ldlt().solve(loads);
  const double before = (response() - exact).norm() / exact.norm();
  const Vector shares = add_static_shapes(system(), loads, modes);
  ASSERT_EQ(modes.frequencies.size(), kKept + 3);
  EXPECT_GT(before, 1e-3);
  EXPECT_LT((response() - exact).norm() / exact.norm(), 2e-4 * before);  // the artificial weak spring contributes 1e-4
  EXPECT_GT(shares.minCoeff(), 1e-4);
  EXPECT_LT(shares.maxCoeff(), 0.05);
}

TEST_F(StaticShapes, AreModesOfTheBasisThatTheyMake) {
  dynamics::Modes modes = lowest();
  add_static_shapes(system(), forces({"pipe:7", "pipe:20", "pipe:21"}), modes);
  const Index size = modes.frequencies.size();
  const Eigen::MatrixXd mass = modes.shapes.transpose() * system().mass * modes.shapes,
                        stiffness = modes.shapes.transpose() * system().stiffness * modes.shapes;
  EXPECT_LT((mass - Eigen::MatrixXd::Identity(size, size)).cwiseAbs().maxCoeff(), 1e-9);
  const Vector square = modes.frequencies.array().square();
  EXPECT_LT((stiffness - Eigen::MatrixXd(square.asDiagonal())).cwiseAbs().maxCoeff(), 1e-9 * square.maxCoeff());
  for (Index i = kKept; i < size; ++i) EXPECT_GT(modes.frequencies[i], modes.frequencies[kKept - 1]);
}

TEST_F(StaticShapes, OfForcesThatDependOnOthersAreLeftOut) {
  Eigen::MatrixXd loads = forces({"pipe:7", "pipe:7", "pipe:30"});
  loads.col(2) = 2.0 * loads.col(0);
  dynamics::Modes modes = lowest();
  add_static_shapes(system(), loads, modes);
  EXPECT_EQ(modes.frequencies.size(), kKept + 1);
}

TEST_F(StaticShapes, OfAForceThatMovesNothingAreNone) {
  Eigen::MatrixXd loads = forces({"pipe:7", "pipe:20"});
  loads.col(1).setZero();
  dynamics::Modes modes = lowest();
  const Vector shares = add_static_shapes(system(), loads, modes);
  EXPECT_EQ(modes.frequencies.size(), kKept + 1);
  EXPECT_GT(shares[0], 0.0);
  EXPECT_EQ(shares[1], 0.0);
}

}  // namespace
}  // namespace butee::test::static_shapes_test
