// Coulomb friction compared with closed forms of blocks that slide, stick and hit walls at an angle.
#include <cmath>
#include <numbers>
#include <tuple>

#include <butee/core/error.hpp>
#include <butee/record/contact_recorder.hpp>
#include <butee/record/energy.hpp>
#include <butee/record/probes.hpp>
#include <butee/record/slip_watch.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::friction_test {
namespace {

using std::numbers::pi;

std::string block(double mass, double stiffness, const std::string& friction, double end_time,
                  const std::string& rest) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"block\"\nmass = " + std::to_string(mass) +
         "\n[[element]]\ntype = \"spring\"\nnode = \"block\"\nstiffness = " + std::to_string(stiffness) +
         "\n[[contact]]\ntype = \"friction\"\nnodes = \"block\"\nnormal_force = 10.0\nfriction = { " + friction +
         " }\n[integrator]\ntype = \"dopri5\"\ntolerance = 1e-9\nend_time = " + std::to_string(end_time) + "\n" + rest;
}

/// Turning points of x among the ends of steps, where slip reverses.
class Turns final : public time::Observer {
 public:
  void step(const time::AcceptedStep& step) override {
    const double x = step.to.x[0];
    if (std::abs(x - last_) < 1e-12) return;  // at rest
    if (count_++ > 1 && (x - last_) * (last_ - before_) < 0.0) at.push_back(last_);
    before_ = last_;
    last_ = x;
  }
  std::vector<double> at;

 private:
  double last_ = 0.0, before_ = 0.0;
  int count_ = 0;
};

/// Values of probes at an instant.
class Sampled final : public time::Observer {
 public:
  Sampled(record::Probes& probes, double t) : values(probes.columns().size()), probes_(probes), t_(t) {}
  void step(const time::AcceptedStep& step) override {
    if (step.from.t < t_ && t_ <= step.to.t) probes_.evaluate(step, t_, values);
  }
  std::vector<double> values;

 private:
  record::Probes& probes_;
  double t_;
};

/// Where the dissipation of a law grows as the root of the penetration, or as its fourth root, the limit of friction
/// grows infinitely fast at the onset: the contact sticks from its first instant, whatever rounding decides there, and
/// the body vibrates along the plane on the stick spring alone.
TEST(StickSpring, HoldsFromTheOnsetOfADissipativeContact) {
  constexpr double kSpring = 3000.0, kStick = 2e5, kGap = 1e-3, kEnd = 3e-3;
  for (const std::string law :
       {"law = \"viscoelastic\"\nstiffness = 1.3e7\nrelaxation = 1.1e-4\n",
        "law = \"hertz\"\nstiffness = 2.9e7\ndamping = { type = \"jankowski\", restitution = 0.6, "
        "mass = 1.0 }\n"})
    for (const char* method : {"dopri5", "exponential", "extrapolation8"})
      for (const double along : {0.21, 0.23, 0.25, 0.27, 0.29}) {
        constexpr double kAcross = 0.8;
        SceneRun run(
            "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\n"
            "node = \"m\"\ndof = \"uz\"\nstiffness = " +
                std::to_string(kSpring) +
                "\n[[contact]]\ntype = \"plane\"\nnodes = \"m\"\nnormal = [0.0, 1.0]\ngap = " + std::to_string(kGap) +
                "\n" + law + "friction = { coefficient = 0.3, static_coefficient = 1.5, stick_stiffness = " +
                std::to_string(kStick) + " }\n[initial]\nvelocity = [{ nodes = \"m\", dof = \"uy\", value = " +
                std::to_string(along) + " }, { nodes = \"m\", dof = \"uz\", value = " + std::to_string(kAcross) +
                " }]\n[integrator]\nend_time = " + std::to_string(kEnd) + "\n",
            {std::string("integrator.type=") + method, "integrator.tolerance=1e-7"});
        ASSERT_TRUE(run.run().completed);
        const double rate = std::sqrt(kSpring), onset = std::asin(kGap * rate / kAcross) / rate,
                     expected = along * std::cos(std::sqrt(kStick) * (kEnd - onset));
        EXPECT_NEAR(run.simulation().state().v[run.dof("m", DofKind::uy)], expected, 1e-5) << law << method << along;
      }
}

class FrictionMethods : public testing::TestWithParam<const char*> {};

constexpr const char* kSliding = "[initial]\ndisplacement = [{ nodes = \"block\", value = 0.85e-3 }]\n";

