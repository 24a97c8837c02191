#include <cmath>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "conformance/fixed_steps.hpp"

namespace butee::test::equal_steps_test {
namespace {

/// Largest difference between the measured order and that of the method.
constexpr double kOrderTolerance = 0.05;

/// Two coupled masses with a dashpot and modal damping, driven at a frequency off their natural ones, and
/// sampled off the load's period. The first mass moves between stops on both sides, whose law is smooth
/// within 1/(pi lambda) = 11 mm. (A single stop on both sides would have a discontinuity at u = 0.)
std::string scene(const MethodCase& method, bool with_stops) {
  const auto stop = [](const std::string& sides) {
    return "[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 0.05\nstiffness = 400.0\nlaw = \"arctan\"\n"
           "regularization = 30.0\nsides = \"" +
           sides + "\"\n";
  };
  const std::string stops = stop("positive") + stop("negative");
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n"
         "[[element]]\ntype = \"mass\"\nname = \"b\"\nmass = 2.0\n"
         "[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 40.0\ndamping = 0.3\n"
         "[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 60.0\n"
         "[damping]\nmodal = [0.03, 0.01]\n"
         "[[load]]\ntype = \"harmonic\"\nnode = \"b\"\namplitude = 9.0\nangular_frequency = 5.3\nphase = 0.4\n"
         "[initial]\ndisplacement = [{nodes = \"a\", value = 0.02}]\nvelocity = [{nodes = \"b\", value = -0.9}]\n" +
         (with_stops ? stops : std::string()) + "[integrator]\ntype = \"" + method.name +
         "\"\ntime_step = 1e-3\nend_time = 2.0\n" + method.keys;
}

constexpr double kEnd = 1.37;

constexpr int kSamples = 10;

std::vector<time::State> states(const MethodCase& method, bool with_stops, int steps) {
  SceneRun run(scene(method, with_stops), accept_all(method));
  return equal_steps(run, kEnd / steps, steps, kSamples);
}

/// Runge-Kutta with steps of 3e-5 s: error below 1e-12 of the motion.
const std::vector<time::State>& reference(bool with_stops) {
  static const MethodCase rk4{"rk4", "", 4.0};
  static const auto with = states(rk4, true, 50000), without = states(rk4, false, 50000);
  return with_stops ? with : without;
}

struct Errors {
  double x = 0.0, v = 0.0;
};

/// Root sum of squares over both masses and all samples, so that a zero of the error at one instant does not
/// matter.
Errors errors(const MethodCase& method, bool with_stops, int steps) {
  const auto got = states(method, with_stops, steps), &exact = reference(with_stops);
  Errors sum;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    sum.x += (got[i].x - exact[i].x).squaredNorm();
    sum.v += (got[i].v - exact[i].v).squaredNorm();
  }
  return {std::sqrt(sum.x), std::sqrt(sum.v)};
}

/// The measured orders of x and of v, from one halving of the step.
Errors orders(const MethodCase& method, bool with_stops, int steps) {
  const Errors coarse = errors(method, with_stops, steps), fine = errors(method, with_stops, 2 * steps);
  return {std::log2(coarse.x / fine.x), std::log2(coarse.v / fine.v)};
}

class EqualSteps : public testing::TestWithParam<MethodCase> {};

TEST_P(EqualSteps, HaveTheMethodsOrderInForcedDampedMotion) {
  // With more steps a method of order 8 reaches the error of the reference.
  const auto [x, v] = orders(GetParam(), false, GetParam().step_order() > 6.0 ? 20 : 200);
  EXPECT_NEAR(x, GetParam().step_order(), kOrderTolerance) << "displacement";
  EXPECT_NEAR(v, GetParam().step_order(), kOrderTolerance) << "velocity";
}

TEST_P(EqualSteps, HaveTheMethodsOrderBetweenStopsOnBothSides) {
  const MethodCase& method = GetParam();
  // The secant stiffness of the last step lags by h in a transition resolved by the steps.
  const double order = method.name.rfind("newmark_modified", 0) == 0 ? 1.0 : method.step_order();
  if (order > 6.0) {
    // No halving fits between the step that resolves the curved law and the error of the reference; the error
    // itself is very small.
    EXPECT_LT(errors(method, true, 800).x, 1e-11);
    return;
  }
  const auto [x, v] = orders(method, true, 800);
  EXPECT_NEAR(x, order, kOrderTolerance) << "displacement";
  EXPECT_NEAR(v, order, kOrderTolerance) << "velocity";
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EqualSteps, testing::ValuesIn(cases_with_step_order()),
                         [](const auto& one) { return one.param.name; });

/// Checks that the mass strikes both stops.
TEST(EqualStepsScene, StrikesBothStops) {
  SceneRun run(scene({"rk4", "", 4.0}, true));
  record::ImpactRecorder impacts(run.dynamics());
  run.simulation().add(impacts);
  ASSERT_TRUE(run.run().completed);
  int positive = 0, negative = 0;
  for (const record::Impact& impact : impacts.impacts()) ++(impact.side > 0 ? positive : negative);
  EXPECT_GT(positive, 0);
  EXPECT_GT(negative, 0);
}

}  // namespace
}  // namespace butee::test::equal_steps_test
