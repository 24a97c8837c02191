#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "contact/arctan.hpp"
#include "contact/linear.hpp"

namespace butee::test::contact_law_test {
namespace {

/// A few dozen roundings: near |x| = 20 the tangent, a difference, loses a factor of 1.5 x^2.
constexpr double kFormula = 2e-13;
/// Fourth-order differences with a step of a thousandth: truncation 1e-12 of a derivative that varies, rounding 1e-13.
constexpr double kDifference = 1e-9;
constexpr long double kPi = std::numbers::pi_v<long double>;

/// The textbook law with 64 bits of mantissa. Source: K. L. Nguyen et al., CFM 2017 (hal-03465572), section 2, and for
/// the energy the integral of its force by parts.
struct Textbook {
  long double k, lambda;

  /// atan(1/y) - y/(1 + y^2) = r^3 int_0^1 2 s^2/(1 + r^2 s^2)^2 ds with r = 1/y; the integral has no
  /// cancellation.
  static long double tangent_part(long double y) {
    if (y < 1.0L) return kPi / 2 - std::atan(y) - y / (1.0L + y * y);
    // Gauss-Legendre with three points on many panels: exact to 1e-18 here.
    constexpr int kPanels = 256;
    const long double r = 1.0L / y, node = std::sqrt(0.6L), width = 1.0L / kPanels;
    const auto f = [r](long double s) { return 2 * s * s / ((1 + r * r * s * s) * (1 + r * r * s * s)); };
    long double sum = 0.0L;
    for (int i = 0; i < kPanels; ++i) {
      const long double c = (i + 0.5L) * width, d = 0.5L * width * node;
      sum += width / 18 * (5 * f(c - d) + 8 * f(c) + 5 * f(c + d));
    }
    return r * r * r * sum;
  }
  static long double angle(long double y) { return y > 0.0L ? std::atan(1.0L / y) : kPi / 2; }