/// SDND100: turning points 0.85 - 0.2 n mm; the block stops for good at the fourth, and each reversal reduces
/// the amplitude by 0.2 mm.
TEST_P(FrictionMethods, ASlidingBlockStopsWhereFrictionHoldsIt) {
  SceneRun run(block(1.0, 1e4, "coefficient = 0.1, stick = \"rigid\"", 0.2, kSliding), {GetParam()});
  Sampler sampler(0, {pi / 100, 2 * pi / 100, 3 * pi / 100, 4 * pi / 100, 0.2});
  record::EnergyRecorder energy(run.dynamics());
  run.simulation().add(sampler);
  run.simulation().add(energy);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  const std::vector<double> wanted = {-0.65e-3, 0.45e-3, -0.25e-3, 0.05e-3, 0.05e-3};
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(sampler.x[i], wanted[i], 1e-9 * 0.85e-3) << i;
  EXPECT_NEAR(energy.dissipated(), 3.6e-3, 1e-8 * 3.6e-3);
  EXPECT_NEAR(energy.balance_error(), 0.0, 1e-8);
}

/// F3: the stick-slip oscillator on a belt, period 2 D/v + (2/w)(pi - atan(D w/v)) with D = (mu_s - mu_d) N/k.
TEST_P(FrictionMethods, ABlockOnABeltSticksAndSlipsWithItsPeriod) {
  const std::string friction = "coefficient = 0.3, static_coefficient = 0.4, stick = \"rigid\", surface_speed = 0.1";
  const double w = 10.0, d = 0.01, v = 0.1, slip = 2 / w * (pi - std::atan(d * w / v)), period = 2 * d / v + slip;
  EXPECT_NEAR(period, 0.6712388980, 1e-10);
  SceneRun run(block(1.0, 100.0, friction, 3.5, "[initial]\nvelocity = [{ nodes = \"block\", value = 0.1 }]\n"),
               {GetParam(), "integrator.tolerance=1e-10"});
  // First slip at 0.4 s; the block sticks again after each slip; midway through sticking x is the mean of its
  // end values.
  std::vector<double> times;
  for (int i = 0; i < 4; ++i) times.push_back(0.4 + slip + i * period + 0.1);
  Sampler sampler(0, times);
  run.simulation().add(sampler);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  for (const double x : sampler.x) EXPECT_NEAR(x, 0.02 + 0.1 * 0.1, 1e-9 * 0.03);
  for (const double speed : sampler.v) EXPECT_NEAR(speed, 0.1, 1e-10);
}

/// F2 (SDND104): mean of N |v| over 4 ... 12 s of a block on a shaking floor, which is the friction power
/// over mu.
TEST_P(FrictionMethods, AShakenBlockHasTheWearPowerOfTheEventSolution) {
  for (const auto& [amplitude, power] :
       {std::pair(15.0, 15.267099589), {1.5, 0.40906245102}, {1.01, 2.261641213e-4}, {0.99, 0.0}}) {
    const std::string toml =
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"block\"\nmass = 1.0\n[[contact]]\ntype = \"friction\"\n"
        "nodes = \"block\"\nnormal_force = 10.0\nfriction = { coefficient = 0.1, stick = \"rigid\" }\n"
        "[[load]]\ntype = \"harmonic\"\nnode = \"block\"\namplitude = " +
        std::to_string(-amplitude) +
        "\nangular_frequency = 6.283185307179586\nphase = -1.5707963267948966\n[integrator]\ntype = \"dopri5\"\n"
        "tolerance = 1e-10\nend_time = 12.0\n";
    SceneRun run(toml, {GetParam()});
    record::ContactRecorder recorder(run.dynamics());
    double before = 0.0;
    run.simulation().add(recorder);
    run.simulation().set_end_time(4.0);
    run.run();
    before = recorder.wear()[0].work;
    run.simulation().set_end_time(12.0);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_NEAR((recorder.wear()[0].work - before) / 8.0, power, 1e-9 * power + 1e-12) << amplitude;
  }
}

/// F4: Den Hartog's amplitude of forced motion without stops, f = 0.3.
TEST_P(FrictionMethods, ForcedMotionHasDenHartogsAmplitude) {
  // At r = 0.5 the mean of the motion approaches 0 only as 1/t, with rests at the lower turning points. Half
  // the downward path has reached 4/3 to 1e-7 by then, and does not depend on friction.
  for (const auto& [ratio, amplitude, tolerance] : {std::tuple(0.7, 1.8856998504, 1e-7),
                                                    {1.3, 1.3153481967, 1e-7},
                                                    {1.6, 0.5763418178, 1e-7},
                                                    {2.0, 0.2976761850, 1e-7},
                                                    {0.5, 4.0 / 3.0, 1e-6}}) {
    const std::string toml =
        block(1.0, 1.0, "coefficient = 0.03, stick = \"rigid\"", 60 * 2 * pi / ratio,
              "[[load]]\ntype = \"harmonic\"\nnode = \"block\"\namplitude = 1.0\nangular_frequency = " +
                  std::to_string(ratio) + "\nphase = 1.5707963267948966\n");
    SceneRun run(toml, {GetParam()});
    Turns turns;
    run.simulation().add(turns);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    ASSERT_GT(turns.at.size(), 80U);
    // Path from the last upper turning point to the following lower one.
    if (turns.at.back() > 0.0) turns.at.pop_back();
    const double way = *std::prev(turns.at.end(), 2) - turns.at.back();
    EXPECT_NEAR(0.5 * way, amplitude, tolerance * amplitude) << ratio;
  }
}

