#include <cmath>

#include <gtest/gtest.h>

#include "contact/arctan.hpp"
#include "unit/scenes.hpp"

namespace butee::test::contact_test {
namespace {

/// Rounding of a few operations on numbers of similar size.
constexpr double kRounding = 1e-14;
/// Fourth-order differences with a step adapted to the boundary layer of the law.
constexpr double kDifference = 1e-8;

constexpr double kStiffness = 1e6, kGap = 0.01, kLambda = 1e4;

std::string stop(const std::string& keys, const std::string& law) {
  const std::string lambda = law == "arctan" ? "\nregularization = 1.0e4" : "";
  return "\n[[contact]]\ntype = \"stop\"\nlaw = \"" + law + "\"\nstiffness = 1.0e6" + lambda + "\n" + keys + "\n";
}

/// One mass with one stop; displacement and force of the stop are scalars.
class OneStop {
 public:
  OneStop(const std::string& law, const std::string& keys)
      : scene_(kHeader + mass("ball", "2.0") + stop("nodes = \"ball\"\n" + keys, law)) {}

  double force(double w) {
    Vector f(1);
    stops().force(Vector::Constant(1, w), f);
    return f[0];
  }
  double energy(double w) { return stops().energy(Vector::Constant(1, w)); }
  dynamics::ElasticStops& stops() { return scene_.dynamics().stops(); }

