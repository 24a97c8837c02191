// Stability limits of each method, measured on its one-step map, compared with its declaration and with
// theory.
#include <cmath>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "apps/butee/stability/analysis.hpp"
#include "conformance/methods.hpp"
#include "support/scene_run.hpp"

namespace butee::test::stability_test {
namespace {

using app::stability::find_limit;
using app::stability::Limit;
using app::stability::OneStepMap;
using app::stability::Oscillator;
using app::stability::properties_of;

const plugin::Catalogue& catalogue() {
  static const plugin::Catalogue instance = [] {
    plugin::Catalogue made;
    made.add(BUTEE_TEST_PLUGINS);
    return made;
  }();
  return instance;
}

OneStepMap map_of(const std::string& method, const Oscillator& oscillator,
                  const std::vector<std::string>& settings = {}) {
  return {catalogue(), method, settings, oscillator};
}

/// The limit is where the spectral radius exceeds 1 by kStable; its error is kStable over the slope of the
/// radius, which is 4e-3 for dopri5.
constexpr double kBisected = 3e-6;

class Stability : public testing::TestWithParam<MethodCase> {};

void expect_limit(const Limit& limit, double declared, const char* axis) {
  if (std::isinf(declared)) {
    EXPECT_NE(limit.kind, Limit::Kind::found) << axis << ": unstable at " << limit.value;
    EXPECT_GT(limit.value, 1.0) << axis << ": " << limit.why;
  } else {
    EXPECT_EQ(limit.kind, Limit::Kind::found) << axis << ": " << limit.why;
    EXPECT_NEAR(limit.value, declared, kBisected * declared) << axis;
  }
}

TEST_P(Stability, ReachesAsFarAsTheMethodDeclares) {
  OneStepMap undamped = map_of(GetParam().name, {}), dashpot = map_of(GetParam().name, {0.0, 1.0, 0.0});
  expect_limit(find_limit(undamped), undamped.type().stability_limit, "h omega");
  expect_limit(find_limit(dashpot), undamped.type().damping_limit, "h c/m");
}

TEST_P(Stability, OfAClosedStopIsThatOfAStifferSpring) {
  const double stop = 8.0;  // triples omega
  OneStepMap map = map_of(GetParam().name, {1.0, 0.0, stop});
  const double declared = map.type().stability_limit;
  if (std::isfinite(declared)) expect_limit(find_limit(map), declared / 3.0, "h omega with a stop");
}

TEST_P(Stability, DampsAndShiftsLittleWhereStepsAreSmall) {
  const double h = 0.05, ratio = 0.02;
  OneStepMap map = map_of(GetParam().name, {1.0, 2.0 * ratio, 0.0});
  const auto matrix = map.at(h);
  ASSERT_TRUE(matrix) << map.refusal();
  const auto properties = properties_of(*matrix, h, ratio);
  // Second order: (h omega)^2/4 = 6e-4 is the largest period error of all methods. The damping error is of
  // higher order, except the first-order numerical damping of generalized-alpha and HHT.
  constexpr double kPeriod = 1e-3, kDamping = 2e-3;
  EXPECT_NEAR(*properties.period_error, 0.0, kPeriod);
  EXPECT_NEAR(*properties.damping, 0.0, kDamping);
  EXPECT_NEAR(*properties.radius, std::exp(-ratio * h), kDamping * h);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Stability, testing::ValuesIn(method_cases()),
                         [](const auto& one) { return one.param.name; });

TEST(StabilityTheory, OfRungeKutta4) {
  OneStepMap undamped = map_of("rk4", {}), dashpot = map_of("rk4", {0.0, 1.0, 0.0});
  EXPECT_NEAR(find_limit(undamped).value, 2.0 * std::sqrt(2.0), kBisected);
  EXPECT_NEAR(find_limit(dashpot).value, 2.785293563405, kBisected);
}

TEST(StabilityTheory, OfCentralDifferencesAndNewmark) {
  OneStepMap central = map_of("central_differences", {});
  EXPECT_NEAR(find_limit(central).value, 2.0, kBisected);
  OneStepMap newmark = map_of("newmark", {});
  EXPECT_EQ(find_limit(newmark).kind, Limit::Kind::unbounded);
  // Linear acceleration, beta = 1/6: 2 sqrt 3. Source: T. J. R. Hughes, The Finite Element Method, section 9.1.
  OneStepMap linear = map_of("newmark", {}, {"beta=0.16666666666666666"});
  EXPECT_NEAR(find_limit(linear).value, 2.0 * std::sqrt(3.0), kBisected);
}

TEST(StabilityTheory, OfTheTrapezoidalRulesPeriod) {
  // The phase advances by 2 atan(h omega/2) in a step, without damping.
  OneStepMap map = map_of("newmark", {});
  for (const double h : {0.1, 1.0, 3.0}) {
    const auto properties = properties_of(*map.at(h), h, 0.0);
    EXPECT_NEAR(*properties.period_error, h / (2.0 * std::atan(0.5 * h)) - 1.0, 1e-10);
    EXPECT_NEAR(*properties.damping, 0.0, 1e-10);
  }
}

TEST(StabilityTheory, OfGeneralizedAlphaAtInfinity) {
  // The spectral radius at infinite frequency is the method's parameter.
  for (const double rho : {0.0, 0.5, 0.8, 1.0}) {
    OneStepMap map = map_of("generalized_alpha", {}, {"rho_inf=" + to_text(rho)});
    // Three merging eigenvalues differ by the cube root of the remainder at a finite step.
    EXPECT_NEAR(*properties_of(*map.at(1e4), 1e4, 0.0).radius, rho, 0.03) << rho;
  }
}

TEST(StabilityMap, DoesNotExistForAMethodThatTakesStepsOfItsOwn) {
  OneStepMap exact = map_of("exact", {});
  EXPECT_TRUE(exact.at(0.1));
  EXPECT_FALSE(exact.at(1e3));
  EXPECT_NE(exact.refusal().find("of its own"), std::string::npos) << exact.refusal();
}

}  // namespace
}  // namespace butee::test::stability_test
