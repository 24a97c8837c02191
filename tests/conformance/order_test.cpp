#include <cmath>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "conformance/methods.hpp"
#include "support/scene_run.hpp"

namespace butee::test::order_test {
namespace {

/// Largest difference between the measured order and that of the method.
constexpr double kOrderTolerance = 0.05;

std::string integrator_table(const MethodCase& method, double h, double end) {
  return "[integrator]\ntype = \"" + method.name + "\"\ntime_step = " + to_text(h) + "\nend_time = " + to_text(end) +
         "\n" + method.keys;
}

/// m x'' + c x' + k x = F cos(w t + phi) from (x0, v0): damped and forced; samples do not coincide with the
/// period.
struct ForcedOscillator {
  double m = 2.0, c = 1.5, k = 110.0, F = 7.0, w = 4.1, phi = 0.4, x0 = 0.3, v0 = -1.2, end = 1.71;

  std::string scene(const MethodCase& method, double h) const {
    return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n"
           "[[element]]\ntype = \"spring\"\nnode = \"m\"\nstiffness = 110.0\ndamping = 1.5\n"
           "[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 7.0\nangular_frequency = 4.1\nphase = 0.4\n"
           "[initial]\ndisplacement = [{nodes = \"m\", value = 0.3}]\nvelocity = [{nodes = \"m\", value = -1.2}]\n" +
           integrator_table(method, h, end);
  }

  /// The closed form: steady-state part plus decaying free part.
  std::pair<double, double> exact(double t) const {
    const double a = k - m * w * w, b = c * w, size = F / (a * a + b * b);
    const auto steady = [&](double s) { return size * (a * std::cos(w * s + phi) + b * std::sin(w * s + phi)); };
    const auto steady_v = [&](double s) { return size * w * (-a * std::sin(w * s + phi) + b * std::cos(w * s + phi)); };
    const double d = c / (2.0 * m), wd = std::sqrt(k / m - d * d);
    const double p = x0 - steady(0.0), q = (v0 - steady_v(0.0) + d * p) / wd;
    const double e = std::exp(-d * t), cs = std::cos(wd * t), sn = std::sin(wd * t);
    return {steady(t) + e * (p * cs + q * sn), steady_v(t) + e * ((-d * p + wd * q) * cs + (-d * q - wd * p) * sn)};
  }
};

/// Adaptive methods show their order in their error control instead.
std::vector<MethodCase> fixed_step_cases() {
  std::vector<MethodCase> cases = method_cases();
  std::erase_if(cases, [](const MethodCase& method) { return method.order == 0.0; });
  return cases;
}

class Order : public testing::TestWithParam<MethodCase> {};
class EndState : public testing::TestWithParam<MethodCase> {};

TEST_P(Order, OfForcedDampedMotionIsTheMethods) {
  const MethodCase& method = GetParam();
  const ForcedOscillator problem;
  const auto errors = [&](int steps) {
    SceneRun run(problem.scene(method, problem.end / steps));
    EXPECT_TRUE(run.run().completed);
    const auto [x, v] = problem.exact(problem.end);
    return std::pair(std::abs(run.simulation().state().x[0] - x), std::abs(run.simulation().state().v[0] - v));
  };
  const auto coarse = errors(400), fine = errors(800);
  EXPECT_NEAR(std::log2(coarse.first / fine.first), method.order, kOrderTolerance) << "displacement";
  EXPECT_NEAR(std::log2(coarse.second / fine.second), method.order, kOrderTolerance) << "velocity";
}

TEST_P(EndState, IsCloseToTheClosedForm) {
  const MethodCase& method = GetParam();
  const ForcedOscillator problem;
  SceneRun run(problem.scene(method, 1e-3));
  ASSERT_TRUE(run.run().completed);
  EXPECT_EQ(run.simulation().state().t, problem.end);
  const auto [x, v] = problem.exact(problem.end);
  // Second order at h w = 0.007 leaves a phase error of (h w)^2/12 w t = 4e-5 of the amplitude 0.5.
  constexpr double kTolerance = 1e-4;
  EXPECT_NEAR(run.simulation().state().x[0], x, kTolerance);
  EXPECT_NEAR(run.simulation().state().v[0], v, 10.0 * kTolerance);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Order, testing::ValuesIn(fixed_step_cases()),
                         [](const auto& one) { return one.param.name; });
INSTANTIATE_TEST_SUITE_P(Catalogue, EndState, testing::ValuesIn(method_cases()),
                         [](const auto& one) { return one.param.name; });

/// An oscillator that is pressed against a stop on one side, twice within 1.3 s.
std::string contact_scene(const MethodCase& method, const std::string& law, double h) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n"
         "[[element]]\ntype = \"spring\"\nnode = \"m\"\nstiffness = 40.0\ndamping = 0.3\n"
         "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.05\nsides = \"positive\"\nstiffness = 400.0\n" +
         law + "[initial]\nvelocity = [{nodes = \"m\", value = 1.0}]\n" + integrator_table(method, h, 1.3);
}

double end_displacement(const MethodCase& method, const std::string& law, int steps) {
  SceneRun run(contact_scene(method, law, 1.3 / steps));
  EXPECT_TRUE(run.run().completed);
  return run.simulation().state().x[0];
}

MethodCase method_named(const std::string& name) {
  for (const MethodCase& method : method_cases())
    if (method.name == name) return method;
  throw std::runtime_error("no method " + name);
}

/// The mean order over six halvings of the step, against RK4 with steps below every time scale of the
/// problem.
double order_across_contact(const std::string& name, const std::string& law, int steps) {
  const double reference = end_displacement(method_named("rk4"), law, 400000);
  const int halvings = 6;
  const double first = std::abs(end_displacement(method_named(name), law, steps) - reference);
  const double last = std::abs(end_displacement(method_named(name), law, steps << halvings) - reference);
  return std::log2(first / last) / halvings;
}

// A law resolved by the steps: its transition is 1/(pi 30) = 11 mm wide.
const char* const kSmooth = "law = \"arctan\"\nregularization = 30.0\n";
const char* const kContactChange = "law = \"linear\"\n";

TEST(OrderAcrossContact, IsFourForRungeKuttaWhereTheLawIsResolved) {
  EXPECT_NEAR(order_across_contact("rk4", kSmooth, 200), 4.0, 0.1);
}

TEST(OrderAcrossContact, IsTwoForNewmark) {
  EXPECT_NEAR(order_across_contact("newmark", kSmooth, 200), 2.0, 0.05);
  // The error of a single run depends on the position of the slope discontinuity within a step; six halvings
  // average that.
  EXPECT_NEAR(order_across_contact("newmark", kContactChange, 200), 2.0, 0.35);
}

TEST(OrderAcrossContact, OfModifiedNewmarkIsOneWhereTheLawIsResolvedAndAboveItAtAKink) {
  // The secant stiffness of the last step lags by h throughout a smooth transition: a force error of O(h) for
  // a time O(1).
  EXPECT_NEAR(order_across_contact("newmark_modified", kSmooth, 200), 1.0, 0.05);
  // At a slope discontinuity it is wrong only in the step that contains it: O(h) for a time O(h), hence
  // second order with scatter.
  EXPECT_NEAR(order_across_contact("newmark_modified", kContactChange, 200), 2.0, 0.35);
}

}  // namespace
}  // namespace butee::test::order_test