 private:
  SceneRun scene_;
};

TEST(Contact, LinearStopActsOnTheSidesItHas) {
  OneStop both("linear", "gap = 0.01"), positive("linear", "gap = 0.01\nsides = \"positive\""),
      negative("linear", "gap = 0.01\nsides = \"negative\"");
  const double deep = kStiffness * (0.03 - kGap);
  EXPECT_NEAR(both.force(0.03), -deep, kRounding * deep);
  EXPECT_NEAR(both.force(-0.03), deep, kRounding * deep);
  EXPECT_NEAR(positive.force(0.03), -deep, kRounding * deep);
  EXPECT_EQ(positive.force(-0.03), 0.0);
  EXPECT_EQ(negative.force(0.03), 0.0);
  EXPECT_NEAR(negative.force(-0.03), deep, kRounding * deep);
  for (OneStop* open : {&both, &positive, &negative})
    for (const double w : {-0.00999, 0.0, 0.00999}) EXPECT_EQ(open->force(w), 0.0);
}

TEST(Contact, ArctanStopOnOneSideActsEverywhere) {
  OneStop positive("arctan", "gap = 0.01\nsides = \"positive\""),
      negative("arctan", "gap = 0.01\nsides = \"negative\"");
  const contact::Arctan law(kStiffness, kLambda);
  for (const double w : {-0.05, -0.01, -1e-4, 0.0, 1e-4, 0.01, 0.05}) {
    const double expected = -law.secant(w - kGap) * (w - kGap);
    EXPECT_DOUBLE_EQ(positive.force(w), expected) << w;
    EXPECT_DOUBLE_EQ(negative.force(-w), -expected) << w;
  }
}

/// With stops on both sides the nearer one acts, with a residual force towards it if it is an open arctan
/// stop; at w = 0 neither acts.
TEST(Contact, ArctanStopOnBothSidesHasNoForceAtZero) {
  OneStop both("arctan", "gap = 0.01");
  const contact::Arctan law(kStiffness, kLambda);
  const double pull = law.secant(-kGap) * kGap;
  ASSERT_GT(pull, 0.0);
  EXPECT_EQ(both.force(0.0), 0.0);
  EXPECT_NEAR(both.force(1e-12), pull, 1e-6 * pull);  // 1e-12 m is 1e-10 of the gap
  EXPECT_NEAR(both.force(-1e-12), -pull, 1e-6 * pull);
  EXPECT_LE(pull, law.asymptotic_force());
}

TEST(Contact, ZeroGapIsASpring) {
  OneStop both("linear", "gap = 0.0");
  for (const double w : {-0.2, -1e-9, 0.0, 1e-9, 0.2}) EXPECT_DOUBLE_EQ(both.force(w), -kStiffness * w);
}

class ContactDerivative : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(ContactDerivative, TangentSecantAndEnergyFitTheForce) {
  const auto [law, sides] = GetParam();
  OneStop one(law, std::string("gap = 0.01\nsides = \"") + sides + "\"");
  const auto slope = [](const auto& f, double w) {
    constexpr double h = 1e-8;  // 1/30 of 1/(pi lambda); the boundary layer is 1e-6 wide
    return (8 * (f(w + h) - f(w - h)) - (f(w + 2 * h) - f(w - 2 * h))) / (12 * h);
  };
  for (const double w : {-0.03, -0.01001, -0.00999, -0.004, 0.004, 0.00997, 0.01003, 0.02}) {
    Vector at = Vector::Constant(1, w), f(1), k(1), c(1);
    one.stops().tangent(at, f, k);
    EXPECT_DOUBLE_EQ(f[0], one.force(w));
    EXPECT_NEAR(k[0], -slope([&](double y) { return one.force(y); }, w), kDifference * kStiffness) << w;
    EXPECT_NEAR(f[0], -slope([&](double y) { return one.energy(y); }, w), kDifference * kStiffness * kGap) << w;
    one.stops().secant(at, k, c);
    EXPECT_NEAR(-k[0] * w + c[0], f[0], kRounding * (k[0] * std::abs(w) + std::abs(c[0]))) << w;
    EXPECT_GE(k[0], 0.0);
  }
  EXPECT_EQ(one.energy(0.0), 0.0);
}

INSTANTIATE_TEST_SUITE_P(laws_and_sides, ContactDerivative,
                         testing::Combine(testing::Values("linear", "arctan"),
                                          testing::Values("both", "positive", "negative")));

TEST(Contact, StopBetweenTwoNodesActsOnBothWithOppositeForces) {
  SceneRun scene(kHeader + mass("rotor", "2.0") + mass("casing", "9.0") +
                 stop("between = [\"rotor\", \"casing\"]\ngap = 0.01", "linear"));
  ASSERT_EQ(scene.dynamics().stop_count(), 1);
  const Index rotor = scene.dof("rotor"), casing = scene.dof("casing");
  Vector x(2), force = Vector::Zero(2);
  x[rotor] = 0.05;
  x[casing] = 0.02;
  scene.dynamics().add_contact_force(x, force);
  const double expected = kStiffness * (0.05 - 0.02 - kGap);
  EXPECT_NEAR(force[rotor], -expected, kRounding * expected);
  EXPECT_EQ(force[casing], -force[rotor]);

  Vector w(1), g(1);
  scene.dynamics().stops().displacement(x, w);
  scene.dynamics().stops().penetration(w, g);
  EXPECT_DOUBLE_EQ(w[0], 0.03);
  EXPECT_NEAR(g[0], 0.02, kRounding);
  EXPECT_EQ(scene.dynamics().stops().dof_a(0), rotor);
  EXPECT_EQ(scene.dynamics().stops().dof_b(0), casing);
}

TEST(Contact, StopsOnOneNodeAddUp) {
  SceneRun scene(kHeader + mass("ball", "2.0") + stop("nodes = \"ball\"\ngap = 0.01", "linear") +
                 stop("nodes = \"ball\"\ngap = 0.03\nsides = \"positive\"", "linear"));
  Vector force = Vector::Zero(1);
  scene.dynamics().add_contact_force(Vector::Constant(1, 0.04), force);
  EXPECT_NEAR(force[0], -kStiffness * (0.03 + 0.01), kRounding * kStiffness);
  EXPECT_EQ(scene.dynamics().stops().play_of(1).gap, 0.03);
  EXPECT_EQ(scene.dynamics().stops().play_of(1).sides, model::Sides::positive);
}

TEST(Contact, StopsOnSupportsAreSkippedAndNeverEvaluated) {
  SceneRun scene(kHeader + kSteelBar + beam("string", "length = 4.0\nelements = 4") +
                 support(R"(["string:first", "string:last"])", R"(["u"])") +
                 stop("nodes = \"string:all\"\ngap = 0.01", "arctan"));
  EXPECT_EQ(scene.system().skipped_stops, 2);
  ASSERT_EQ(scene.dynamics().stop_count(), 3);
  Vector force = Vector::Zero(scene.system().size());
  scene.dynamics().add_contact_force(Vector::Constant(scene.system().size(), 0.02), force);
  const linalg::Counters& counters = scene.dynamics().counters();
  EXPECT_EQ(counters.contact_evaluations, 1);
  EXPECT_EQ(counters.law_evaluations, 3);
  scene.dynamics().stops().force_of(1, 0.02);
  EXPECT_EQ(counters.contact_evaluations, 1);
  EXPECT_EQ(counters.law_evaluations, 4);
}

TEST(Contact, StopAgainstASupportIsAStopToGround) {
  SceneRun scene(kHeader + kSteelBar + beam("wall", "length = 1.0\nelements = 1") + mass("ball", "2.0") +
                 support("\"wall:first\"", R"(["u"])") +
                 stop("between = [\"wall:first\", \"ball\"]\ngap = 0.01", "linear"));
  ASSERT_EQ(scene.dynamics().stop_count(), 1);
  Vector x = Vector::Zero(scene.system().size()), force = x;
  x[scene.dof("ball")] = 0.03;
  scene.dynamics().add_contact_force(x, force);
  EXPECT_NEAR(force[scene.dof("ball")], -kStiffness * 0.02, kRounding * kStiffness);
  EXPECT_DOUBLE_EQ(force.lpNorm<1>(), std::abs(force[scene.dof("ball")]));
}

}  // namespace
}  // namespace butee::test::contact_test
