#include <cmath>
#include <functional>

#include <Eigen/Dense>
#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "conformance/fixed_steps.hpp"

namespace butee::test::amplification_test {
namespace {

using Eigen::Matrix2d;

/// m x'' + c x' + k x = 0 with m = 2 kg.
struct Oscillator {
  double stiffness, damping;  ///< N/m, N s/m

  /// The matrix A of (x, v)' = A (x, v).
  Matrix2d rates() const { return (Matrix2d() << 0.0, 1.0, -stiffness / 2.0, -damping / 2.0).finished(); }
};

std::string scene(const MethodCase& method, const Oscillator& oscillator, double x, double v,
                  const std::string& more = "") {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
         "\"m\"\nstiffness = " +
         to_text(oscillator.stiffness) + "\ndamping = " + to_text(oscillator.damping) +
         "\n[initial]\ndisplacement = [{nodes = \"m\", value = " + to_text(x) +
         "}]\nvelocity = [{nodes = \"m\", value = " + to_text(v) + "}]\n[integrator]\ntype = \"" + method.name +
         "\"\ntime_step = 1e-3\nend_time = 1.0\n" + method.keys + more;
}

/// The matrix that maps (x, v) over one step, measured column by column from two initial states.
Matrix2d measured(const MethodCase& method, const Oscillator& oscillator, double h, const std::string& more = "") {
  Matrix2d matrix;
  for (int column = 0; column < 2; ++column) {
    SceneRun run(scene(method, oscillator, column == 0 ? 1.0 : 0.0, column == 1 ? 1.0 : 0.0, more), accept_all(method));
    const time::State state = equal_steps(run, h, 1).back();
    matrix.col(column) << state.x[0], state.v[0];
  }
  return matrix;
}

/// 1 + z + z^2/2 + z^3/6 + z^4/24 with z = h A: the stability polynomial of every Runge-Kutta method of four stages and
/// order four. Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, section IV.2.
Matrix2d runge_kutta4(const Matrix2d& rates, double h) {
  const Matrix2d z = h * rates, one = Matrix2d::Identity();
  return one + z * (one + z / 2.0 * (one + z / 3.0 * (one + z / 4.0)));
}

/// Newmark's formulas with the accelerations at both ends eliminated by the equation of motion. Source: T. J. R.
/// Hughes, The Finite Element Method, 1987, section 9.1.
Matrix2d newmark(const Oscillator& oscillator, double h, double beta, double gamma) {
  const double k = oscillator.stiffness / 2.0, c = oscillator.damping / 2.0, b = 0.5 - beta, g = 1.0 - gamma;
  Matrix2d end, begin;
  end << 1.0 + beta * h * h * k, beta * h * h * c, gamma * h * k, 1.0 + gamma * h * c;
  begin << 1.0 - b * h * h * k, h - b * h * h * c, -g * h * k, 1.0 - g * h * c;
  return end.inverse() * begin;
}

/// e^(h A) by its series over a fraction of the step and repeated squaring: the matrix of a method without
/// truncation error.
Matrix2d exponential(const Matrix2d& rates, double h) {
  constexpr int kSquarings = 10;
  const Matrix2d z = std::ldexp(h, -kSquarings) * rates, one = Matrix2d::Identity();
  Matrix2d sum = one;
  for (int k = 12; k >= 1; --k) sum = one + z * sum / k;
  for (int i = 0; i < kSquarings; ++i) sum = sum * sum;
  return sum;
}

bool starts_with(const std::string& text, const std::string& begin) {
  return text.rfind(begin, 0) == 0;
}

/// The closed form of a method's matrix; empty if the suite has none.
std::function<Matrix2d(const Oscillator&, double)> closed_form(const MethodCase& method) {
  if (method.name == "exact") return [](const Oscillator& o, double h) { return exponential(o.rates(), h); };
  if (method.name == "rk4") return [](const Oscillator& o, double h) { return runge_kutta4(o.rates(), h); };
  if (starts_with(method.name, "rk4_"))  // Step doubling keeps the result of the two halves.
    return [](const Oscillator& o, double h) -> Matrix2d {
      const Matrix2d half = runge_kutta4(o.rates(), 0.5 * h);
      return half * half;
    };
  if (starts_with(method.name, "newmark"))
    return [](const Oscillator& o, double h) { return newmark(o, h, 0.25, 0.5); };
  return {};
}

std::vector<MethodCase> cases_with_closed_form() {
  std::vector<MethodCase> cases = method_cases();
  std::erase_if(cases, [](const MethodCase& method) { return !closed_form(method); });
  return cases;
}

/// Rounding of some dozen operations, in a matrix with displacements scaled by omega.
constexpr double kRounding = 1e-12;

/// The largest difference with x in units of v/omega.
double difference(const Matrix2d& a, const Matrix2d& b, double omega) {
  const Matrix2d scale = Eigen::Vector2d(1.0, 1.0 / omega).asDiagonal();
  return (scale * (a - b) * scale.inverse()).cwiseAbs().maxCoeff() /
         (scale * b * scale.inverse()).cwiseAbs().maxCoeff();
}

class Amplification : public testing::TestWithParam<MethodCase> {};

TEST_P(Amplification, OfOneStepIsTheClosedForm) {
  const auto expected = closed_form(GetParam());
  // A series of order 30 has converged to rounding for h omega = 1; a step of 10 is too long for it.
  const bool is_series = GetParam().name == "exact";
  int cases = 0;
  for (const double ratio : {0.0, 0.02, 0.4})
    for (const double h_omega : {1e-3, 0.1, 1.0, 2.5, 10.0}) {
      if (is_series && h_omega > 1.0) continue;
      const double omega = 20.0, h = h_omega / omega;
      const Oscillator oscillator{2.0 * omega * omega, 4.0 * ratio * omega};
      EXPECT_LE(difference(measured(GetParam(), oscillator, h), expected(oscillator, h), omega), kRounding)
          << "h omega = " << h_omega << ", ratio " << ratio;
      ++cases;
    }
  EXPECT_EQ(cases, is_series ? 9 : 15);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Amplification, testing::ValuesIn(cases_with_closed_form()),
                         [](const auto& one) { return one.param.name; });

TEST(NewmarkAmplification, OfOtherParametersIsTheClosedForm) {
  const double omega = 20.0;
  const Oscillator oscillator{2.0 * omega * omega, 4.0 * 0.05 * omega};
  int cases = 0;
  for (const MethodCase& method : cases_with_closed_form()) {
    // The adaptive variants require gamma = 1/2, and their error estimate vanishes at beta = 1/6.
    if (method.name != "newmark" && method.name != "newmark_modified") continue;
    for (const auto& [beta, gamma] : {std::pair(1.0 / 6.0, 0.5), std::pair(0.3025, 0.6), std::pair(1.0 / 12.0, 0.5)})
      for (const double h_omega : {0.1, 1.0, 2.0}) {
        const double h = h_omega / omega;
        const std::string more = "beta = " + to_text(beta) + "\ngamma = " + to_text(gamma) + "\n";
        EXPECT_LE(difference(measured(method, oscillator, h, more), newmark(oscillator, h, beta, gamma), omega),
                  kRounding)
            << method.name << ", beta = " << beta << ", gamma = " << gamma << ", h omega = " << h_omega;
        ++cases;
      }
  }
  EXPECT_EQ(cases, 18);
}

/// The fraction of the energy of free undamped motion that remains after one step: the square of the spectral
/// radius. With y = h omega it is |1 + i y - y^2/2 - i y^3/6 + y^4/24|^2 = 1 - y^6/72 + y^8/576 for RK4, and
/// 1 for trapezoidal Newmark.
double kept_energy(const MethodCase& method, double y) {
  const auto runge_kutta = [](double z) { return 1.0 - std::pow(z, 6) / 72.0 + std::pow(z, 8) / 576.0; };
  if (method.name == "rk4") return runge_kutta(y);
  if (starts_with(method.name, "rk4_")) return std::pow(runge_kutta(0.5 * y), 2);
  return 1.0;
}

class FreeMotion : public testing::TestWithParam<MethodCase> {};

TEST_P(FreeMotion, LosesEnergyAsTheAmplificationSays) {
  // Rounding of 2000 steps.
  constexpr double kManySteps = 1e-11;
  constexpr int kSteps = 2000;
  const double omega = 20.0;
  for (const double h_omega : {0.05, 0.3, 1.0}) {
    SceneRun run(scene(GetParam(), {2.0 * omega * omega, 0.0}, 0.3, -4.0), accept_all(GetParam()));
    const double before =
        record::energy_of({0.0, Vector::Constant(1, 0.3), Vector::Constant(1, -4.0), {}, {}, {}}, run.dynamics())
            .total();
    const time::State end = equal_steps(run, h_omega / omega, kSteps).back();
    const double kept = std::pow(kept_energy(GetParam(), h_omega), kSteps);
    EXPECT_NEAR(record::energy_of(end, run.dynamics()).total() / before, kept, kManySteps) << "h omega = " << h_omega;
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, FreeMotion, testing::ValuesIn(cases_with_closed_form()),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace butee::test::amplification_test