INSTANTIATE_TEST_SUITE_P(Exact, FrictionMethods,
                         testing::Values("integrator.type=dopri5", "integrator.type=extrapolation8",
                                         "integrator.type=exact"));

/// F1 with regularised friction: the published bias of the turning points, of second order in slip_speed for
/// tanh.
TEST(RegularisedFriction, HasTheBiasOfItsSmoothing) {
  for (const auto& [smoothing, bias] : {std::pair("tanh", 6.0e-4), {"clip", 2.6e-4}}) {
    SceneRun run(block(1.0, 1e4, "coefficient = 0.1, slip_speed = 1e-3, smoothing = \"" + std::string(smoothing) + "\"",
                       0.13, kSliding));
    Turns turns;
    run.simulation().add(turns);
    ASSERT_TRUE(run.run().completed);
    ASSERT_GE(turns.at.size(), 3U);
    EXPECT_NEAR((turns.at[2] + 0.25e-3) / 0.85e-3, smoothing == std::string("tanh") ? -1.3e-4 : -5.3e-5, 1e-5) << bias;
  }
}

/// The slip speed decreases through the range in which tanh equals 1 to rounding, where its series does not
/// show the sign change.
TEST(RegularisedFriction, IsTheSameByItsSeriesAndByExtrapolation) {
  const std::string scene =
      block(1.0, 1e4, "coefficient = 0.1, slip_speed = 1e-4, smoothing = \"tanh\"", 0.2, kSliding);
  SceneRun series(scene, {"integrator.type=exact", "integrator.tolerance="}),
      other(scene, {"integrator.type=extrapolation8", "integrator.tolerance=1e-12"});
  ASSERT_TRUE(series.run().completed);
  ASSERT_TRUE(other.run().completed);
  EXPECT_NEAR(series.simulation().state().x[0], other.simulation().state().x[0], 1e-10 * 0.85e-3);
  EXPECT_NEAR(series.simulation().state().v[0], other.simulation().state().v[0], 1e-10 * 0.085);
}

/// Contact status and anchors are part of a snapshot: a run resumed elsewhere ends with the same bits.
TEST(StickSpring, RemembersAcrossARestart) {
  const std::string toml =
      block(1.0, 100.0, "coefficient = 0.3, static_coefficient = 0.4, stick_stiffness = 1e4, surface_speed = 0.1", 3.0,
            "[initial]\nvelocity = [{ nodes = \"block\", value = 0.1 }]\n");
  for (const char* method : {"integrator.type=rodas4", "integrator.type=dopri5"}) {
    SceneRun whole(toml, {method, "integrator.tolerance=1e-5"}), rest(toml, {method, "integrator.tolerance=1e-5"});
    while (whole.simulation().state().t < 1.0) whole.simulation().advance();
    rest.simulation().restore(whole.simulation().snapshot());
    ASSERT_TRUE(whole.run().completed && rest.run().completed);
    EXPECT_EQ(whole.simulation().state().x[0], rest.simulation().state().x[0]) << method;
    EXPECT_EQ(whole.simulation().state().v[0], rest.simulation().state().v[0]) << method;
    EXPECT_EQ(whole.simulation().report().steps, rest.simulation().report().steps) << method;
  }
}

/// At the instant at which a stick spring with a dashpot takes hold its tension is that of slip, and rounding of the
/// path times its stiffness decides whether it exceeds that. The block stops after v0^2/(2 mu N/m).
TEST(StickSpring, WithADashpotTakesHoldOnce) {
  for (const char* method : {"rodas4", "dopri5", "extrapolation8", "exact"})
    for (const char* tolerance : {"1e-3", "1e-6"})
      for (const char* spring : {"1e6, stick_damping = 100.0", "1e7, stick_damping = 1000.0"}) {
        SceneRun run(block(1.0, 1e-6, std::string("coefficient = 0.3, stick_stiffness = ") + spring, 1.0,
                           "[initial]\nvelocity = [{ nodes = \"block\", value = 2.0 }]\n"),
                     {std::string("integrator.type=") + method, std::string("integrator.tolerance=") + tolerance});
        int steps = 0;
        while (run.simulation().advance() && ++steps < 20000) {
        }
        EXPECT_LT(steps, 20000) << method << " " << tolerance << " " << spring;
        // The spring holds the block within mu N/k of where it would stop.
        EXPECT_NEAR(run.simulation().state().x[0], 2.0 / 3.0, 0.1 * std::stod(tolerance) + 3e-6) << method;
      }
}

