// The constants kappa of integrators/error-control.md: ratio of the local error of undamped oscillation to
// the power of its estimate that the step control uses.
#include <cmath>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "integrators/error_account.hpp"
#include "support/scene_run.hpp"

namespace butee::test::error_constant_test {
namespace {

constexpr double kFrequency = 10.0, kTolerance = 1e-3, kEnd = 1.0;
/// Estimate and error may have different phases in the oscillation; the largest component varies between 0.71
/// and 1.
constexpr double kPhases = 1.45;

struct Case {
  const char* method;
  double estimate, order;  ///< q, p
  double turn;             ///< h omega: small, but large enough that the error is well above rounding
};

class ErrorConstant : public testing::TestWithParam<Case> {};

TEST_P(ErrorConstant, TurnsTheEstimateIntoTheLocalError) {
  const auto [method, q, p, turn] = GetParam();
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 100.0\n[integrator]\ntype = \"" +
      std::string(method) + "\"\ntolerance = " + to_text(kTolerance) + "\nend_time = " + to_text(kEnd) + "\n");
  const double x = std::sqrt(0.5), v = -kFrequency * std::sqrt(0.5), h = turn / kFrequency;
  time::State from;
  from.x = Vector::Constant(1, x);
  from.v = Vector::Constant(1, v);
  run.integrator().start(from);
  time::State to = from;
  const time::StepReport report = run.integrator().step(from, {h, h, false}, to);
  ASSERT_EQ(report.status, time::StepStatus::ok);
  const double c = std::cos(turn), s = std::sin(turn);
  const double true_x = c * x + s / kFrequency * v, true_v = c * v - kFrequency * s * x;
  const double scale_x = std::max(x, std::abs(to.x[0])), scale_v = std::max(-v, std::abs(to.v[0]));
  const double error = std::max(std::abs(to.x[0] - true_x) / scale_x, std::abs(to.v[0] - true_v) / scale_v);
  // The measure is epsilon over the error allowed in one of T/h steps; its power (p + 1)/q is the error over
  // that.
  const double rate = integrators::ErrorAccount({kTolerance, kEnd}).rate();
  const double expected = rate * h * std::pow(report.error, (p + 1.0) / q);
  EXPECT_GT(error, expected / kPhases);
  EXPECT_LT(error, expected * kPhases);
}

struct Kink {
  const char* method;
  double bound;  ///< LocalErrorControl::Orders::kink
};

class KinkBound : public testing::TestWithParam<Kink> {};

/// A free mass of 1 kg at 1 m/s closes a stop at some place of a step of h = 1 s. The stop is so soft that the path is
/// straight: the speed lost is k (1 - a)^2/2.
TEST_P(KinkBound, IsTheLargestErrorOfAStepInWhichAStopCloses) {
  constexpr double kStiffness = 1e-6;
  constexpr int kPlaces = 200;
  double largest = 0.0;
  for (int place = 1; place < kPlaces; ++place) {
    const double a = static_cast<double>(place) / kPlaces;
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[contact]]\ntype = \"stop\"\nnodes = "
        "\"m\"\nsides = \"positive\"\nlaw = \"linear\"\nstiffness = " +
        to_text(kStiffness) + "\ngap = " + to_text(a) + "\n[integrator]\ntype = \"" + GetParam().method +
        "\"\ntolerance = 1e-3\nend_time = 1.0\n");
    time::State from;
    from.x = Vector::Zero(1);
    from.v = Vector::Ones(1);
    run.integrator().start(from);
    time::State to = from;
    ASSERT_EQ(run.integrator().step(from, {1.0, 1.0, false}, to).status, time::StepStatus::ok);
    largest = std::max(largest, std::abs(1.0 - 0.5 * kStiffness * (1.0 - a) * (1.0 - a) - to.v[0]) / kStiffness);
  }
  EXPECT_LT(largest, 1.0001 * GetParam().bound);  // the path is not quite straight
  EXPECT_GT(largest, 0.9 * GetParam().bound);
}

INSTANTIATE_TEST_SUITE_P(Methods, KinkBound,
                         testing::Values(Kink{"rodas4", 0.032}, Kink{"dopri5", 0.0225}, Kink{"extrapolation8", 9.2e-3},
                                         Kink{"bathe_adaptive", 0.0625}, Kink{"central_differences_adaptive", 0.125},
                                         Kink{"hht_alpha_adaptive", 0.124}, Kink{"generalized_alpha_adaptive", 0.0988}),
                         [](const auto& one) { return std::string(one.param.method); });

INSTANTIATE_TEST_SUITE_P(Methods, ErrorConstant,
                         testing::Values(Case{"rodas4", 4.0, 4.0, 0.3}, Case{"dopri5", 5.0, 5.0, 0.2},
                                         Case{"extrapolation8", 7.0, 8.0, 0.8}, Case{"bathe_adaptive", 3.0, 2.0, 0.1}),
                         [](const auto& one) { return std::string(one.param.method); });

}  // namespace
}  // namespace butee::test::error_constant_test
