#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::solver_test {
namespace {

/// Error of a direct solution: machine precision times the condition number of these small systems.
constexpr double kSolved = 1e-9;

/// Two beams with springs, dashpots, Rayleigh damping, stops to ground and between nodes, one end fixed.
std::string coupled_scene() {
  return kHeader + kSteelBar + beam("rotor", "length = 2.0\nelements = 4") +
         beam("casing", "length = 2.0\nelements = 4") + support("\"casing:first\"", R"(["u"])") + R"(
[[element]]
type      = "spring"
nodes     = ["rotor:last", "casing:last"]
stiffness = 1.0e6
damping   = 20.0

[[contact]]
type      = "stop"
nodes     = "rotor:all"
gap       = 0.01
stiffness = 1.0e7

[[contact]]
type      = "stop"
between   = ["rotor:all", "casing:all"]
gap       = 0.001
stiffness = 1.0e6

[damping]
mass_proportional      = 0.4
stiffness_proportional = 1.0e-4
)";
}

Eigen::MatrixXd dense_effective(const SceneRun& scene, dynamics::ElasticStops& contact, double c, double k,
                                const Vector& kappa) {
  const model::System& system = scene.system();
  const Eigen::MatrixXd mass(system.mass), stiffness(system.stiffness);
  Eigen::MatrixXd damping = system.damping.mass_proportional * mass + system.damping.stiffness_proportional * stiffness;
  if (system.dashpots.size() > 0) damping += Eigen::MatrixXd(system.dashpots);
  Eigen::MatrixXd pick = Eigen::MatrixXd::Zero(contact.size(), system.size());
  for (Index i = 0; i < contact.size(); ++i) {
    if (contact.dof_a(i) >= 0) pick(i, contact.dof_a(i)) += 1.0;
    if (contact.dof_b(i) >= 0) pick(i, contact.dof_b(i)) -= 1.0;
  }
  return mass + c * damping + k * (stiffness + pick.transpose() * kappa.asDiagonal() * pick);
}

TEST(EffectiveSolver, SolvesWhatTheDenseMatrixSays) {
  SceneRun scene(coupled_scene());
  dynamics::ElasticStops& contact = scene.dynamics().stops();
  ASSERT_EQ(contact.size(), 10);
  dynamics::EffectiveSolver& solver = scene.dynamics().effective();
  Vector kappa(contact.size()), right(scene.system().size());
  for (Index i = 0; i < right.size(); ++i) right[i] = std::cos(1.0 + static_cast<double>(i));
  std::size_t cases = 0;
  for (const auto& [c, k] : {std::pair(5e-4, 2.5e-7), std::pair(5e-3, 2.5e-5), std::pair(5e-4, 2.5e-7)})
    for (const double closed : {0.0, 1.0, 2.0}) {
      for (Index i = 0; i < kappa.size(); ++i) kappa[i] = i % 3 == 0 ? 0.0 : closed * 1e7 * static_cast<double>(i);
      solver.set_factors(c, k);
      Vector y = right;
      ASSERT_TRUE(solver.solve(kappa, y));
      const Vector expected = dense_effective(scene, contact, c, k, kappa).ldlt().solve(right);
      EXPECT_LE((y - expected).norm(), kSolved * expected.norm());
      ++cases;
    }
  EXPECT_EQ(cases, 9U);
  // In addition to the nine, one for each stop and each of the two pairs of factors.
  EXPECT_EQ(scene.dynamics().counters().solves, 9 + 2 * contact.size());
}

TEST(EffectiveSolver, GivesTheSameWithLocalContactAsWithFullFactorization) {
  // Relative to the largest entry; both are direct solutions of one system. Rounding is amplified by the
  // condition number of the matrix, which grows with h: 1.4e-12 in the worst of the 128 cases.
  constexpr double kSame = 5e-12;
  using Contacts = dynamics::EffectiveSolver::Contacts;
  SceneRun scene(coupled_scene());
  const dynamics::ElasticStops& contact = scene.dynamics().stops();
  linalg::Counters local_counters, full_counters;
  dynamics::EffectiveSolver local(scene.system(), contact, local_counters, Contacts::local);
  dynamics::EffectiveSolver full(scene.system(), contact, full_counters, Contacts::factorized);
  Vector kappa(contact.size()), right(scene.system().size());
  for (Index i = 0; i < right.size(); ++i) right[i] = std::cos(1.0 + static_cast<double>(i));
  std::size_t cases = 0;
  for (const double h : {1e-5, 1e-4, 1e-3, 1e-2})
    for (int pattern = 0; pattern < 32; ++pattern) {
      // Closed, nearly closed, far open with the residual stiffness of the arctan law, and fully open.
      for (Index i = 0; i < kappa.size(); ++i)
        kappa[i] = std::array{1e7, 3e3, 0.14, 0.0}[static_cast<std::size_t>((pattern >> (i % 4)) + i) % 4];
      Vector x = right, y = right;
      local.set_factors(0.5 * h, 0.25 * h * h);
      full.set_factors(0.5 * h, 0.25 * h * h);
      ASSERT_TRUE(local.solve(kappa, x));
      ASSERT_TRUE(full.solve(kappa, y));
      EXPECT_LE((x - y).lpNorm<Eigen::Infinity>(), kSame * y.lpNorm<Eigen::Infinity>());
      ++cases;
    }
  EXPECT_EQ(cases, 128U);
  EXPECT_EQ(local_counters.factorizations, 4);
  EXPECT_EQ(full_counters.factorizations, 128);
}