/// The same block on a spring: each half oscillation is shorter by 2 mu N/k, and the friction is against the slip also
/// where a strong dashpot beside the stick spring takes hold: both move by up to mu N/k_t only.
TEST(StickSpring, WithAStrongDashpotRubsAgainstTheSlip) {
  for (const char* method : {"exact", "dopri5", "rodas4", "exponential"})
    for (const char* dashpot : {"200.0", "20000.0"}) {
      SceneRun run(block(1.0, 1e4, std::string("coefficient = 0.3, stick_stiffness = 1e8, stick_damping = ") + dashpot,
                         0.16, "[initial]\ndisplacement = [{ nodes = \"block\", value = 5e-3 }]\n"),
                   {std::string("integrator.type=") + method, "integrator.tolerance=1e-6"});
      std::vector<double> turns;
      for (int n = 1; n <= 5; ++n) turns.push_back(n * pi / 100.0);
      Sampler sampler(0, turns);
      record::EnergyRecorder energy(run.dynamics());
      run.simulation().add(sampler);
      run.simulation().add(energy);
      run.simulation().start();
      double before = 0.0;
      while (run.simulation().advance()) {
        EXPECT_GE(energy.dissipated(), before - 1e-7) << method << dashpot;
        before = energy.dissipated();
      }
      ASSERT_TRUE(run.simulation().report().completed) << method;
      for (std::size_t n = 0; n < turns.size(); ++n)
        EXPECT_NEAR(sampler.x[n], (n % 2 == 0 ? -1.0 : 1.0) * (4.4e-3 - 6e-4 * static_cast<double>(n)), 1e-6)
            << method << dashpot;
    }
}

/// Slip that ends within a long step of `exact`, beside a strong dashpot and a load that soon pushes the mass on: the
/// instant at which it could stick is short where the dashpot's force decides.
TEST(StickSpring, SticksWithinALongStepOfTheSeries) {
  const auto end_of = [](const std::string& method) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.6543992849832918\n[[element]]\ntype = "
        "\"spring\"\nnode = \"m\"\nstiffness = 9067.902749257371\n[[contact]]\ntype = \"friction\"\nnodes = "
        "\"m\"\nnormal_force = 219.83262864968103\nfriction = { coefficient = 0.30149873049497294, static_coefficient "
        "= "
        "0.580708491745256, stick_stiffness = 315073.4586563445, stick_damping = 12368.88544377722, surface_speed = "
        "0.02102182538994883 }\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = "
        "394.9007867578812\nangular_frequency = 15.814563736260038\n[integrator]\nend_time = 2.3838224355591944\n",
        {"integrator.type=" + method, "integrator.tolerance=1e-10"});
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    return run.simulation().state().x[0];
  };
  const double wanted = end_of("extrapolation8");
  for (const char* method : {"exact", "dopri5"}) EXPECT_NEAR(end_of(method), wanted, 1e-9) << method;
}

/// The first acceleration, and the friction forces of a start.
class Start final : public time::Observer {
 public:
  explicit Start(dynamics::Dynamics& dynamics) : dynamics_(dynamics) {}
  void start(const time::State& state) override {
    a = state.a[0];
    dynamics_.contact_forces(state.t, state.x, state.v, forces);
  }
  void step(const time::AcceptedStep&) override {}
  double a = 0.0;
  std::vector<dynamics::ContactForces> forces;

 private:
  dynamics::Dynamics& dynamics_;
};

/// A start at rest under more force than friction holds: the block slips from the first instant.
TEST(RigidFriction, HoldsNoMoreThanItCanAtTheStart) {
  for (const auto& [place, friction] : {std::pair(0.5, 3.0), std::pair(-0.5, -3.0), std::pair(0.02, 2.0)}) {
    SceneRun run(block(1.0, 100.0, "coefficient = 0.3, stick = \"rigid\"", 0.01,
                       "[initial]\ndisplacement = [{ nodes = \"block\", value = " + std::to_string(place) + " }]\n"));
    Start start(run.dynamics());
    run.simulation().add(start);
    ASSERT_TRUE(run.run().completed);
    EXPECT_NEAR(start.a, -100.0 * place + friction, 1e-9) << place;
    EXPECT_NEAR(std::abs(start.forces.at(0).friction), std::abs(friction), 1e-9) << place;
  }
}

