#include "integrators/exponential/contact_onset.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::contact_onset_test {
namespace {

using integrators::ContactOnset;

constexpr double kStiffness = 3e6, kGap = 0.01, kSpeed = 0.4, kStep = 2e-3;
/// The error of Lobatto's rule with six points for the integral of s^(3/2) over [0, 1], 0.4 less the sum of the
/// values at the points times their weights (computed apart, with Python).
constexpr double kOfHertz = 3.24e-5;

std::string with_contact(const std::string& contact) {
  return two_masses(
      "[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 1.0\n[[contact]]\ngap = 0.01\n"
      "stiffness = 3e6\n" +
      contact);
}

struct Onset {
  explicit Onset(const std::string& contact) : run(with_contact(contact)) {}
  Vector errors(double penetration, double rate, double h) {
    Vector x = Vector::Zero(2), v = Vector::Zero(2), errors = Vector::Zero(2);
    x[run.dof("a")] = kGap + penetration;
    v[run.dof("a")] = rate;
    onset.add_errors({0.0, h, x, v}, errors);
    return errors;
  }
  SceneRun run;
  ContactOnset onset{run.dynamics()};
};

/// The mean force of Hertz's law along a way of kSpeed kStep.
double expected() {
  return kOfHertz * kStiffness * std::pow(kSpeed * kStep, 1.5);
}

TEST(ContactOnset, ErrsByLobattosRuleForThePowerThreeHalves) {
  Onset onset("type = \"stop\"\nlaw = \"hertz\"\nnodes = \"a\"\n");
  ASSERT_TRUE(onset.onset.any());
  const Index a = onset.run.dof("a"), b = onset.run.dof("b");
  EXPECT_NEAR(onset.errors(0.0, kSpeed, kStep)[a], expected(), 5e-3 * expected());
  EXPECT_EQ(onset.errors(0.0, kSpeed, kStep)[b], 0.0);
  // At the end of a step the body leaves the stop.
  EXPECT_NEAR(onset.errors(0.0, -kSpeed, -kStep)[a], expected(), 5e-3 * expected());
}

TEST(ContactOnset, ActsOnBothBodiesOfAPair) {
  Onset onset("type = \"stop\"\nlaw = \"hertz\"\nbetween = [\"a\", \"b\"]\nsides = \"positive\"\n");
  const Vector errors = onset.errors(0.0, kSpeed, kStep);
  EXPECT_NEAR(errors[0], expected(), 5e-3 * expected());
  EXPECT_EQ(errors[1], errors[0]);
}

TEST(ContactOnset, IsSmallBehindTheBorderAndAbsentElsewhere) {
  Onset onset("type = \"stop\"\nlaw = \"hertz\"\nnodes = \"a\"\n");
  const Index a = onset.run.dof("a");
  const double way = kSpeed * kStep;
  EXPECT_LT(onset.errors(0.099 * way, kSpeed, kStep)[a], 0.05 * expected());
  EXPECT_EQ(onset.errors(0.2 * way, kSpeed, kStep)[a], 0.0);
  EXPECT_EQ(onset.errors(-0.2 * way, kSpeed, kStep)[a], 0.0);
  EXPECT_EQ(onset.errors(0.0, -kSpeed, kStep)[a], 0.0);
}

/// Linear laws are smooth in contact, and `arctan` is smooth everywhere.
TEST(ContactOnset, IsNotLookedForWhereLawsAreSmooth) {
  EXPECT_FALSE(Onset("type = \"stop\"\nlaw = \"linear\"\nnodes = \"a\"\n").onset.any());
  EXPECT_FALSE(Onset("type = \"stop\"\nlaw = \"arctan\"\nregularization = 1e4\nnodes = \"a\"\n").onset.any());
}

}  // namespace
}  // namespace butee::test::contact_onset_test
