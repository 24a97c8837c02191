#include <cmath>
#include <numbers>

#include <Eigen/Dense>
#include <butee/linalg/dense_pairs.hpp>
#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::beam_frequency_test {
namespace {

/// The order of the frequencies in the element length, and its tolerance: at these meshes higher powers of
/// the length still contribute.
constexpr double kOrder = 4.0, kOrderError = 0.2;
/// (beta l)^4/1440 for the fourth mode on 32 elements, with a margin.
constexpr double kFineMeshError = 2e-5;
/// Rounding of the dense eigenproblem: machine precision times the ratio of the largest to the lowest eigenvalue.
constexpr double kEigenRounding = 1e-8;
constexpr double kLength = 2.5;

/// Refines a tabulated root by Newton's method on the frequency equation, written without overflow:
/// cos z + s/cosh z = 0 with s = +1 for a cantilever, -1 for clamped or free at both ends.
double refined(double z, double s) {
  for (int i = 0; i < 5; ++i) z -= (std::cos(z) + s / std::cosh(z)) / (-std::sin(z) - s * std::tanh(z) / std::cosh(z));
  return z;
}

/// A pair of end conditions and its lowest roots beta L. Source: R. D. Blevins, Formulas for Natural
/// Frequency and Mode Shape, 1979, table 8-1.
struct Ends {
  const char* name;
  std::string supports;
  std::vector<double> roots;
};

std::ostream& operator<<(std::ostream& stream, const Ends& ends) {
  return stream << ends.name;
}

Ends pinned() {
  using std::numbers::pi;
  return {"pinned", support(R"(["rod:first", "rod:last"])", R"(["u"])"), {pi, 2 * pi, 3 * pi, 4 * pi}};
}
Ends cantilever() {
  Ends ends{"cantilever", support("\"rod:first\"", R"(["u", "theta"])"), {1.875104, 4.694091, 7.854757, 10.995541}};
  for (double& root : ends.roots) root = refined(root, 1.0);
  return ends;
}
Ends clamped() {
  Ends ends{"clamped", support(R"(["rod:first", "rod:last"])", R"(["u", "theta"])"), {4.730041, 7.853205, 10.995608}};
  for (double& root : ends.roots) root = refined(root, -1.0);
  return ends;
}
Ends sliding() {
  using std::numbers::pi;
  return {"sliding_pinned",
          support("\"rod:first\"", R"(["theta"])") + support("\"rod:last\"", R"(["u"])"),
          {pi / 2, 3 * pi / 2, 5 * pi / 2}};
}

Vector eigenvalues(const std::string& supports, int elements) {
  const std::string mesh = "length = " + std::to_string(kLength) + "\nelements = " + std::to_string(elements);
  const SceneRun scene(kHeader + kSteelBar + beam("rod", mesh) + supports);
  const Eigen::MatrixXd mass(scene.system().mass), stiffness(scene.system().stiffness);
  return linalg::dense_values(stiffness, mass).value();
}

/// (beta L)^2 sqrt(EI/rho A)/L^2
double exact_frequency(double root) {
  return root * root / (kLength * kLength) * std::sqrt(kBending / kMassPerLength);
}

class BeamFrequency : public testing::TestWithParam<Ends> {};

TEST_P(BeamFrequency, AFineMeshMeetsTheClosedFormFromAbove) {
  const Vector values = eigenvalues(GetParam().supports, 32);
  for (std::size_t i = 0; i < GetParam().roots.size(); ++i) {
    const double error = std::sqrt(values[static_cast<Index>(i)]) / exact_frequency(GetParam().roots[i]) - 1.0;
    EXPECT_LE(error, kFineMeshError) << "mode " << i + 1;
    EXPECT_GE(error, -kEigenRounding) << "mode " << i + 1;
  }
}

TEST_P(BeamFrequency, TheErrorFallsAsTheFourthPowerOfTheElementLength) {
  for (std::size_t i = 0; i < GetParam().roots.size(); ++i) {
    const double exact = exact_frequency(GetParam().roots[i]);
    const int coarse = 4 * (static_cast<int>(i) + 2);
    const auto mode = static_cast<Index>(i);
    const double first = std::sqrt(eigenvalues(GetParam().supports, coarse)[mode]) / exact - 1.0;
    const double second = std::sqrt(eigenvalues(GetParam().supports, 2 * coarse)[mode]) / exact - 1.0;
    EXPECT_NEAR(std::log2(first / second), kOrder, kOrderError) << "mode " << i + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(ends, BeamFrequency, testing::Values(pinned(), cantilever(), clamped(), sliding()),
                         [](const auto& instance) { return std::string(instance.param.name); });

/// A free beam has two rigid motions and the elastic frequencies of the clamped beam.
TEST(FreeBeam, HasTwoRigidModesAndThenThoseOfTheClampedOne) {
  const Vector values = eigenvalues("", 32);
  const double lowest = std::pow(exact_frequency(clamped().roots[0]), 2);
  EXPECT_NEAR(values[0], 0.0, 1e2 * kEigenRounding * lowest);
  EXPECT_NEAR(values[1], 0.0, 1e2 * kEigenRounding * lowest);
  for (std::size_t i = 0; i < clamped().roots.size(); ++i) {
    const double exact = exact_frequency(clamped().roots[i]);
    EXPECT_NEAR(std::sqrt(values[static_cast<Index>(i) + 2]), exact, kFineMeshError * exact);
  }
}

}  // namespace
}  // namespace butee::test::beam_frequency_test