/// Jenkins element: a spring k_t in series with a slider dissipates 4 mu N (A - mu N/k_t) in a cycle of
/// amplitude A.
TEST(StickSpring, DissipatesWhatJenkinsElementDoes) {
  // A heavy mass on a stiff spring gets a given amplitude by its initial motion; friction hardly reduces it.
  const double stiffness = 1e8, amplitude = 1e-3, limit = 1.0, stick = 5e3;
  const std::string toml = block(1.0, stiffness, "coefficient = 0.1, stick_stiffness = 5e3", 4 * pi / 1e4,
                                 "[initial]\ndisplacement = [{ nodes = \"block\", value = 1e-3 }]\n");
  SceneRun run(toml);
  record::ContactRecorder recorder(run.dynamics());
  run.simulation().add(recorder);
  run.simulation().set_end_time(2 * pi / 1e4);
  run.run();
  const double before = recorder.wear()[0].dissipated;
  run.simulation().set_end_time(4 * pi / 1e4);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  const double cycle = recorder.wear()[0].dissipated - before, wanted = 4 * limit * (amplitude - limit / stick);
  // The amplitude decreases by a relative 4e-5 in a cycle.
  EXPECT_NEAR(cycle, wanted, 1e-4 * wanted);
}

/// A disc of mass m, radius R and I = m R^2/2 rotates with W about x and is pressed against a wall above it.
/// Friction slows its rotation and drives it along the wall until it rolls with the velocity R W/3, for any
/// law and force.
std::string spinning_disc(const std::string& rest, const std::string& friction) {
  return "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"disc\"\nmass = 2.0\ndiametral_inertia = 0.03\n"
         "polar_inertia = 0.04\n[[element]]\ntype = \"spring\"\nnode = \"disc\"\ndof = \"uy\"\nstiffness = 0.0\n"
         "[[element]]\ntype = \"spring\"\nnode = \"disc\"\ndof = \"uz\"\nstiffness = 0.0\n"
         "[[element]]\ntype = \"spring\"\nnode = \"disc\"\ndof = \"rx\"\nstiffness = 0.0\n"
         "[[contact]]\ntype = \"plane\"\nnodes = \"disc\"\nnormal = [0, 1]\ngap = 0.0\nstiffness = 2e3\nradius = 0.2\n"
         "friction = { coefficient = 0.3, " +
         friction +
         " }\n[[load]]\ntype = \"constant\"\nnode = \"disc\"\ndof = \"uz\"\nvalue = 20.0\n"
         "[integrator]\ntype = \"dopri5\"\ntolerance = 1e-10\nend_time = 1.0\n" +
         rest;
}

TEST(SpinningDisc, RollsWithAThirdOfItsSpeed) {
  const double radius = 0.2, speed = 9.0;
  // Pressed with 20 N from the start: 2e3 N/m with a penetration of 0.01 m.
  const std::string pressed = "{ nodes = \"disc\", dof = \"uz\", value = 0.01 }";
  const std::string by_itself = "[initial]\ndisplacement = [" + pressed +
                                "]\nvelocity = [{ nodes = \"disc\", dof = \"rx\", value = 9.0 }]\n",
                    driven = "[rotation]\nspeed = 9.0\n[initial]\ndisplacement = [" + pressed + "]\n";
  for (const std::string& start : {by_itself, driven})
    for (const auto& [method, friction, tolerance] : {std::tuple("dopri5", "stick = \"rigid\"", 1e-9),
                                                      {"extrapolation8", "stick = \"rigid\"", 1e-9},
                                                      {"exact", "stick = \"rigid\"", 1e-9},
                                                      {"rodas4", "slip_speed = 1e-6", 1e-5},
                                                      {"exact", "slip_speed = 1e-6", 1e-5},
                                                      {"rodas4", "slip_speed = 1e-6, smoothing = \"clip\"", 1e-5}}) {
      SceneRun run(spinning_disc(start, friction), {std::string("integrator.type=") + method});
      record::EnergyRecorder energy(run.dynamics());
      run.simulation().add(energy);
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      const auto& state = run.simulation().state();
      const double along = state.v[run.dof("disc", DofKind::uy)], turning = state.v[run.dof("disc", DofKind::rx)];
      // The rotation prescribed by [rotation] is not in rx.
      const double own = start == driven ? speed : 0.0;
      EXPECT_NEAR(along, radius * speed / 3.0, tolerance) << method << " " << friction;
      EXPECT_NEAR(turning + own, speed / 3.0, tolerance / radius) << method << " " << friction;
      EXPECT_NEAR(energy.balance_error(), 0.0, 1e-6) << method << " " << friction;
    }
}

