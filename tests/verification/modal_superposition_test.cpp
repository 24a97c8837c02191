// The responses at all nodes of a step and the products with the modes of chosen DOFs, compared with the responses at
// one position and with the full matrices of the modes.
#include "integrators/exponential/modal_superposition.hpp"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "integrators/exponential/step_response.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::modal_superposition_test {
namespace {

using dynamics::DampedModes;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using integrators::Lanes;

/// A uniform shaft: its natural modes move one plane each, and gyroscopic terms couple pairs of them.
std::string uniform_shaft() {
  return TurningPipe{"string", "lateral", "35.0", 12, "0.01", "0.01", "3.0"}.scene(
      "[damping]\nmass_proportional = 0.03\n[integrator]\ntype = \"exponential\"\nend_time = 1.0\n");
}

/// The same with a bearing whose cross terms and damping couple all modes.
std::string shaft_on_bearing() {
  return uniform_shaft() +
         "[[element]]\ntype = \"bearing\"\nnode = \"string:3\"\nstiffness = [[3e4, 1e4], [-1e4, 5e4]]\ndamping = "
         "[[800.0, 0.0], [0.0, 300.0]]\n";
}

class ModalSuperpositionOf : public testing::TestWithParam<std::string (*)()> {
 protected:
  ModalSuperpositionOf() : run_(GetParam()()), modes_(run_.dynamics(), 1.0) {}

  /// Numbers that differ from row to row and column to column.
  static Lanes numbers(Index rows) {
    Lanes all(rows, Lanes::ColsAtCompileTime);
    for (Index i = 0; i < rows; ++i)
      for (Index j = 0; j < all.cols(); ++j) all(i, j) = std::sin(1.0 + 0.7 * static_cast<double>(i * 8 + j));
    return all;
  }

  SceneRun run_;
  DampedModes modes_;
};

TEST_P(ModalSuperpositionOf, GivesTheProductsWithTheFullMatrices) {
  std::vector<Index> all(static_cast<std::size_t>(run_.dynamics().size()));
  std::iota(all.begin(), all.end(), Index{0});
  integrators::ModalSuperposition superposition(modes_);
  for (const std::vector<Index>& dofs : {all, std::vector<Index>{5, 4, 20, 9, 11}, std::vector<Index>{7}, {}}) {
    superposition.choose(dofs);
    const MatrixXd displacement = modes_.displacement()(Eigen::all, dofs),
                   velocity = modes_.velocity()(Eigen::all, dofs), input = modes_.input()(Eigen::all, dofs);
    const Lanes z = numbers(2 * modes_.count()), f = numbers(static_cast<Index>(dofs.size()));
    Lanes x, v, rates;
    superposition.displacements(z, x);
    superposition.velocities(z, v);
    superposition.modal_forces(f, rates);
    const auto near = [](const MatrixXd& got, const MatrixXd& wanted) {
      return got.rows() == wanted.rows() && (got - wanted).norm() <= 1e-12 * wanted.norm();
    };
    EXPECT_TRUE(near(x, displacement.transpose() * z)) << dofs.size();
    EXPECT_TRUE(near(v, velocity.transpose() * z)) << dofs.size();
    EXPECT_TRUE(near(rates, input * f)) << dofs.size();
    const VectorXd one = z.col(0), other = z.col(1);
    integrators::LanesOf<4> both;
    superposition.motions(one, other, both);
    EXPECT_TRUE(near(both.leftCols(2), displacement.transpose() * z.leftCols(2))) << dofs.size();
    EXPECT_TRUE(near(both.rightCols(2), velocity.transpose() * z.leftCols(2))) << dofs.size();
  }
}

/// Two harmonic loads, one of which resonates with a mode, and a polynomial.
TEST_P(ModalSuperpositionOf, MovesToTheNodesAsToEachPosition) {
  const Index p = modes_.count();
  const Lanes all = numbers(2 * p);
  std::vector<integrators::HarmonicLoad> loads;
  for (const double frequency : {30.0, modes_.turn()[p / 2]}) loads.push_back({frequency, all.col(1), all.col(2)});
  const MatrixXd g = MatrixXd(all.leftCols(7)) / 7.0;
  Lanes polynomial = Lanes::Zero(2 * p, Lanes::ColsAtCompileTime);
  polynomial.leftCols(7) = g;
  const VectorXd z = all.col(0);
  integrators::StepResponse response(modes_, loads);
  for (const double h : {1e-6, 1e-4, 2e-3, 0.05, 1.0}) {
    response.set(h);
    Lanes nodes, in_two;
    response.move(0.3, z.data(), g.data(), nodes);
    response.move(0.3, z.data(), nullptr, in_two);
    response.add_force(polynomial, in_two);
    EXPECT_LT((nodes - in_two).norm(), 1e-13 * nodes.norm()) << h;
    EXPECT_EQ(nodes.col(7).norm(), 0.0);
    for (Index j = 0; j < 7; ++j) {
      VectorXd wanted(2 * p);
      integrators::PlaceResponse(modes_, loads, integrators::StepNodes::kPlaces[static_cast<std::size_t>(j)], h)
          .move(0.3, z.data(), g.data(), wanted);
      EXPECT_LT((nodes.col(j) - wanted).norm(), 1e-12 * wanted.norm()) << h << " " << j;
      EXPECT_LT((nodes.col(j) - wanted).cwiseAbs().maxCoeff(), 1e-11 * wanted.cwiseAbs().maxCoeff()) << h << " " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Structures, ModalSuperpositionOf, testing::Values(&uniform_shaft, &shaft_on_bearing));

}  // namespace
}  // namespace butee::test::modal_superposition_test