TEST(EffectiveSolver, SaysWhereTheMatrixIsNotPositiveDefinite) {
  SceneRun scene(coupled_scene());
  dynamics::EffectiveSolver& solver = scene.dynamics().effective();
  solver.set_factors(5e-4, 2.5e-7);
  Vector right = Vector::Ones(scene.system().size());
  EXPECT_FALSE(solver.solve(Vector::Constant(10, -1e12), right));
  right.setOnes();
  EXPECT_FALSE(solver.solve(Vector::Constant(10, std::numeric_limits<double>::quiet_NaN()), right));
  right.setOnes();
  EXPECT_TRUE(solver.solve(Vector::Zero(10), right));
  const Vector expected = dense_effective(scene, scene.dynamics().stops(), 5e-4, 2.5e-7, Vector::Zero(10))
                              .ldlt()
                              .solve(Vector::Ones(right.size()));
  EXPECT_LE((right - expected).norm(), kSolved * expected.norm());
}

TEST(EffectiveSolver, WithoutStopsFactorizesOnceForAStep) {
  SceneRun scene(kHeader + kSteelBar + beam("arm", "length = 2.0\nelements = 4"));
  dynamics::EffectiveSolver& solver = scene.dynamics().effective();
  const Vector none(0);
  Vector y = Vector::Ones(scene.system().size());
  for (int i = 0; i < 5; ++i) {
    solver.set_factors(5e-4, 2.5e-7);
    ASSERT_TRUE(solver.solve(none, y));
  }
  EXPECT_EQ(scene.dynamics().counters().factorizations, 1);
  EXPECT_EQ(scene.dynamics().counters().solves, 5);
  solver.set_factors(1e-3, 1e-6);
  ASSERT_TRUE(solver.solve(none, y));
  EXPECT_EQ(scene.dynamics().counters().factorizations, 2);
}

TEST(EffectiveSolver, WantsItsFactorsFirst) {
  SceneRun scene(kHeader + mass("ball", "1.0"));
  Vector y = Vector::Ones(1);
  EXPECT_THROW((void)scene.dynamics().effective().solve(Vector(0), y), LogicError);
}

/// A band matrix of the given half bandwidth with `diagonal` on its diagonal and -1 off it.
SparseMatrix banded(Index size, Index half, double diagonal) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < size; ++i)
    for (Index j = std::max<Index>(0, i - half); j <= std::min(size - 1, i + half); ++j)
      entries.emplace_back(static_cast<int>(i), static_cast<int>(j), i == j ? diagonal : -1.0);
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Half bandwidths on both sides of the limit up to which the natural order is kept.
class SymmetricFactor : public testing::TestWithParam<int> {};

TEST_P(SymmetricFactor, SolvesSeveralRightHandSides) {
  linalg::Counters counters;
  const SparseMatrix matrix = banded(60, GetParam(), 2.0 * GetParam() + 0.5);
  linalg::SymmetricFactor factor(matrix, counters);
  ASSERT_TRUE(factor.factorize(matrix));
  Eigen::MatrixXd x(60, 3);
  for (Index j = 0; j < 3; ++j)
    for (Index i = 0; i < 60; ++i) x(i, j) = std::sin(static_cast<double>(i * (j + 1)));
  Eigen::MatrixXd b = matrix * x;
  for (Index j = 0; j < 3; ++j) factor.solve(b.col(j));
  EXPECT_LE((b - x).norm(), kSolved * x.norm());
  EXPECT_EQ(counters.factorizations, 1);
  EXPECT_EQ(counters.solves, 3);
}

TEST_P(SymmetricFactor, RejectsAnIndefiniteMatrixAndRecovers) {
  linalg::Counters counters;
  const double definite = 2.0 * GetParam() + 0.5;
  const SparseMatrix matrix = banded(60, GetParam(), definite);
  linalg::SymmetricFactor factor(matrix, counters);
  EXPECT_FALSE(factor.factorize(banded(60, GetParam(), 0.5)));
  EXPECT_FALSE(factor.factorize(banded(60, GetParam(), -definite)));
  SparseMatrix late = matrix;
  late.coeffRef(59, 59) = -1e3;
  EXPECT_FALSE(factor.factorize(late));
  late.coeffRef(59, 59) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(factor.factorize(late));
  ASSERT_TRUE(factor.factorize(matrix));
  Eigen::MatrixXd b = matrix * Vector::Ones(60);
  factor.solve(b);
  EXPECT_LE((b - Vector::Ones(60)).norm(), kSolved * std::sqrt(60.0));
}

TEST_P(SymmetricFactor, RejectsASingularMatrix) {
  linalg::Counters counters;
  SparseMatrix matrix = banded(60, GetParam(), 2.0 * GetParam() + 0.5);
  linalg::SymmetricFactor factor(matrix, counters);
  matrix.coeffs().setZero();
  EXPECT_FALSE(factor.factorize(matrix));
}

INSTANTIATE_TEST_SUITE_P(half_bandwidths, SymmetricFactor, testing::Values(1, 3, 8, 9, 20));

}  // namespace
}  // namespace butee::test::solver_test
