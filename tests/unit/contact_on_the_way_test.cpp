#include "integrators/contact_on_the_way.hpp"

#include <cmath>
#include <numbers>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::contact_on_the_way_test {
namespace {

std::string mass_at_a_stop(const std::string& sides, const std::string& integrator, const std::string& more = "") {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
         "\"m\"\nstiffness = 1.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.9\nlaw = \"linear\"\nstiffness "
         "= "
         "1e6\nsides = \"" +
         sides + "\"\n" + more + "[integrator]\nend_time = 3.0\n" + integrator;
}

/// States of the free motion x = sin t, which exceeds 0.9 from t = 1.12 to 2.02.
time::State at(double t) {
  return {t, Vector::Constant(1, std::sin(t)), Vector::Constant(1, std::cos(t)), Vector::Constant(1, -std::sin(t)), {},
          {}};
}

/// The largest velocity of that motion, m/s.
const Vector kSpeed = Vector::Constant(1, 1.0);

TEST(ContactOnTheWay, IsOneThatBothEndsOfAStepAreFreeOf) {
  // The stop is so soft that its impulse is negligible.
  SceneRun run(mass_at_a_stop("both", "type = \"exact\"\ntime_step = 1.0\n"), {"contact[0].stiffness=1e-9"});
  const auto happened = [&](double from, double to, double tolerance) {
    integrators::ContactOnTheWay contact(run.dynamics(), tolerance);
    return contact.was_missed(at(from), at(to), to - from, kSpeed);
  };
  EXPECT_TRUE(happened(1.0, 2.1, 1e-3));
  EXPECT_TRUE(happened(1.0, 2.1, 0.1));    // sin reaches 1, a penetration of 0.1
  EXPECT_FALSE(happened(1.0, 2.1, 0.13));  // 0.1/0.9 is smaller
  EXPECT_TRUE(happened(0.2, 2.9, 0.08));   // the cubic alone stays below the gap; its error is 0.11
  EXPECT_FALSE(happened(0.2, 2.9, 0.12));
  EXPECT_FALSE(happened(0.2, 0.9, 1e-6));  // no turning point
  EXPECT_FALSE(happened(0.2, 1.3, 1e-6));  // the step ends in the stop, which every method detects
  EXPECT_TRUE(happened(1.0 + 3.141592653589793, 2.1 + 3.141592653589793, 1e-3));
  // A step from the border itself into the stop and out of it.
  SceneRun border(mass_at_a_stop("both", "type = \"exact\"\ntime_step = 1.0\n"),
                  {"contact[0].gap=" + to_text(std::sin(1.0))});
  integrators::ContactOnTheWay contact(border.dynamics(), 1e-3);
  EXPECT_TRUE(contact.was_missed(at(1.0), at(2.2), 1.2, kSpeed));
  EXPECT_FALSE(contact.was_missed(at(1.0), at(1.5), 0.5, kSpeed));
}

TEST(ContactOnTheWay, WeighsTheImpulseOfASmallPenetration) {
  // From 1.5 to 1.65 sin exceeds 0.9999 by 1e-4; the impulse is at most k 1e-4 m 0.15 s.
  const auto is_missed = [&](const char* stiffness) {
    SceneRun run(mass_at_a_stop("both", "type = \"exact\"\ntime_step = 1.0\n"),
                 {std::string("contact[0].stiffness=") + stiffness, "contact[0].gap=0.9999"});
    integrators::ContactOnTheWay contact(run.dynamics(), 1e-3);
    return contact.was_missed(at(1.5), at(1.65), 0.15, kSpeed);
  };
  EXPECT_FALSE(is_missed("5.0"));
  EXPECT_TRUE(is_missed("20.0"));
}

TEST(ContactOnTheWay, IsALossOfContactThatBothEndsOfAStepAreFreeOf) {
  // A stop on the negative side of 0 is open while x = sin t - 0.9 is positive.
  const auto is_missed = [](const char* stiffness, double from, double to) {
    SceneRun run(mass_at_a_stop("negative", "type = \"exact\"\ntime_step = 1.0\n"),
                 {std::string("contact[0].stiffness=") + stiffness, "contact[0].gap=0.0"});
    integrators::ContactOnTheWay contact(run.dynamics(), 1e-3);
    const auto lowered = [](double t) {
      time::State state = at(t);
      state.x.array() -= 0.9;
      return state;
    };
    return contact.was_missed(lowered(from), lowered(to), to - from, kSpeed);
  };
  // By 0.1 m at most, in a step of 1.1 s.
  EXPECT_TRUE(is_missed("1e-2", 1.0, 2.1));
  EXPECT_FALSE(is_missed("1e-4", 1.0, 2.1));
  EXPECT_FALSE(is_missed("1e-2", 1.0 + std::numbers::pi, 2.1 + std::numbers::pi));
  EXPECT_FALSE(is_missed("1e-2", 1.2, 1.9));
}

bool changed(integrators::ContactOnTheWay& contact, double from, double to) {
  return contact.changed(at(from), at(to), to - from, kSpeed);
}

TEST(ContactOnTheWay, HasChangedWhereOneEndAloneIsInTheStop) {
  constexpr double kTurn = 3.141592653589793;
  for (const auto& [sides, above, below] :
       {std::tuple{"both", true, true}, std::tuple{"positive", true, false}, std::tuple{"negative", false, true}}) {
    SceneRun run(mass_at_a_stop(sides, "type = \"exact\"\ntime_step = 1.0\n"));
    integrators::ContactOnTheWay contact(run.dynamics(), 1e-3);
    EXPECT_FALSE(changed(contact, 0.2, 1.0)) << sides;
    EXPECT_FALSE(changed(contact, 1.3, 1.8)) << sides;
    EXPECT_EQ(changed(contact, 1.0, 1.3), above) << sides;
    EXPECT_EQ(changed(contact, 1.8, 2.1), above) << sides;
    EXPECT_EQ(changed(contact, kTurn + 1.0, kTurn + 1.3), below) << sides;
    // From the stop on one side to the stop on the other.
    EXPECT_TRUE(changed(contact, 1.5, kTurn + 1.5)) << sides;
  }
}

/// A residual force of 1e6/(pi^2 1e7) N to either side changes the velocity by 2e-3 m/s within 0.1 s.
TEST(ContactOnTheWay, HasChangedWhereABluntLawJumpsAtTheMiddle) {
  const std::string blunt = "contact[0].law=\"arctan\"", exact = "type = \"rk4\"\ntime_step = 1e-3\n";
  for (const auto& [sides, lambda, tolerance, expected] :
       {std::tuple{"both", "3.0", 1e-3, true}, std::tuple{"both", "1e7", 0.05, false},
        std::tuple{"both", "1e7", 1e-3, true}, std::tuple{"positive", "3.0", 1e-3, false}}) {
    SceneRun run(mass_at_a_stop(sides, exact), {blunt, std::string("contact[0].regularization=") + lambda});
    integrators::ContactOnTheWay contact(run.dynamics(), tolerance);
    EXPECT_EQ(changed(contact, 3.1, 3.2), expected) << sides << " " << lambda << " " << tolerance;
    EXPECT_FALSE(changed(contact, 3.2, 3.3)) << sides << " " << lambda << " " << tolerance;
  }
}

/// At x = 0.85 m both ends are open; a stage at 0.95 m met the stop of 100 N/m at 0.9 m, whose force then varies by
/// 100 N/m times the speed.
TEST(ContactOnTheWay, IsOneThatAStageMeets) {
  SceneRun run(mass_at_a_stop("both", "type = \"exact\"\ntime_step = 1.0\n"), {"contact[0].stiffness=100.0"});
  integrators::ContactOnTheWay contact(run.dynamics(), 1e-3);
  const time::State from = at(0.9), to = at(0.95);
  const auto changed = [&] { return contact.changed(from, to, 0.05, kSpeed); };
  contact.begin(from);
  contact.look(Vector::Constant(1, 0.85));
  EXPECT_FALSE(changed());
  EXPECT_EQ(contact.kink(from, to, kSpeed), 0.0);
  contact.look(Vector::Constant(1, 0.95));
  EXPECT_TRUE(changed());
  EXPECT_NEAR(contact.kink(from, to, kSpeed), 100.0 * from.v[0], 1e-9);
  contact.begin(from);
  EXPECT_FALSE(changed());
}

/// A motion of constant acceleration turns 1e-7 m on either side of the middle of the gap, where a blunt law jumps.
TEST(ContactOnTheWay, WasMissedWhereAMotionTurnsJustBeyondTheMiddle) {
  SceneRun run(mass_at_a_stop("both", "type = \"rk4\"\ntime_step = 1e-3\n"),
               {"contact[0].law=\"arctan\"", "contact[0].regularization=3.0"});
  integrators::ContactOnTheWay contact(run.dynamics(), 1e-3);
  constexpr double kStep = 0.1, kStart = 1.0;
  for (const double sense : {1.0, -1.0})
    for (const double beyond : {1e-7, -1e-7}) {
      const double x = sense * (beyond - 0.25 * kStep * kStart), v = sense * kStart, a = -2.0 * v / kStep;
      const auto state = [&](double t, double speed) {
        return time::State{t, Vector::Constant(1, x), Vector::Constant(1, speed), Vector::Constant(1, a), {}, {}};
      };
      EXPECT_EQ(contact.was_missed(state(0.0, v), state(kStep, -v), kStep, kSpeed), beyond > 0.0) << sense;
    }
}

/// The gap is the displacement at t = 1; a force of 0.1 N is reached 3e-7 m away from there.
TEST(ContactOnTheWay, HasChangedWhereOneEndIsInTheBendOfALaw) {
  SceneRun run(
      mass_at_a_stop("positive", "type = \"rk4\"\ntime_step = 1e-3\n"),
      {"contact[0].law=\"arctan\"", "contact[0].regularization=1e6", "contact[0].gap=" + to_text(std::sin(1.0))});
  integrators::ContactOnTheWay contact(run.dynamics(), 1e-3), careless(run.dynamics(), 10.0);
  EXPECT_TRUE(changed(contact, 0.5, 1.0));
  EXPECT_FALSE(changed(careless, 0.5, 1.0));
  EXPECT_FALSE(changed(contact, 0.5, 0.9));
  EXPECT_FALSE(changed(contact, 1.0 - 1e-6, 1.0));  // a step that resolves the bend
}

/// The motion turns at 1 m, and is 0.01 m before it at both ends of the step.
TEST(ContactOnTheWay, HasChangedWhereAMotionTurnsInTheBendOfALaw) {
  const auto run = [](double gap) {
    return SceneRun(mass_at_a_stop("positive", "type = \"rk4\"\ntime_step = 1e-3\n"),
                    {"contact[0].law=\"arctan\"", "contact[0].regularization=1e4", "contact[0].gap=" + to_text(gap)});
  };
  const double turn = 0.5 * std::numbers::pi, force = 1e6 / (std::numbers::pi * std::numbers::pi * 1e4);
  for (const auto& [gap, expected] : {std::pair{1.00001, true}, std::pair{1.1, false}}) {
    SceneRun scene = run(gap);
    integrators::ContactOnTheWay contact(scene.dynamics(), 1e-3);
    EXPECT_EQ(changed(contact, turn - 0.14, turn + 0.14), expected);
    EXPECT_FALSE(changed(contact, turn - 0.005, turn + 0.005));
    EXPECT_NEAR(contact.jump(at(turn - 0.14), at(turn + 0.14), 0.28, kSpeed), expected ? force : 0.0, 1e-9 * force);
  }
}

/// A step that ends 20 transition widths before the border: its force is 8e-4 below the residual force there.
TEST(ContactOnTheWay, HasChangedOnTheWayToTheBendOfALaw) {
  constexpr double kStiffness = 1e6, kLambda = 1e4, kWidths = 20.0, pi = std::numbers::pi;
  const double distance = kWidths / (pi * kLambda), residual = kStiffness / (pi * pi * kLambda);
  const double deviation = residual - kStiffness * distance * (0.5 - std::atan(kWidths) / pi);
  SceneRun run(mass_at_a_stop("positive", "type = \"rk4\"\ntime_step = 1e-3\n"),
               {"contact[0].law=\"arctan\"", "contact[0].regularization=" + to_text(kLambda),
                "contact[0].gap=" + to_text(std::sin(1.0) + distance)});
  integrators::ContactOnTheWay contact(run.dynamics(), 1e-3), careless(run.dynamics(), 1.0);
  EXPECT_TRUE(changed(contact, 0.5, 1.0));
  EXPECT_TRUE(changed(contact, pi - 1.0, pi - 0.5));
  EXPECT_NEAR(contact.jump(at(0.5), at(1.0), 0.5, kSpeed), deviation, 1e-6 * deviation);
  EXPECT_FALSE(changed(careless, 0.5, 1.0));
  // From 3.9 times the distance on, the step resolves the force.
  EXPECT_FALSE(changed(contact, std::asin(std::sin(1.0) - 2.9 * distance), 1.0));
}

/// Steps that begin 0.1 transition widths from the border: one of 0.25 of its distance to the poles resolves the bend,
/// one of 0.35 does not.
TEST(ContactOnTheWay, IsFastAtABendNearTheLengthOfTheDistanceToItsPoles) {
  constexpr double kLambda = 1e4, kNear = 0.1, kWidth = 1.0 / (std::numbers::pi * kLambda);
  const double begin = std::sin(1.0), distance = kWidth * std::hypot(1.0, kNear);
  SceneRun run(mass_at_a_stop("positive", "type = \"rk4\"\ntime_step = 1e-3\n"),
               {"contact[0].law=\"arctan\"", "contact[0].regularization=" + to_text(kLambda),
                "contact[0].gap=" + to_text(begin + kNear * kWidth)});
  integrators::ContactOnTheWay contact(run.dynamics(), 1e-9), careless(run.dynamics(), 1e9);
  const auto before = [&](double part) { return std::asin(begin - part * distance); };
  EXPECT_FALSE(changed(contact, before(0.25), 1.0));
  EXPECT_FALSE(contact.is_fast_at_bend());
  EXPECT_FALSE(changed(contact, before(0.35), 1.0));
  EXPECT_TRUE(contact.is_fast_at_bend());
  EXPECT_FALSE(changed(contact, before(0.25), 1.0));
  EXPECT_FALSE(contact.is_fast_at_bend());
  EXPECT_FALSE(changed(careless, before(0.35), 1.0));
  EXPECT_FALSE(careless.is_fast_at_bend());
}

TEST(ContactOnTheWay, KnowsOneSidedStops) {
  for (const auto& [sides, above, below] : {std::tuple{"positive", true, false}, std::tuple{"negative", false, true}}) {
    SceneRun run(mass_at_a_stop(sides, "type = \"exact\"\ntime_step = 1.0\n"));
    integrators::ContactOnTheWay contact(run.dynamics(), 1e-3);
    EXPECT_EQ(contact.was_missed(at(1.0), at(2.1), 1.1, kSpeed), above) << sides;
    EXPECT_EQ(contact.was_missed(at(4.1), at(5.2), 1.1, kSpeed), below) << sides;
  }
}

class ShortEvents : public testing::TestWithParam<std::string> {};

std::string method(const std::string& name, double tolerance) {
  return "type = \"" + name + "\"\ntolerance = " + to_text(tolerance) + "\n";
}

/// A mass at rest receives 2 N s within a thousandth of a second, much shorter than a step.
TEST_P(ShortEvents, APulseIsNotPassedOver) {
  const std::string pulse =
      "[[load]]\ntype = \"table\"\nnode = \"m\"\ntimes = [0.0, 1.0, 1.0005, 1.001]\nvalues = [0.0, 0.0, 4000.0, 0.0]\n"
      "[initial]\nvelocity = [{nodes = \"m\", value = 1e-6}]\n";
  SceneRun run(mass_at_a_stop("both", method(GetParam(), 1e-3), pulse),
               {"contact[0].gap=1e3", "integrator.end_time=2.0"});
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  // 2 sin(t - 1.0005) from the pulse on; the pulse has a small duration.
  EXPECT_NEAR(run.simulation().state().x[0], 2.0 * std::sin(0.9995), 0.02);
}

/// A grazing impact on a hard stop, at the turning point of a slow motion.
TEST_P(ShortEvents, AnImpactAtATurningPointIsNotPassedOver) {
  const double speed = 0.9 * 1.002;  // 2e-3 beyond the gap, at 6 % of the largest speed
  const std::string start = "[initial]\nvelocity = [{nodes = \"m\", value = " + to_text(speed) + "}]\n";
  SceneRun run(mass_at_a_stop("positive", method(GetParam(), 1e-4), start), {"integrator.end_time=3.0"});
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  SceneRun exact(mass_at_a_stop("positive", "type = \"exact\"\ntime_step = 1e-2\n", start));
  ASSERT_TRUE(exact.run().completed);
  const double free = speed * std::sin(3.0), struck = exact.simulation().state().x[0];
  ASSERT_GT(std::abs(struck - free), 0.05);  // the effect of the impact
  // The impact amplifies earlier errors, here about tenfold.
  EXPECT_NEAR(run.simulation().state().x[0], struck, 5e-3);
}

/// If the law's regularization is small relative to the gap, the residual force is large from the middle of
/// the gap on: the force is discontinuous in the middle of the motion.
TEST_P(ShortEvents, AJumpAtTheMiddleOfTheGapIsNotPassedOver) {
  const std::string start = "[initial]\nvelocity = [{nodes = \"m\", value = 1.0}]\n";
  const std::vector<std::string> blunt = {"contact[0].law=\"arctan\"", "contact[0].regularization=2.0",
                                          "contact[0].stiffness=20.0", "integrator.end_time=10.0"};
  SceneRun exact(mass_at_a_stop("both", "type = \"exact\"\ntime_step = 1e-2\n", start), blunt);
  ASSERT_TRUE(exact.run().completed);
  for (const double tolerance : {1e-3, 1e-5}) {
    SceneRun run(mass_at_a_stop("both", method(GetParam(), tolerance), start), blunt);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_NEAR(run.simulation().state().x[0], exact.simulation().state().x[0], 30.0 * tolerance);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, ShortEvents,
                         testing::Values("exponential", "rodas4", "dopri5", "extrapolation8", "bathe_adaptive",
                                         "generalized_alpha_adaptive", "hht_alpha_adaptive",
                                         "discrete_gradient_adaptive", "central_differences_adaptive", "auto"),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace butee::test::contact_on_the_way_test