  long double secant(long double g) const {
    const long double x = kPi * lambda * g;
    return x < 0 ? k / kPi * angle(-x) : k * (1 - angle(x) / kPi);
  }
  long double tangent(long double g) const {
    const long double x = kPi * lambda * g, part = tangent_part(std::abs(x)) / kPi;
    return x < 0 ? k * part : k * (1 - part);
  }
  /// k [g^2/4 + (1/pi)(g^2/2 atan x - g/(2 s) + atan(x)/(2 s^2))]; open: the same with atan x = -pi/2 + atan(1/|x|).
  long double energy(long double g) const {
    const long double s = kPi * lambda, y = std::abs(s * g);
    const long double open = (y * y * angle(y) + (y - std::atan(y))) / (2 * kPi * s * s);
    return g < 0 ? k * open : k * (g * g / 2 - open);
  }
};

/// |g| from 1e-9 to 1 m, 20 per decade, both signs; and both sides of |x| = 20 and 1e4, where the code
/// switches formulas.
std::vector<double> penetrations(double lambda) {
  std::vector<double> all;
  for (const double sign : {1.0, -1.0}) {
    for (int i = 0; i <= 180; ++i) all.push_back(sign * std::pow(10.0, -9.0 + i / 20.0));
    for (const double x : {19.99, 20.0, 20.01, 9999.0, 10000.0, 10001.0})
      all.push_back(sign * x / (std::numbers::pi * lambda));
  }
  return all;
}
constexpr std::size_t kPenetrations = 2 * (181 + 6);

struct Case {
  double stiffness, regularization;
};

class ArctanLaw : public testing::TestWithParam<Case> {
 protected:
  contact::Arctan law_{GetParam().stiffness, GetParam().regularization};
  Textbook textbook_{GetParam().stiffness, GetParam().regularization};
};

TEST_P(ArctanLaw, IsTheTextbookFormulaAtEveryDistance) {
  std::size_t cases = 0;
  for (const double g : penetrations(GetParam().regularization)) {
    const auto expect = [g](double got, long double wanted, const char* what) {
      EXPECT_NEAR(static_cast<double>(got / wanted), 1.0, kFormula) << what << " at g = " << g;
    };
    expect(law_.secant(g), textbook_.secant(g), "secant");
    expect(law_.tangent(g), textbook_.tangent(g), "tangent");
    expect(law_.energy(g), textbook_.energy(g), "energy");
    ++cases;
  }
  EXPECT_EQ(cases, kPenetrations);
}

template <class Function>
double derivative(const Function& f, double g) {
  const double h = 1e-3 * std::abs(g);
  return (8.0 * (f(g + h) - f(g - h)) - (f(g + 2 * h) - f(g - 2 * h))) / (12.0 * h);
}

TEST_P(ArctanLaw, TangentAndForceAreTheDerivativesOfForceAndEnergy) {
  const auto force = [this](double g) { return law_.secant(g) * g; };
  for (const double g : penetrations(GetParam().regularization)) {
    EXPECT_NEAR(derivative(force, g), law_.tangent(g), kDifference * law_.secant(g)) << g;
    EXPECT_NEAR(derivative([this](double y) { return law_.energy(y); }, g), force(g), kDifference * std::abs(force(g)))
        << g;
  }
}

TEST_P(ArctanLaw, OpenAndClosedAddUpToTheFullStiffness) {
  const double k = GetParam().stiffness;
  for (const double g : penetrations(GetParam().regularization)) {
    EXPECT_NEAR(law_.secant(g) + law_.secant(-g), k, kFormula * k);
    EXPECT_NEAR(law_.tangent(g) + law_.tangent(-g), k, kFormula * k);
  }
  EXPECT_EQ(law_.closed_stiffness(), k);
}

TEST_P(ArctanLaw, AnOpenStopPullsWithItsFarForce) {
  const double far = GetParam().stiffness / (std::numbers::pi * std::numbers::pi * GetParam().regularization);
  EXPECT_NEAR(law_.asymptotic_force(), far, kFormula * far);
  for (const double g : {0.01, 0.1, 1.0}) {
    const double y = std::numbers::pi * GetParam().regularization * g;
    // F = -far (1 - 1/(3 y^2) + ...), at most far in absolute value.
    EXPECT_NEAR(law_.secant(-g) * -g, -far, (1.0 / (3 * y * y) + kFormula) * far);
    EXPECT_LE(law_.secant(-g) * g, far * (1 + kFormula));
  }
}

TEST_P(ArctanLaw, AtTheGapHalfTheStiffnessActs) {
  EXPECT_EQ(law_.secant(0.0), 0.5 * GetParam().stiffness);
  EXPECT_EQ(law_.tangent(0.0), 0.5 * GetParam().stiffness);
  EXPECT_EQ(law_.energy(0.0), 0.0);
}

INSTANTIATE_TEST_SUITE_P(parameters, ArctanLaw, testing::Values(Case{1e6, 7e7}, Case{1e10, 7e7}, Case{3e4, 1e6}),
                         [](const auto& instance) { return "set_" + std::to_string(instance.index); });

TEST_P(ArctanLaw, TheSeriesIsTheForceAlongAPath) {
  // Paths that pass the gap, and paths on either side of it; each is within the radius of convergence
  // |g|/|g'|.
  const auto series = law_.force_series();
  for (const double start : {-1e-2, -1e-5, 1e-5, 1e-2}) {
    const std::vector<double> path = {start, 0.3 * start, -0.1 * start};
    std::vector<double> g, force;
    for (std::size_t k = 0; k < 60; ++k) {
      g.push_back(k < path.size() ? path[k] : 0.0);
      force.push_back(series->next(g));
    }
    for (const double s : {0.0, 0.5, 1.0}) {
      double sum = 0.0;
      for (std::size_t k = force.size(); k > 0; --k) sum = sum * s + force[k - 1];
      const double at = path[0] + s * (path[1] + s * path[2]), expected = law_.secant(at) * at;
      // At an open stop k_c g and terms of the size of the residual force cancel.
      EXPECT_NEAR(sum, expected, 1e-12 * std::abs(expected));
    }
  }
}

TEST(LinearLaw, ActsOnPenetrationAlone) {
  constexpr double kStiffness = 3e5;
  const contact::Linear law(kStiffness);
  for (const double g : {1e-9, 1e-4, 0.3, 1.0}) {
    EXPECT_EQ(law.secant(g), kStiffness);
    EXPECT_EQ(law.tangent(g), kStiffness);
    EXPECT_DOUBLE_EQ(law.energy(g), 0.5 * kStiffness * g * g);
    EXPECT_EQ(law.secant(-g), 0.0);
    EXPECT_EQ(law.tangent(-g), 0.0);
    EXPECT_EQ(law.energy(-g), 0.0);
  }
  EXPECT_EQ(law.energy(0.0), 0.0);
  EXPECT_EQ(law.closed_stiffness(), kStiffness);
  EXPECT_EQ(law.asymptotic_force(), 0.0);
}

/// Equal to 4 units in the last place: a vectorised loop may contract products and sums differently.
TEST(ContactLaw, BatchesAreTheScalarFunctions) {
  const contact::Arctan arctan(1e6, 7e7);
  const contact::Linear linear(2e6);
  const std::vector<double> g = penetrations(7e7);
  for (const model::ContactLaw* law : std::initializer_list<const model::ContactLaw*>{&arctan, &linear}) {
    std::vector<double> secants(g.size()), both(g.size()), tangents(g.size());
    law->secants(g, secants);
    law->tangents(g, both, tangents);
    for (std::size_t i = 0; i < g.size(); ++i) {
      EXPECT_DOUBLE_EQ(secants[i], law->secant(g[i]));
      EXPECT_DOUBLE_EQ(both[i], law->secant(g[i]));
      EXPECT_DOUBLE_EQ(tangents[i], law->tangent(g[i]));
    }
  }
}

}  // namespace
}  // namespace butee::test::contact_law_test
