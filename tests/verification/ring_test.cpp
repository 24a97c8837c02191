// Rubbing and whirling in rings, compared with closed forms of Jiang and Ulbrich's rotor, and between two
// bodies.
#include <cmath>
#include <complex>
#include <numbers>

#include <butee/dynamics/frequencies.hpp>
#include <butee/record/contact_recorder.hpp>
#include <butee/record/energy.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::ring_test {
namespace {

using Complex = std::complex<double>;
using std::numbers::pi;

std::string text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

std::string body(const std::string& name, double mass, double stiffness, double damping) {
  std::string toml = "[[element]]\ntype = \"mass\"\nname = \"" + name + "\"\nmass = " + text(mass) + "\n";
  for (const char* dof : {"uy", "uz"})
    toml += "[[element]]\ntype = \"spring\"\nnode = \"" + name + "\"\ndof = \"" + dof +
            "\"\nstiffness = " + text(stiffness) + "\ndamping = " + text(damping) + "\n";
  return toml;
}

std::string start_of(const std::string& name, Complex r, Complex v) {
  return "{ nodes = \"" + name + "\", dof = \"uy\", value = " + text(r.real()) + " }, { nodes = \"" + name +
         "\", dof = \"uz\", value = " + text(r.imag()) + " }" + (v == Complex() ? "" : "");
}

/// The rotor of S1: m = 1, c = 2 z, k = b, k_c = 1 beyond R0.
std::string rotor(double speed, double radius, const std::string& friction, double moment, Complex r, Complex v,
                  double end_time) {
  return "schema = 1\n" + body("rotor", 1.0, 0.04, 0.1) + "[rotation]\nspeed = " + text(speed) +
         "\n[[contact]]\ntype = \"ring\"\nnodes = \"rotor\"\ngap = 1.05\nstiffness = 1.0\nradius = " + text(radius) +
         "\n" + friction +
         (moment > 0.0 ? "[[load]]\ntype = \"unbalance\"\nnode = \"rotor\"\nmoment = " + text(moment) + "\n" : "") +
         "[initial]\ndisplacement = [" + start_of("rotor", r, {}) + "]\nvelocity = [" + start_of("rotor", v, {}) +
         "]\n[integrator]\ntype = \"dopri5\"\ntolerance = 1e-9\nend_time = " + text(end_time) + "\n";
}

Complex position(SceneRun& run, const std::string& node) {
  const auto& x = run.simulation().state().x;
  return {x[run.dof(node, DofKind::uy)], x[run.dof(node, DofKind::uz)]};
}

class RingMethods : public testing::TestWithParam<const char*> {};
/// exponential refuses stick springs.
class StickMethods : public RingMethods {};

/// S1: a stable forward rub of constant amplitude A; it persists for 100 units of time.
TEST_P(RingMethods, ASynchronousRubKeepsItsAmplitude) {
  struct Row {
    double mu, speed, amplitude;
  };
  for (const Row row : {Row{0.05, 0.3, 1.1887167725},
                        {0.05, 0.6, 2.0117317966},
                        {0.05, 0.9, 5.7959293582},
                        {0.1, 0.3, 1.1847189291},
                        {0.1, 0.6, 1.9733447704},
                        {0.1, 0.9, 4.8058279852}}) {
    const double w = row.speed;
    const Complex stiffness = Complex(0.04 - w * w, 0.1 * w) + (1.0 - 1.05 / row.amplitude) * Complex(1.0, row.mu);
    const Complex r = w * w / stiffness;
    EXPECT_NEAR(std::abs(r), row.amplitude, 1e-9 * row.amplitude);
    SceneRun run(rotor(w, 20.0, "friction = { coefficient = " + text(row.mu) + ", slip_speed = 1e-5 }\n", 1.0, r,
                       Complex(0, w) * r, 100.0),
                 {GetParam()});
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_NEAR(std::abs(position(run, "rotor")), row.amplitude, 1e-8 * row.amplitude) << row.mu << " " << w;
  }
}

/// S1: the rub becomes unstable for friction above mu_c (a Hopf bifurcation in the rotating frame). Of runs
/// that start near the closed form, those with less friction return to it and those with more depart from it.
/// Bisection to 1e-3.
TEST(SynchronousRub, LosesItsStabilityAtItsThreshold) {
  const double zeta = 0.05, b = 0.04, gap = 1.05;
  const auto amplitude = [&](double w, double mu) {
    // [(b + 1 - W^2) A - R0]^2 + [(2 z W + mu) A - mu R0]^2 = W^4; the larger root is the rub.
    const double p = b + 1.0 - w * w, q = 2.0 * zeta * w + mu;
    const double two = p * p + q * q, one = -2.0 * gap * (p + mu * q),
                 none = gap * gap * (1.0 + mu * mu) - std::pow(w, 4);
    return (-one + std::sqrt(one * one - 4.0 * two * none)) / (2.0 * two);
  };
  EXPECT_NEAR(amplitude(0.6, 0.05), 2.0117317966, 1e-9);
  const auto grows = [&](double w, double mu) {
    const double size = amplitude(w, mu);
    const Complex r = w * w / (Complex(b - w * w, 2.0 * zeta * w) + (1.0 - gap / size) * Complex(1.0, mu));
    constexpr double kOff = 1e-4, kTime = 1600.0;
    // At 1e-9 the method's own damping is far below the growth rates of 1e-5 at 1e-3 of mu.
    SceneRun run(rotor(w, 20.0, "friction = { coefficient = " + text(mu) + ", slip_speed = 1e-5 }\n", 1.0,
                       (1.0 + kOff) * r, Complex(0, w) * r, kTime),
                 {"integrator.type=extrapolation8"});
    // Mean square distance from the closed form in an early and in the last part of the run; rapidly decaying
    // parts have vanished by then.
    double early = 0.0, late = 0.0;
    constexpr int kSamples = 400;
    std::vector<double> times;
    for (int i = 1; i <= 2 * kSamples; ++i)
      times.push_back(kTime * (i <= kSamples ? 0.15 + 0.15 * i / kSamples : 0.85 + 0.15 * (i - kSamples) / kSamples));
    Sampler y(run.dof("rotor", DofKind::uy), times), z(run.dof("rotor", DofKind::uz), times);
    run.simulation().add(y);
    run.simulation().add(z);
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    for (std::size_t i = 0; i < times.size(); ++i)
      (i < kSamples ? early : late) +=
          std::norm(Complex(y.x.at(i), z.x.at(i)) * std::exp(Complex(0, -w * times[i])) - r);
    return late > early;
  };
  for (const auto& [speed, wanted] : {std::pair(0.3, 0.1939063821), {0.6, 0.1239881887}, {0.9, 0.1087751366}}) {
    double below = 0.8 * wanted, above = 1.2 * wanted;
    while (above - below > 1e-3 * wanted) {
      const double mu = 0.5 * (below + above);
      (grows(speed, mu) ? above : below) = mu;
    }
    EXPECT_NEAR(0.5 * (below + above), wanted, 1e-3 * wanted) << speed;
  }
}

/// Frequencies with closed contacts include the stiffness of rings, of planes along their normal and of stick
/// springs.
TEST(ClosedContacts, StiffenTheStructure) {
  const auto highest = [](const std::string& contact) {
    SceneRun run("schema = 1\n" + body("m", 2.0, 100.0, 0.0) + contact +
                 "[integrator]\ntype = \"dopri5\"\nend_time = 1.0\n");
    const auto open = dynamics::frequency_range(run.system(), dynamics::StopState::open);
    EXPECT_NEAR(open->highest, std::sqrt(50.0), 1e-9);
    const auto closed = dynamics::frequency_range(run.system(), dynamics::StopState::closed);
    return std::pair(closed->lowest, closed->highest);
  };
  const auto ring = highest("[[contact]]\ntype = \"ring\"\nnodes = \"m\"\ngap = 0.01\nstiffness = 700.0\n");
  EXPECT_NEAR(ring.first, 20.0, 1e-9);
  EXPECT_NEAR(ring.second, 20.0, 1e-9);
  const auto plane =
      highest("[[contact]]\ntype = \"plane\"\nnodes = \"m\"\nnormal = [0.6, 0.8]\ngap = 0.01\nstiffness = 700.0\n");
  EXPECT_NEAR(plane.first, std::sqrt(50.0), 1e-9);
  EXPECT_NEAR(plane.second, 20.0, 1e-9);
}

/// A ring without a gap is a spring in every direction, also from its centre on.
TEST(ClosedContacts, WithoutAGapAreASpringAroundTheCentre) {
  for (const std::string method : {"exact", "rodas4"}) {
    SceneRun run("schema = 1\n" + body("m", 2.0, 100.0, 0.0) +
                     "[[contact]]\ntype = \"ring\"\nnodes = \"m\"\ngap = 0.0\nstiffness = 700.0\nlaw = "
                     "\"linear\"\n[initial]\nvelocity = [{ nodes = \"m\", dof = \"uz\", value = 0.1 "
                     "}]\n[integrator]\nend_time = 1.0\n",
                 {"integrator.type=" + method});
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_NEAR(run.simulation().state().x[run.dof("m", DofKind::uz)], 0.1 / 20.0 * std::sin(20.0),
                method == "exact" ? 1e-14 : 1e-6)
        << method;
  }
}

/// S3: without unbalance, a start above the threshold of backward whirl ends in whirl, and one below it comes
/// to rest. With the wrong sign of friction both would grow without bound.
TEST_P(RingMethods, DryWhirlHasItsThresholdAndItsEndState) {
  const double w = 0.5701562119, a = 1.4686919071;
  for (const double factor : {1.05, 0.95}) {
    const Complex r = factor * a, v = Complex(0, -w) * r;
    SceneRun run(rotor(0.3, 20.0, "friction = { coefficient = 0.2, slip_speed = 0.01, smoothing = \"tanh\" }\n", 0.0, r,
                       v, 500.0),
                 {GetParam(), "integrator.tolerance=1e-7"});
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    if (factor < 1.0) {
      EXPECT_LT(std::abs(position(run, "rotor")), 1e-3);
      continue;
    }
    const auto& state = run.simulation().state();
    const Complex end = position(run, "rotor"),
                  speed(state.v[run.dof("rotor", DofKind::uy)], state.v[run.dof("rotor", DofKind::uz)]);
    EXPECT_NEAR(std::abs(end), 6.4037291140, 1e-5);
    EXPECT_NEAR((speed / end).imag(), -0.9359663665, 1e-5);
  }
}

/// A stick spring, unstressed at the start, is moved 3.5 turns around its ring; its force is k_t gap times
/// the total angle.
TEST_P(StickMethods, AStickSpringFollowsAroundTheRing) {
  const double gap = 0.01, stick = 50.0, w = 7.0 * pi;  // 3.5 turns in 1 s
  // Pressed with about 200 N; at mu = 10 the friction limit is far above k_t gap 7 pi = 11 N.
  std::string toml = "schema = 1\n" + body("m", 1.0, 1e4, 50.0) +
                     "[[contact]]\ntype = \"ring\"\nnodes = \"m\"\ngap = 0.01\nstiffness = 1e4\n"
                     "friction = { coefficient = 10.0, stick_stiffness = 50.0 }\n[initial]\ndisplacement = [" +
                     start_of("m", 0.02, {}) + "]\nvelocity = [" + start_of("m", Complex(0.0, 0.02 * w), {}) + "]\n";
  for (const auto& [dof, phase] : {std::pair("uy", 0.0), {"uz", -0.5 * pi}})
    toml += "[[load]]\ntype = \"harmonic\"\nnode = \"m\"\ndof = \"" + std::string(dof) +
            "\"\namplitude = 300.0\nangular_frequency = " + text(w) + "\nphase = " + text(phase) + "\n";
  SceneRun run(toml + "[integrator]\ntype = \"dopri5\"\ntolerance = 1e-8\nend_time = 1.0\n", {GetParam()});
  /// The angle, unwrapped.
  class Turned final : public time::Observer {
   public:
    void step(const time::AcceptedStep& step) override {
      total += std::arg(Complex(step.to.x[0], step.to.x[1]) / Complex(step.from.x[0], step.from.x[1]));
    }
    double total = 0.0;
  } turned;
  run.simulation().add(turned);
  record::EnergyRecorder energy(run.dynamics());
  run.simulation().add(energy);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  EXPECT_GT(turned.total, 6.5 * pi);
  const auto& state = run.simulation().state();
  std::vector<dynamics::ContactForces> forces;
  run.dynamics().contact_forces(state.t, state.x, state.v, forces);
  EXPECT_NEAR(forces[0].friction, stick * gap * turned.total, 1e-9 * stick * gap * turned.total);
  EXPECT_NEAR(energy.balance_error(), 0.0, 1e-6);
}

/// A shaft's surface that moves by many circumferences of a narrow ring winds the stick spring of a body in
/// contact.
TEST_P(StickMethods, ATurningSurfaceWindsAStickSpring) {
  // The surface moves 0.4 m, while gap 2 pi is 6 mm; the force is 20 N of a limit of 100 N.
  const double stick = 50.0, path = 0.4;
  const std::string toml =
      "schema = 1\n" + body("m", 1.0, 1e5, 600.0) +
      "[[contact]]\ntype = \"ring\"\nnodes = \"m\"\ngap = 1e-3\nstiffness = 1e5\nfriction = { coefficient = 2.0, "
      "stick_stiffness = 50.0, surface_speed = -4.0 }\n[initial]\ndisplacement = [" +
      start_of("m", 1.75e-3, {}) +
      "]\n[[load]]\ntype = \"constant\"\nnode = \"m\"\ndof = \"uy\"\nvalue = 250.0\n"
      "[integrator]\ntype = \"dopri5\"\ntolerance = 1e-8\nend_time = 0.1\n";
  SceneRun run(toml, {GetParam()});
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  const auto& state = run.simulation().state();
  std::vector<dynamics::ContactForces> forces;
  run.dynamics().contact_forces(state.t, state.x, state.v, forces);
  const double arc = 1e-3 * std::arg(position(run, "m"));
  EXPECT_NEAR(forces[0].friction, stick * (path + arc), 1e-9 * stick * path);
}

/// Deep in a soft ring the stick spring still acts at the radius of the gap: its force and its stretch are those of one
/// energy, so that friction takes energy in every impact, and the spring relaxes where it begins to slip.
TEST_P(StickMethods, ASoftRingTakesEnergyInEveryImpact) {
  for (const char* stiffness : {"1e4", "1e5"}) {
    const std::string toml = std::string(R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 1e3
damping = 1.0
[[element]]
type = "spring"
node = "m"
dof = "uz"
stiffness = 1.2e3
damping = 1.0
[[load]]
type = "harmonic"
node = "m"
amplitude = 20.0
angular_frequency = 30.0
[[load]]
type = "harmonic"
node = "m"
dof = "uz"
amplitude = 15.0
angular_frequency = 27.0
[integrator]
type = "dopri5"
tolerance = 1e-6
end_time = 1.0
[[contact]]
type = "ring"
nodes = "m"
gap = 0.01
friction = { coefficient = 0.2, stick_stiffness = 1e5 }
stiffness = )") + stiffness + "\n";
    SceneRun run(toml, {GetParam()});
    record::ContactRecorder impacts(run.dynamics());
    run.simulation().add(impacts);
    record::EnergyRecorder energy(run.dynamics());
    run.simulation().add(energy);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_LT(run.simulation().report().steps, 20000);
    EXPECT_LT(std::abs(energy.balance_error()), 1e-4);
    const auto all = impacts.impacts();
    ASSERT_GT(all.size(), 4U);
    for (const auto& impact : all) EXPECT_GT(impact.dissipated, -1e-9) << stiffness << " " << impact.t_in;
  }
}

/// S2: a rotor rubbing on an elastic stator, both free to move, at four speeds.
TEST_P(RingMethods, ARotorAndItsStatorWhirlTogether) {
  const double m = 10, k = 986960.4401, c = 125.6637061, ms = 5, ks = 2842446.0675, cs = 376.9911184, kc = 2e6,
               gap = 2e-4, mu = 0.1, e = 1e-4;
  struct Row {
    double hertz, rho, rotor, stator;
  };
  for (const Row& row : {Row{45, 2.1775357966e-4, 2.3232657021e-4, 1.4594478573e-5},
                         {52, 2.6475680524e-4, 3.2100475084e-4, 5.6297847312e-5},
                         {60, 3.8606870161e-4, 5.6104685594e-4, 1.7504413043e-4},
                         {66, 6.5946741034e-4, 1.1237761632e-3, 4.6436871332e-4}}) {
    const double w = 2 * pi * row.hertz;
    const Complex zr(k - m * w * w, c * w), zs(ks - ms * w * w, cs * w);
    const Complex b = kc * Complex(1, mu) * (1.0 / zr + 1.0 / zs), free = m * e * w * w / zr;
    // |rho (1 + B) - gap B| = |free|, the larger root.
    const double two = std::norm(1.0 + b), one = -2.0 * gap * (std::conj(b) * (1.0 + b)).real(),
                 none = gap * gap * std::norm(b) - std::norm(free);
    const double rho = (-one + std::sqrt(one * one - 4.0 * two * none)) / (2.0 * two), normal = kc * (rho - gap);
    const Complex turn = free / (rho * (1.0 + b) - gap * b);  // e^(i psi)
    const Complex force = normal * Complex(1, mu) * turn, s = force / zs, r = rho * turn + s;
    EXPECT_NEAR(rho, row.rho, 1e-9 * row.rho);
    EXPECT_NEAR(std::abs(r), row.rotor, 1e-9 * row.rotor);
    EXPECT_NEAR(std::abs(s), row.stator, 1e-9 * row.stator);
    const Complex iw(0, w);
    const std::string toml =
        "schema = 1\n" + body("rotor", m, k, c) + body("stator", ms, ks, cs) + "[rotation]\nspeed = " + text(w) +
        "\n[[contact]]\ntype = \"ring\"\nbetween = [\"rotor\", \"stator\"]\ngap = 2e-4\nstiffness = 2e6\nradius = "
        "1.0\nfriction = { coefficient = 0.1, slip_speed = 1e-3 }\n[[load]]\ntype = \"unbalance\"\nnode = "
        "\"rotor\"\nmoment = " +
        text(m * e) + "\n[initial]\ndisplacement = [" + start_of("rotor", r, {}) + ", " + start_of("stator", s, {}) +
        "]\nvelocity = [" + start_of("rotor", iw * r, {}) + ", " + start_of("stator", iw * s, {}) +
        "]\n[integrator]\ntype = \"dopri5\"\ntolerance = 1e-10\nend_time = " + text(20 * 2 * pi / w) + "\n";
    SceneRun run(toml, {GetParam()});
    record::EnergyRecorder energy(run.dynamics());
    run.simulation().add(energy);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_NEAR(std::abs(position(run, "rotor")), std::abs(r), 1e-8 * std::abs(r)) << row.hertz;
    EXPECT_NEAR(std::abs(position(run, "stator")), std::abs(s), 1e-8 * std::abs(s)) << row.hertz;
    EXPECT_NEAR(energy.balance_error(), 0.0, 1e-6);
  }
}

/// k y + k_c (y - gap) = m g at the bottom of the ring; the surface that rubs does not count.
TEST(StaticPosition, HasContactAndNoFriction) {
  SceneRun run("schema = 1\n" + body("rotor", 1.0, 0.04, 0.1) +
               "[rotation]\nspeed = 3.0\n[[contact]]\ntype = \"ring\"\nnodes = \"rotor\"\ngap = 1.05\nstiffness = "
               "10.0\nradius = 0.2\nfriction = { coefficient = 0.3, slip_speed = 1e-3 }\n[gravity]\nacceleration = "
               "[0.0, -9.81, 0.0]\nstatic = true\n[integrator]\ntype = \"dopri5\"\ntolerance = 1e-9\nend_time = 0.1\n");
  const Complex r = position(run, "rotor");
  EXPECT_NEAR(r.real(), -(9.81 + 10.0 * 1.05) / 10.04, 1e-12);
  EXPECT_NEAR(r.imag(), 0.0, 1e-12);
  // From there friction moves it across.
  ASSERT_TRUE(run.run().completed);
  EXPECT_GT(std::abs(position(run, "rotor").imag()), 1e-4);
}

/// A body on springs that a law pulls outwards, through the centre or past it at a small distance, without a contact.
std::string pulled(const std::string& contact, double across, const std::string& integrator) {
  const bool is_planar = across == 0.0 && contact.find("ring") == std::string::npos;
  std::string springs = body("m", 1.0, 40.0, 0.02);
  if (is_planar) springs.resize(springs.rfind("[[element]]"));
  return "schema = 1\n" + springs +
         "[[contact]]\nnodes = \"m\"\ngap = 0.1\nlaw = \"arctan\"\nstiffness = "
         "1e4\nregularization = 3e3\n" +
         contact +
         "[initial]\nvelocity = [{ nodes = \"m\", dof = \"uy\", value = 0.45 "
         "}" +
         (is_planar ? "" : ", { nodes = \"m\", dof = \"uz\", value = " + text(across) + " }") +
         "]\n[integrator]\nend_time = 5.0\n" + integrator;
}

std::vector<double> path_of(const std::string& scene) {
  std::vector<double> times;
  for (int i = 1; i <= 100; ++i) times.push_back(0.05 * i);
  SceneRun run(scene);
  Sampler sampler(run.dof("m", DofKind::uy), times);
  run.simulation().add(sampler);
  EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
  return sampler.x;
}

/// The pull changes its direction at the centre within a small part of a step. Through the centre itself the motion is
/// that between two stops, by `exact`, which refuses this ring.
TEST(CentreOfARing, IsPassedWithinTheTolerance) {
  for (const double across : {0.0, 1e-9, 1e-4, 1e-2}) {
    const auto expected =
        across == 0.0 ? path_of(pulled("type = \"stop\"\ndof = \"uy\"\n", 0.0, "type = \"exact\"\n"))
                      : path_of(pulled("type = \"ring\"\n", across, "type = \"extrapolation8\"\ntolerance = 1e-11\n"));
    for (const char* method : {"dopri5", "extrapolation8", "rodas4"})
      for (const double tolerance : {1e-3, 1e-4, 1e-6, 1e-8}) {
        const auto found =
            path_of(pulled("type = \"ring\"\n", across,
                           "type = \"" + std::string(method) + "\"\ntolerance = " + text(tolerance) + "\n"));
        double largest = 0.0, error = 0.0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
          largest = std::max(largest, std::abs(expected[i]));
          error = std::max(error, std::abs(found[i] - expected[i]) / largest);
        }
        EXPECT_LT(error, 5.0 * tolerance) << method << " at " << tolerance << " passing at " << across;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Adaptive, RingMethods,
                         testing::Values("integrator.type=dopri5", "integrator.type=extrapolation8",
                                         "integrator.type=rodas4", "integrator.type=exact",
                                         "integrator.type=exponential"));
INSTANTIATE_TEST_SUITE_P(Adaptive, StickMethods,
                         testing::Values("integrator.type=dopri5", "integrator.type=extrapolation8",
                                         "integrator.type=rodas4", "integrator.type=exact"));

/// The lever gap/r of a stick spring is limited to 2, which no series describes.
TEST(StickSpringInARing, IsRefusedByExactNearTheCentre) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\ndof = \"uy\"\nstiffness = 100.0\n[[element]]\ntype = \"spring\"\nnode = \"m\"\ndof = "
      "\"uz\"\nstiffness = 100.0\n[[contact]]\nnodes = \"m\"\ntype = \"ring\"\nside = \"outside\"\ncentre = [0.0064, "
      "0.0014]\ngap = 0.001\nlaw = \"linear\"\nstiffness = 12607\nfriction = { coefficient = 0.397, stick_stiffness = "
      "86579 }\n[initial]\nvelocity = [{ nodes = \"m\", dof = \"uy\", value = 1.2 }, { nodes = \"m\", dof = \"uz\", "
      "value = 0.2 }]\n[integrator]\nend_time = 0.01\n";
  SceneRun exact(scene, {"integrator.type=exact"});
  const time::RunReport& report = exact.run();
  EXPECT_FALSE(report.completed);
  EXPECT_NE(report.message.find("is nearer to the centre of a ring than half its gap"), std::string::npos)
      << report.message;
  SceneRun other(scene, {"integrator.type=extrapolation8"});
  EXPECT_TRUE(other.run().completed);
}

}  // namespace
}  // namespace butee::test::ring_test
