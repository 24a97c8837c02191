#include "butee/dynamics/modes.hpp"

#include <cmath>
#include <numbers>

#include <butee/dynamics/mode_analysis.hpp>
#include <butee/linalg/dense_pairs.hpp>
#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::modes_test {
namespace {

using std::numbers::pi;

constexpr double kLength = 35.0;
/// The order of frequencies in the element length.
constexpr double kOrder = 4.0, kOrderError = 0.05;
/// Two algorithms for the same eigenvalue in double precision; the lowest eigenvalue is 1e-9 of the highest.
constexpr double kDenseRounding = 1e-6;
/// Tolerance of Phi^T M Phi and Phi^T K Phi: rounding of the shapes.
constexpr double kOrthogonal = 1e-10;
/// Relative change by double-precision rounding of the element matrices at 5e3 elements: 24 eps N^2 / pi^2.
constexpr double kRoundingAtFiveThousand = 2e-8;
/// Limit for the rounding bound computed with the modes, several times larger, and for their residuals.
constexpr double kBoundAtFiveThousand = 2e-7;

std::string rod(const std::string& name, int elements) {
  return beam(name, "length = " + std::to_string(kLength) + "\nelements = " + std::to_string(elements));
}
std::string pinned(const std::string& name) {
  return support("[\"" + name + ":first\", \"" + name + ":last\"]", R"(["u"])");
}

dynamics::NaturalModes modes_of(const SceneRun& scene, Index count) {
  const dynamics::Structure structure(scene.model(), scene.system().dofs);
  auto modes = dynamics::find_modes(structure, count);
  EXPECT_EQ(modes.problem, "");
  return modes;
}

/// (beta L)^2 sqrt(EI/rho A)/L^2
double exact(double root) {
  return root * root / (kLength * kLength) * std::sqrt(kBending / kMassPerLength);
}

/// The roots of cos z cosh z = s: -1 for a cantilever, +1 for a free beam. Refined from Blevins' table 8-1.
double refined(double z, double s) {
  for (int i = 0; i < 5; ++i) z -= (std::cos(z) - s / std::cosh(z)) / (-std::sin(z) + s * std::tanh(z) / std::cosh(z));
  return z;
}

struct Ends {
  const char* name;
  std::string supports;
  int rigid;
  std::vector<double> roots;
};

std::vector<Ends> all_ends() {
  return {{"pinned", pinned("rod"), 0, {pi, 2 * pi, 3 * pi, 4 * pi}},
          {"cantilever",
           support("\"rod:first\"", R"(["u", "theta"])"),
           0,
           {refined(1.875104, -1), refined(4.694091, -1), refined(7.854757, -1)}},
          {"free", "", 2, {refined(4.730041, 1), refined(7.853205, 1), refined(10.995608, 1)}}};
}

TEST(Modes, MeetClosedFormsWithOrderFourByBothSolvers) {
  int checked = 0;
  for (const Ends& ends : all_ends())
    for (const int coarse : {20, 70}) {  // dense, and Lanczos
      const auto count = static_cast<Index>(ends.roots.size()) + ends.rigid;
      const auto first = modes_of(SceneRun(kHeader + kSteelBar + rod("rod", coarse) + ends.supports), count);
      const auto second = modes_of(SceneRun(kHeader + kSteelBar + rod("rod", 2 * coarse) + ends.supports), count);
      EXPECT_EQ(first.dense, coarse == 20);
      EXPECT_EQ(first.rigid, ends.rigid) << ends.name;
      EXPECT_EQ(second.rigid, ends.rigid) << ends.name;
      for (Index i = 0; i < count - ends.rigid; ++i) {
        const double frequency = exact(ends.roots[static_cast<std::size_t>(i)]);
        const double e1 = first.frequencies[i + ends.rigid] / frequency - 1.0;
        const double e2 = second.frequencies[i + ends.rigid] / frequency - 1.0;
        // On the finest meshes, modes dominated by the rounding of element matrices are skipped.
        if (second.rounding[i + ends.rigid] > kOrderError * e2) continue;
        ++checked;
        EXPECT_NEAR(std::log2(e1 / e2), kOrder, kOrderError) << ends.name << " mode " << i << ", " << coarse;
      }
    }
  EXPECT_GE(checked, 14);
}

TEST(Modes, AreOrthonormalAndSolveTheEigenvalueProblem) {
  const SceneRun scene(kHeader + kSteelBar + rod("rod", 150) + pinned("rod"));
  const auto modes = modes_of(scene, 12);
  const Eigen::MatrixXd mass = modes.shapes.transpose() * scene.system().mass * modes.shapes;
  EXPECT_LT((mass - Eigen::MatrixXd::Identity(12, 12)).cwiseAbs().maxCoeff(), kOrthogonal);
  const Eigen::MatrixXd stiffness = modes.shapes.transpose() * scene.system().stiffness * modes.shapes;
  const Eigen::MatrixXd squares = modes.frequencies.cwiseAbs2().asDiagonal();
  EXPECT_LT((stiffness - squares).cwiseAbs().maxCoeff(), kDenseRounding * squares.maxCoeff());
  EXPECT_LT(modes.residuals.maxCoeff(), kOrthogonal);

  const Vector dense =
      linalg::dense_values(Eigen::MatrixXd(scene.system().stiffness), Eigen::MatrixXd(scene.system().mass)).value();
  for (Index i = 6; i < 12; ++i) EXPECT_NEAR(modes.frequencies[i] / std::sqrt(dense[i]), 1.0, kDenseRounding) << i;
}

/// Numbered along the beam, or irregularly, which fills the factor of the mass matrix.
TEST(DensePairs, OfSparseMatricesSolveTheEigenvalueProblem) {
  const SceneRun scene(kHeader + kSteelBar + rod("rod", 17) + pinned("rod"));
  const Index n = scene.system().mass.rows();
  Eigen::PermutationMatrix<Eigen::Dynamic> mixed(n);
  for (Index i = 0; i < n; ++i) mixed.indices()[i] = static_cast<int>(7 * i % n);
  for (const bool mix : {false, true}) {
    const auto order = [&](const SparseMatrix& matrix) {
      SparseMatrix ordered = matrix;
      if (mix) ordered = matrix.twistedBy(mixed);
      return ordered;
    };
    const SparseMatrix k = order(scene.system().stiffness), m = order(scene.system().mass);
    const auto pairs = linalg::dense_pairs(k, m);
    ASSERT_TRUE(pairs);
    const Eigen::MatrixXd mass = pairs->vectors.transpose() * (m * pairs->vectors);
    EXPECT_LT((mass - Eigen::MatrixXd::Identity(n, n)).cwiseAbs().maxCoeff(), kOrthogonal) << mix;
    const Eigen::MatrixXd squares = pairs->values.asDiagonal();
    const Eigen::MatrixXd stiffness = pairs->vectors.transpose() * (k * pairs->vectors);
    EXPECT_LT((stiffness - squares).cwiseAbs().maxCoeff(), kOrthogonal * pairs->values.maxCoeff()) << mix;
    for (Index i = 1; i < n; ++i) EXPECT_LE(pairs->values[i - 1], pairs->values[i]);
  }
  SparseMatrix indefinite = scene.system().mass;
  indefinite.coeffRef(3, 3) = -1.0;
  EXPECT_FALSE(linalg::dense_pairs(scene.system().stiffness, indefinite));
}

TEST(Modes, FindEveryCopyOfEqualFrequencies) {
  constexpr int kBeams = 7;
  std::string scene = kHeader + kSteelBar;
  for (int i = 0; i < kBeams; ++i) {
    std::string name = "rod";
    name += std::to_string(i);
    scene += rod(name, 40) + pinned(name);
  }
  const SceneRun run(scene);
  const auto modes = modes_of(run, 2 * kBeams + 3);
  EXPECT_FALSE(modes.dense);
  for (Index i = 0; i < modes.frequencies.size(); ++i)
    EXPECT_NEAR(modes.frequencies[i] / exact(static_cast<double>(i / kBeams + 1) * pi), 1.0, 1e-4) << i;  // mesh error
  const Eigen::MatrixXd mass = modes.shapes.transpose() * run.system().mass * modes.shapes;
  EXPECT_LT((mass - Eigen::MatrixXd::Identity(mass.rows(), mass.cols())).cwiseAbs().maxCoeff(), kOrthogonal);
}

TEST(Modes, CountTheRigidMotionsOfAllBodies) {
  const SceneRun two(kHeader + kSteelBar + rod("one", 60) + rod("two", 45));
  const auto modes = modes_of(two, 6);
  EXPECT_FALSE(modes.dense);
  EXPECT_EQ(modes.rigid, 4);
  EXPECT_NEAR(modes.frequencies[4] / exact(refined(4.730041, 1)), 1.0, 1e-5);  // mesh error
  EXPECT_EQ(modes_of(two, 3).rigid, 3);
  EXPECT_EQ(modes_of(SceneRun(kHeader + mass("ball", "2.0")), 1).rigid, 1);
}

/// A body on a spring so soft that its frequency is 1e-7 of the first bending frequency does not count as
/// rigid.
TEST(Modes, TellASoftSpringFromRigidMotion) {
  const std::string soft = "\n[[element]]\ntype = \"spring\"\nnode = \"ball\"\nstiffness = 2.0e-14\n";
  for (const int elements : {20, 100}) {
    const SceneRun scene(kHeader + kSteelBar + rod("rod", elements) + pinned("rod") + mass("ball", "2.0") + soft);
    const auto modes = modes_of(scene, 3);
    EXPECT_EQ(modes.rigid, 0);
    EXPECT_NEAR(modes.frequencies[0], 1e-7, 1e-13);
  }
}

/// In double precision the factor of this K would lose most digits of the lowest frequency (N^4 eps = 0.1).
TEST(Modes, HoldABeamOfTenThousandDegreesOfFreedom) {
  for (const Ends& ends : all_ends()) {
    const SceneRun scene(kHeader + kSteelBar + rod("rod", 5000) + ends.supports);
    for (const Index count : {1, 2}) {
      const auto modes = modes_of(scene, count + ends.rigid);
      ASSERT_EQ(modes.problem, "") << ends.name;
      EXPECT_EQ(modes.rigid, ends.rigid) << ends.name;
      for (Index i = 0; i < count; ++i)
        EXPECT_NEAR(modes.frequencies[i + ends.rigid] / exact(ends.roots[static_cast<std::size_t>(i)]), 1.0,
                    kRoundingAtFiveThousand)
            << ends.name;
      EXPECT_LT(modes.rounding.maxCoeff(), kBoundAtFiveThousand);
      EXPECT_LT(modes.residuals.maxCoeff(), kBoundAtFiveThousand);
    }
  }
}

/// K with a closed stop equals that of the structure with a spring in its place.
TEST(Modes, TakeAClosedStopAsASpring) {
  const std::string plain = kHeader + kSteelBar + rod("rod", 20) + pinned("rod");
  const SceneRun with_spring(plain + "\n[[element]]\ntype = \"spring\"\nnode = \"rod:7\"\nstiffness = 3.0e4\n");
  const SceneRun open(plain);
  const auto node = open.model().nodes.select("rod:7").nodes.front();
  const dynamics::Structure closed(open.model(), open.system().dofs, {{node, dynamics::ClosedStop::kGround, 3.0e4}});
  const auto expected = modes_of(with_spring, 5), found = dynamics::find_modes(closed, 5);
  for (Index i = 0; i < 5; ++i) EXPECT_NEAR(found.frequencies[i] / expected.frequencies[i], 1.0, kOrthogonal);
  EXPECT_GT(found.frequencies[0], 1.01 * modes_of(open, 1).frequencies[0]);
}

/// Two stops on uz, one of them with dissipation: sqrt((k + k_c)/m) along uz, sqrt(k/m) along uy.
TEST(Modes, CloseStopsOfAnyDirection) {
  const SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\ndof = \"uy\"\nstiffness = 100.0\n[[element]]\ntype = \"spring\"\nnode = \"m\"\ndof = "
      "\"uz\"\nstiffness = 300.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ndof = \"uz\"\ngap = 0.1\nstiffness = "
      "1000.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ndof = \"uz\"\ngap = 0.2\nstiffness = 2000.0\ndamping = { "
      "type = \"kelvin_voigt\", coefficient = 1.0 }\n[integrator]\ntype = \"dopri5\"\nend_time = 1.0\n");
  const auto closed = dynamics::closed_stops(run.model(), {"all"});
  EXPECT_EQ(closed.size(), 2U);
  const auto modes = dynamics::analyse_modes(run.model(), run.system(), closed, 2).modes;
  EXPECT_NEAR(modes[0].omega, std::sqrt(100.0 / 2.0), 1e-12);
  EXPECT_NEAR(modes[1].omega, std::sqrt(3300.0 / 2.0), 1e-11);
}

}  // namespace
}  // namespace butee::test::modes_test