/// F5: an oblique impact with slip throughout: v_n' = -e v_n, v_t' = v_t - mu (1 + e) v_n.
TEST(ObliqueImpact, TakesTheTangentialImpulseOfSlip) {
  const auto after = [](double mu, double slide, const std::string& damping) {
    const std::string toml =
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\n"
        "node = \"ball\"\ndof = \"uz\"\nstiffness = 1e-9\n[[contact]]\ntype = \"plane\"\nnodes = \"ball\"\n"
        "normal = [0, 1]\ngap = 1e-3\nstiffness = 1e6\nfriction = { coefficient = " +
        std::to_string(mu) + ", stick = \"rigid\" }\n" + damping +
        "[initial]\nvelocity = [{ nodes = \"ball\", dof = \"uy\", value = " + std::to_string(slide) +
        " }, { nodes = \"ball\", dof = \"uz\", value = 0.5 }]\n[integrator]\ntype = \"dopri5\"\ntolerance = 1e-10\n"
        "end_time = 0.02\n";
    SceneRun run(toml);
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    const auto& v = run.simulation().state().v;
    return std::pair(v[run.dof("ball", DofKind::uy)], v[run.dof("ball", DofKind::uz)]);
  };
  const std::string damped = "damping = { type = \"kelvin_voigt\", coefficient = 200.0 }\n";  // zeta 0.1
  const auto elastic = after(0.2, 1.0, "");
  EXPECT_NEAR(elastic.first, 0.8, 1e-9);
  EXPECT_NEAR(elastic.second, -0.5, 1e-9);
  const auto lossy = after(0.2, 1.0, damped);
  EXPECT_NEAR(lossy.first, 0.8255920602, 1e-9);
  EXPECT_NEAR(lossy.second, -0.3720396989, 1e-9);
  const auto stuck = after(0.3, 0.2, damped);
  EXPECT_NEAR(stuck.first, 0.0, 1e-9);
}

/// A dashpot with pull = true exerts no normal pressure while it pulls: v_t' = v_t - mu (1 + e) v_n with the
/// restitution e of a contact that ends at F = 0, although this contact ends at g = 0.
TEST(ObliqueImpact, DoesNotRubWhileTheDashpotPulls) {
  for (const char* method : {"dopri5", "extrapolation8", "rodas4", "exact"}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\n"
        "node = \"ball\"\ndof = \"uz\"\nstiffness = 1e-9\n[[contact]]\ntype = \"plane\"\nnodes = \"ball\"\n"
        "normal = [0, 1]\ngap = 1e-3\nstiffness = 1e6\nfriction = { coefficient = 0.2, slip_speed = 1e-3, smoothing = "
        "\"tanh\" }\ndamping = { type = \"kelvin_voigt\", coefficient = 200.0, pull = true }\n"
        "[initial]\nvelocity = [{ nodes = \"ball\", dof = \"uy\", value = 1.0 }, { nodes = \"ball\", dof = \"uz\", "
        "value = 0.5 }]\n[integrator]\ntype = \"dopri5\"\nend_time = 0.02\n",
        {std::string("integrator.type=") + method, "integrator.tolerance=1e-9"});
    ASSERT_TRUE(run.run().completed) << method << run.simulation().report().message;
    const auto& v = run.simulation().state().v;
    EXPECT_NEAR(v[run.dof("ball", DofKind::uy)], 1.0 - 0.2 * (1.0 + 0.7440793977) * 0.5, 2e-9) << method;
    EXPECT_NEAR(v[run.dof("ball", DofKind::uz)], -0.7292476143 * 0.5, 2e-9) << method;
  }
}

/// If the tolerance does not resolve a slip speed, a warning gives suitable values; otherwise there is no
/// warning.
TEST(RegularisedFriction, TellsASlipSpeedThatTheToleranceDoesNotResolve) {
  SceneRun run(block(1.0, 1e4, "coefficient = 0.1, slip_speed = 1e-6", 0.02, kSliding));
  record::SlipWatch watch(run.dynamics());
  run.simulation().add(watch);
  ASSERT_TRUE(run.run().completed);
  // The largest speed is that of an amplitude of 0.75 mm about the balance of spring and friction, 0.075 m/s.
  EXPECT_EQ(watch.complaint(1e-6), "");
  const std::string complaint = watch.complaint(1e-3);
  EXPECT_NE(complaint.find("slip_speed = 1e-06 m/s, but for the tolerance 0.001 the error of the speed there"),
            std::string::npos)
      << complaint;
  EXPECT_NE(complaint.find("Take slip_speed = 7."), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("tolerance = 1.3"), std::string::npos) << complaint;
}

/// Block a, 1.5 kg, on block b, 2.5 kg, on a belt; a sticks to b up to 10.5 N, b slides on the belt with 3 N.
std::string pile(const std::string& belt, const std::string& load) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.5\n[[element]]\ntype = \"mass\"\nname = "
         "\"b\"\nmass = 2.5\n[[contact]]\ntype = \"friction\"\nbetween = [\"a\", \"b\"]\nnormal_force = "
         "30.0\nfriction = { coefficient = 0.2, static_coefficient = 0.35, stick = \"rigid\" }\n[[contact]]\ntype = "
         "\"friction\"\nnodes = \"b\"\nnormal_force = 20.0\nfriction = { coefficient = 0.15, stick = \"rigid\", "
         "surface_speed = " +
         belt + " }\n[[load]]\nnode = \"a\"\n" + load +
         "[integrator]\ntype = \"dopri5\"\ntolerance = 1e-9\nend_time = 0.2\n";
}

