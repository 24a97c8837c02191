#include "integrators/exponential/step_size.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace butee::test::step_size_test {
namespace {

using integrators::StepError;
using integrators::StepSizeControl;

constexpr int kFirst = -20;
const StepSizeControl::Outcome kEasyContact = {false, {0.01, 1.0}, 0.0}, kContact = {false, {0.5, 1.0}, 0.0},
                               kFree = {true, {0.0, 1.0}, 0.3};

TEST(StepSizeControl, GrowsAfterContactsFarBelowTheErrorBoundAlone) {
  StepSizeControl control(kFirst);
  control.accept(kContact, true);
  EXPECT_EQ(control.next_index(), kFirst);
  control.accept(kEasyContact, false);  // a shortened step gives no information
  EXPECT_EQ(control.next_index(), kFirst);
  control.accept(kEasyContact, true);
  EXPECT_EQ(control.next_index(), kFirst + 1);
}

TEST(StepSizeControl, TakesLongerStepsWithoutContactAndReturnsToThoseWithIt) {
  StepSizeControl control(kFirst);
  control.accept(kContact, true);
  control.accept(kFree, true);
  EXPECT_EQ(control.next_index(), kFirst + 2);
  control.accept({true, {0.0, 1.0}, 0.04}, true);  // ten times below: one index, which is a factor of eight
  EXPECT_EQ(control.next_index(), kFirst + 3);
  EXPECT_EQ(control.contact_index(), kFirst);
  control.accept(kContact, true);
  EXPECT_EQ(control.next_index(), kFirst);
}

TEST(StepSizeControl, EndsALongStepBeforeTheNextContact) {
  StepSizeControl control(kFirst);
  control.load({kFirst, 1.0, 6.0});
  EXPECT_EQ(control.next_index(), kFirst + 6);
  EXPECT_EQ(control.next_index(1.0), kFirst + 6);
  const double time = 1.01 * std::exp2(0.5 * (kFirst + 4));
  EXPECT_EQ(control.next_index(time), kFirst + 4);
  EXPECT_EQ(control.next_index(1e-30), kFirst);
  EXPECT_EQ(control.next_index(-1.0), kFirst);
}

/// The interpolation error grows by a factor of eight with each index: it stays below 0.4 of its bound.
TEST(StepSizeControl, LeavesTheInterpolationErrorAReserve) {
  for (double part = 1e-6; part < 1.0; part *= 1.7) {
    const int up = StepSizeControl::indices_up(part);
    EXPECT_GE(up, 0);
    EXPECT_LE(up, 8);
    if (up > 0) {
      EXPECT_LE(part * std::pow(8.0, up), 0.4 * (1.0 + 1e-12));
    }
    if (up < 8) {
      EXPECT_GT(part * std::pow(8.0, up + 1), 0.4 * (1.0 - 1e-12));
    }
  }
  EXPECT_EQ(StepSizeControl::indices_up(0.0), 8);
}

TEST(StepSizeControl, GoesDownByTheFifthPowerOfTheErrorOfContacts) {
  StepSizeControl control(kFirst);
  const StepSizeControl::Retry retry = control.reject({false, {100.0, 1.0}, 0.0}, kFirst, true, 0.0);
  EXPECT_EQ(retry.index, kFirst - 2);  // sqrt 2^(5 * 2) < 100 < sqrt 2^(5 * 3)
  EXPECT_TRUE(retry.was_contact);
  EXPECT_EQ(control.contact_index(), kFirst - 2);
  // For a shortened step, the next larger index is the starting point.
  EXPECT_EQ(control.reject({false, {2.0, 1.0}, 0.0}, kFirst, false, 0.9 * std::exp2(0.5 * (kFirst - 4))).index,
            kFirst - 5);
}

TEST(StepSizeControl, GoesDownToTheStepsWithContactAtMostWhereALongStepMeetsAStop) {
  StepSizeControl control(kFirst);
  control.load({kFirst, 1.0, 5.0});
  StepSizeControl::Retry retry = control.reject(kContact, kFirst + 5, true, 0.0);
  EXPECT_EQ(retry.index, kFirst + 2);
  EXPECT_FALSE(retry.was_contact);
  EXPECT_EQ(control.reject(kContact, retry.index, true, 0.0).index, kFirst);
  EXPECT_EQ(control.contact_index(), kFirst);
  retry = control.reject(kFree, kFirst + 5, true, 0.0);
  EXPECT_EQ(retry.index, kFirst + 4);
  EXPECT_EQ(control.next_index(), kFirst + 4);
}

TEST(StepSizeControl, IsAPartOfTheState) {
  StepSizeControl control(kFirst), other(kFirst);
  control.load(control.start());
  control.accept(kEasyContact, true);
  control.accept(kFree, true);
  other.load(control.save());
  EXPECT_EQ(other.next_index(), control.next_index());
  EXPECT_EQ(other.contact_index(), control.contact_index());
  EXPECT_NE(other.next_index(), kFirst);
  EXPECT_FALSE(control.is_shortest(kFirst - 79));
  EXPECT_TRUE(control.is_shortest(kFirst - 80));
  EXPECT_TRUE(control.is_start_from_rest(kFirst - 11));
}

}  // namespace
}  // namespace butee::test::step_size_test
