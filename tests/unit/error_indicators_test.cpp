#include "integrators/exponential/error_indicators.hpp"

#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "integrators/exponential/change_accounts.hpp"

namespace butee::test::error_indicators_test {
namespace {

using namespace integrators;

TEST(ErrorIndicators, CountTheStepsOfACharacteristicTime) {
  EXPECT_EQ(characteristic_steps({2.0, 0.0}, 0.1), 1.0);  // nothing moves
  EXPECT_DOUBLE_EQ(characteristic_steps({2.0, 4.0}, 0.1), 5.0);
  EXPECT_EQ(characteristic_steps({2.0, 4.0}, 3.0), 1.0);  // the step is longer
  EXPECT_DOUBLE_EQ(ContactScale({2.0, 4.0}).characteristic_time(), 0.5);
  EXPECT_EQ(share_of_run(0.1, 5.0, 1.0), 1.0);
  EXPECT_DOUBLE_EQ(share_of_run(0.1, 5.0, 50.0), 0.1);
}

/// An error of the path by the allowed change causes an error within the tolerance in the displacement, and
/// in the velocity that the stop's force produces, which is sigma times the change over h.
TEST(ErrorIndicators, AllowChangesWithinTheToleranceOfDisplacementAndSpeed) {
  constexpr double kTolerance = 1e-4;
  for (const double stiff : {1e-6, 0.1, 3.0, 1e4})
    for (const double h : {1e-6, 1e-2, 1.0})
      for (const double speed : {1e-3, 1.0, 1e3}) {
        const ContactScale scale = {0.02, speed};
        const double change = allowed_change(kTolerance, stiff, h, scale);
        EXPECT_GT(change, 0.0);
        EXPECT_LE(change, kTolerance * scale.displacement * (1.0 + 1e-15));
        const double floor = kLeastPart * stiff * scale.displacement;
        EXPECT_LE(stiff * change, kTolerance * std::max(h * speed, floor) * (1.0 + 1e-15));
      }
  EXPECT_GT(allowed_change(kTolerance, 1.0, 1e-3, {0.02, 0.0}), 0.0);  // a stop at rest converges as well
}

TEST(ErrorIndicators, WeighTheQuarticTermByTheSpeedThatAStiffStopMakesOfIt) {
  const ContactScale scale = {1.0, 10.0};
  EXPECT_EQ(path_error(1e-3, 0.1, 0.1, scale, false), 1e-3);                       // a soft stop
  EXPECT_DOUBLE_EQ(path_error(1e-3, 100.0, 0.1, scale, false), 1e-3 * 0.1 * 1e4);  // 0.1 sigma^2
  EXPECT_DOUBLE_EQ(path_error(1e-3, 100.0, 0.1, scale, true), 1e-3 * 0.5 * 1e4);
}

/// The errors of a stop's changes add up to 4.4 tolerances at most, however many there are and whenever they come.
TEST(ErrorIndicators, ShareTheToleranceAmongTheChangesOfContactOfAStop) {
  constexpr double kTolerance = 1e-4, kRunTime = 2.0;
  for (const int changes : {1, 10, 1000}) {
    ChangeAccounts accounts(account_goal({kTolerance, kTolerance, kTolerance, kRunTime}, 0.0), 2);
    std::vector<double> memory(static_cast<std::size_t>(accounts.memory_size()));
    accounts.start(5.0, memory.data());
    accounts.load(memory.data());
    double sum = 0.0;
    for (int k = 1; k <= changes; ++k) {
      const double error = accounts.allowed(1, 5.0 + kRunTime * k / changes);
      EXPECT_GT(error, 0.0);
      accounts.charge(1, error);
      sum += error;
    }
    EXPECT_LE(sum, 4.4 * kTolerance);
    EXPECT_GE(sum, 2.0 * kTolerance);
    EXPECT_DOUBLE_EQ(accounts.allowed(0, 5.0 + kRunTime), 2.2 * kTolerance);  // another stop
    accounts.save(memory.data());
    EXPECT_NEAR(memory[1] - memory[0], sum, 1e-15);
  }
  // A run beyond a thousand periods may err as much in each thousand.
  const ChangeAccounts longer(
      account_goal({kTolerance, kTolerance, kTolerance, 100.0 * kRunTime}, 1e3 * 2.0 * std::numbers::pi / kRunTime), 1);
  EXPECT_DOUBLE_EQ(longer.allowed(0, kRunTime), 0.5 * 4.0 * kTolerance);
}

TEST(ErrorIndicators, ChargeAChangeOfContactByItsSpeedAndStiffness) {
  const ContactScale scale = {1.0, 10.0};
  EXPECT_DOUBLE_EQ(change_error(0.1, 0.5, 0.1, scale), 1.5e-4 * 0.01 * 0.5);
  EXPECT_EQ(change_error(0.1, 0.0, 0.1, {}), 0.0);  // at rest
}

TEST(ErrorIndicators, AskForALongerStepFarBelowTheirBoundAlone) {
  EXPECT_TRUE((StepError{0.0, 1.0}.is_below_growth_limit()));
  EXPECT_TRUE((StepError{0.09, 1.0}.is_below_growth_limit()));
  EXPECT_FALSE((StepError{0.11, 1.0}.is_below_growth_limit()));
  EXPECT_FALSE((StepError{0.0, 0.0}.is_below_growth_limit()));  // no error information
  EXPECT_EQ((StepError{3.0, 2.0}.ratio()), 1.5);
}

}  // namespace
}  // namespace butee::test::error_indicators_test