/// A contact that closes with slip sticks if the limit grows faster than the spring is stressed: mu_s K (1 + a v_n) v_n
/// against k_t v_t. The instant of closing is known to rounding, which must not decide.
TEST(StickSpring, TakesHoldAtClosingWhateverRoundingSays) {
  constexpr double kAcross = 0.0095, kTowards = 0.0104, kStiffness = 1e4, kFactor = 100.0;
  for (const double gap : {0.77e-3, 1.0e-3, 1.3e-3})
    for (const char* method : {"dopri5", "exponential", "rodas4", "extrapolation8", "exact"}) {
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"bearing\"\n"
          "node = \"a\"\nstiffness = [[10.0, 0.0], [0.0, 10.0]]\n[[contact]]\ntype = \"plane\"\nnodes = \"a\"\n"
          "law = \"linear\"\nstiffness = 1e4\nnormal = [1.0, 0.0]\ndamping = { type = \"hunt_crossley\", factor = "
          "100.0 }\nfriction = { coefficient = 0.4, static_coefficient = 0.5, stick_stiffness = 1e4 }\ngap = " +
              std::to_string(gap) +
              "\n[initial]\nvelocity = [{ nodes = \"a\", dof = \"uy\", value = 0.0104 }, { nodes = \"a\", dof = "
              "\"uz\", value = 0.0095 }]\n[integrator]\ntype = \"dopri5\"\ntolerance = 1e-7\nend_time = 0.14\n",
          {std::string("integrator.type=") + method});
      // Free motion with 10 rad^2/s^2 up to the gap; then friction over normal force, both linear in time at first.
      const double w = std::sqrt(10.0), closing = std::asin(gap * w / kTowards) / w, soon = closing + 1e-5;
      const double v_n = kTowards * std::cos(w * closing), v_t = kAcross * std::cos(w * closing);
      record::Probes probe({{"a",
                             run.model().nodes.select("a").nodes.front(),
                             {model::Quantity::contact_normal, model::Quantity::contact_friction},
                             ""}},
                           run.dynamics());
      Sampled sampled(probe, soon);
      run.simulation().add(sampled);
      ASSERT_TRUE(run.run().completed) << method << run.simulation().report().message;
      const double ratio = kStiffness * v_t / (kStiffness * v_n * (1.0 + kFactor * v_n));
      EXPECT_NEAR(std::abs(sampled.values[1]) / sampled.values[0], ratio, 2e-3 * ratio) << method << " " << gap;
    }
}

/// A free mass closes a soft contact (F = K g^1.2) at speed v with slip s. At first the limit grows more slowly than
/// the spring force k s t, and it slips until t_1, where mu dF/dt = k s; the spring then holds k s (t - t_1/6). The
/// static limit exceeds the spring force much earlier, so that a contact taken for closed at a penetration of rounding
/// would stick at once.
TEST(StickSpring, SlipsFirstAtASoftClosingWhateverRoundingSays) {
  constexpr double kNormalSpeed = 0.1, kSlip = 0.01, kStick = 100.0, kLaw = 660.0, kFriction = 0.2, kLater = 1e-3;
  const double slips = std::pow(kStick * kSlip / (kFriction * kLaw * 1.2 * std::pow(kNormalSpeed, 1.2)), 5.0),
               wanted = kStick * kSlip * (kLater - slips / 6.0);
  for (int i = 0; i < 20; ++i)
    for (const char* method : {"dopri5", "exponential", "rodas4", "extrapolation8"}) {
      const double gap = 5.1e-4 + 4.7e-5 * i, closing = gap / kNormalSpeed;
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"bearing\"\n"
          "node = \"a\"\nstiffness = [[1e-3, 0.0], [0.0, 1e-3]]\n[[contact]]\ntype = \"plane\"\nnodes = \"a\"\n"
          "law = \"hertz\"\nstiffness = 660.0\nexponent = 1.2\nnormal = [1.0, 0.0]\nfriction = { coefficient = 0.2, "
          "static_coefficient = 2.0, stick_stiffness = 100.0 }\ngap = " +
              std::to_string(gap) +
              "\n[initial]\nvelocity = [{ nodes = \"a\", dof = \"uy\", value = 0.1 }, { nodes = \"a\", dof = \"uz\", "
              "value = 0.01 }]\n[integrator]\ntolerance = 1e-7\nend_time = " +
              std::to_string(closing + 2.0 * kLater) + "\n",
          {std::string("integrator.type=") + method});
      record::Probes probe(
          {{"a", run.model().nodes.select("a").nodes.front(), {model::Quantity::contact_friction}, ""}},
          run.dynamics());
      Sampled sampled(probe, closing + kLater);
      run.simulation().add(sampled);
      ASSERT_TRUE(run.run().completed) << method << run.simulation().report().message;
      EXPECT_NEAR(std::abs(sampled.values[0]), wanted, 3e-4 * wanted) << method << ' ' << gap;
    }
}

/// A mass between springs strikes a plane whose law has no stiffness at first: the stick spring takes hold after 1e-6
/// s of slip at mu N, N = k_n (v t)^n, when this reaches what the dashpot d needs. It then holds the tangential motion:
/// m w'' + d w' + (k + k_t) w = k_t w_0, w_0 being the place where it takes hold. Steps between closing and stick are
/// so short that derivatives of the dense output are rounding.
TEST(StickSpring, TakesHoldSoonAfterASoftClosing) {
  const std::string scene = R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 16.0
[[element]]
type = "spring"
node = "m"
dof = "uz"
stiffness = 8.0e4
[[contact]]
type = "plane"
normal = [1.0, 0.0]
nodes = "m"
gap = 2.0e-4
law = "hertz"
stiffness = 8.8e7
exponent = 1.2
friction = { coefficient = 0.43, stick_stiffness = 4.86e6, stick_damping = 58.0 }
[initial]
velocity = [{ nodes = "m", dof = "uy", value = 0.125 }, { nodes = "m", dof = "uz", value = -0.005 }]
[integrator]
end_time = 0.0018
)";
  constexpr double kClosing = 2e-4 / 0.125;
  const double open = std::sqrt(8e4 / 16.0), limit = 0.43 * 8.8e7 * std::pow(0.125, 1.2),
               slips = std::pow(58.0 * 0.005 * std::cos(open * kClosing) / limit, 1.0 / 1.2), begin = kClosing + slips,
               held_for = 0.0018 - begin, w = -0.005 / open * std::sin(open * begin),
               rate = -0.005 * std::cos(open * begin) + limit * std::pow(slips, 2.2) / 2.2 / 16.0,
               rest = 4.86e6 * w / (8e4 + 4.86e6), decay = 58.0 / 32.0,
               turn = std::sqrt((8e4 + 4.86e6) / 16.0 - decay * decay), q = w - rest;
  const double held = std::exp(-decay * held_for) *
                      (rate * std::cos(turn * held_for) -
                       (decay * rate + (decay * decay + turn * turn) * q) / turn * std::sin(turn * held_for));
  for (const char* method : {"dopri5", "rodas4", "extrapolation8", "exponential"})
    for (int i = 0; i <= 12; ++i) {
      const double tolerance = std::pow(10.0, -6.0 - 0.25 * i);
      SceneRun run(scene, {std::string("integrator.type=") + method,
                           "integrator.tolerance=" + std::to_string(1e12 * tolerance) + "e-12"});
      ASSERT_TRUE(run.run().completed) << method;
      EXPECT_NEAR(run.simulation().state().v[run.dof("m", DofKind::uz)], held, 50.0 * tolerance * 0.005)
          << method << ' ' << tolerance;
    }
}

/// The forces of rigid sticks that hold the same motion are not determined.
TEST(RigidFriction, RefusesSupportsThatHoldTheSameMotion) {
  const std::string again =
      "[[contact]]\ntype = \"friction\"\nnodes = \"block\"\nnormal_force = 5.0\nfriction = { coefficient = 0.3, ";
  const std::string rigid = "coefficient = 0.3, stick = \"rigid\"";
  try {
    SceneRun run(block(1.0, 100.0, rigid, 0.01, again + "stick = \"rigid\" }\n"));
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("combine supports that hold the same motion"), std::string::npos)
        << error.what();
  }
  SceneRun run(block(1.0, 100.0, rigid, 0.01, again + "stick_stiffness = 1e6 }\n"));
  EXPECT_TRUE(run.run().completed);
}

/// Without the contact that gives way first, the others hold.
TEST_P(FrictionMethods, ReleasesOnlyTheContactThatGivesWayFirst) {
  // A load of 14 N overloads both contacts at rest; once b slides, a needs 14 - 1.5 (14 - 3)/4 = 9.875 N.
  SceneRun jump(pile("0.0", "type = \"constant\"\nvalue = 14.0\n"), {GetParam()});
  ASSERT_TRUE(jump.run().completed) << jump.simulation().report().message;
  for (const Index body : {0, 1}) EXPECT_NEAR(jump.simulation().state().v[body], 11.0 / 4.0 * 0.2, 1e-8);
  // A ramp to 14 N at 0.1 s; both move with the belt's 3 N, pass its speed at 0.1 + 0.05/4.25 s, and go on against it.
  SceneRun pass(pile("0.3", "type = \"ramp\"\nto = 14.0\nend = 0.1\n"), {GetParam()});
  ASSERT_TRUE(pass.run().completed) << pass.simulation().report().message;
  for (const Index body : {0, 1})
    EXPECT_NEAR(pass.simulation().state().v[body], 0.3 + 11.0 / 4.0 * (0.1 - 0.05 / 4.25), 1e-8);
}

}  // namespace
}  // namespace butee::test::friction_test
