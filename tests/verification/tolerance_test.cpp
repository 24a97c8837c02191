// End error of methods with error control as a function of the tolerance, from 1e-2 to 1e-7 (order 2: 1e-6),
// on a forced oscillator that strikes a stop repeatedly, compared with the method `exact`.
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <utility>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::tolerance_test {
namespace {

std::string scene(const std::string& integrator) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
         "\"b\"\nmass = "
         "2.0\n[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 40.0\n[[element]]\ntype = \"spring\"\nnodes = "
         "[\"a\", "
         "\"b\"]\nstiffness = 60.0\n[damping]\nmass_proportional = 0.4\nstiffness_proportional = 2e-3\n"
         "[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 0.05\nstiffness = 4000.0\nlaw = \"linear\"\nsides = "
         "\"positive\"\n"
         "[[load]]\ntype = \"harmonic\"\nnode = \"b\"\namplitude = 9.0\nangular_frequency = 5.3\n"
         "[initial]\nvelocity = [{nodes = \"b\", value = -0.9}]\n[integrator]\nend_time = 4.0\n" +
         integrator;
}

std::vector<double> course(const std::string& integrator, Index* impacts = nullptr) {
  std::vector<double> times;
  for (int i = 1; i <= 400; ++i) times.push_back(0.01 * i);
  SceneRun run(scene(integrator));
  Sampler sampler(run.dof("a"), times);
  run.simulation().add(sampler);
  record::ImpactRecorder recorder(run.dynamics());
  if (impacts != nullptr) run.simulation().add(recorder);
  EXPECT_TRUE(run.run().completed) << integrator;
  if (impacts != nullptr) *impacts = static_cast<Index>(recorder.impacts().size());
  return sampler.x;
}

class Tolerance : public testing::TestWithParam<std::string> {};

TEST_P(Tolerance, IsWhatComesOut) {
  // Factor by which this scene amplifies an initial disturbance until its end, as measured by the last test.
  constexpr double kAmplification = 3.0, kReserve = 10.0;
  const std::vector<double> reference = course("type = \"exact\"\ntime_step = 1e-3\n");
  double slope = 0.0, squares = 0.0;
  std::string errors;
  const bool is_of_order_two = GetParam().ends_with("_adaptive");
  const int last = is_of_order_two ? 4 : 5;
  for (int i = 0; i <= last; ++i) {
    const double tolerance = std::pow(10.0, -2.0 - i);
    const double error =
        relative_rms(course("type = \"" + GetParam() + "\"\ntolerance = " + to_text(tolerance) + "\n"), reference);
    EXPECT_LE(error, kReserve * kAmplification * tolerance) << "at " << tolerance;
    errors += to_short_text(error) + " ";
    const double decades = -(i - 0.5 * last);
    slope += decades * std::log10(error);
    squares += decades * decades;
  }
  slope /= squares;
  EXPECT_GE(slope, 0.8) << errors;
  EXPECT_LE(slope, 1.2) << errors;
}

/// From rest displacements grow as t^2, velocities as t, or first backwards if the load is small at the start and grows
/// fast. The error is relative to the largest so far, at least a thousandth of the largest of the run, also within the
/// first steps. With x'' + omega^2 x = A cos(Omega t + phi) and P = A/(omega^2 - Omega^2)
/// x = P (cos(Omega t + phi) - cos(phi) cos(omega t) + sin(phi) sin(omega t) Omega/omega).
TEST_P(Tolerance, HoldsInTheFirstStepsFromRest) {
  constexpr double kLoad = 3.0, kOmega = 50.0, kEnd = 0.02;
  std::vector<double> times;
  for (int i = 1; i <= 400; ++i) times.push_back(kEnd / 400.0 * i);
  for (const auto& [turns, phase] : {std::pair{55.0, 0.4}, std::pair{320.0, -1.6}})
    for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
      if (tolerance < 1e-6 && GetParam().ends_with("_adaptive")) continue;
      const std::string text =
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = "
          "\"spring\"\nnode = \"m\"\nstiffness = 2500.0\n[[load]]\ntype = \"harmonic\"\nnode = "
          "\"m\"\namplitude = 3.0\nangular_frequency = " +
          to_text(turns) + "\nphase = " + to_text(phase) + "\n[integrator]\ntype = \"" + GetParam() +
          "\"\nend_time = 0.02\ntolerance = " + to_text(tolerance) + "\n";
      SceneRun run(text);
      Sampler sampler(run.dof("m"), times);
      run.simulation().add(sampler);
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      const double size = kLoad / (kOmega * kOmega - turns * turns), c = std::cos(phase), s = std::sin(phase);
      std::vector<double> x, v;
      for (const double t : times) {
        x.push_back(size * (std::cos(turns * t + phase) - c * std::cos(kOmega * t) +
                            s * turns / kOmega * std::sin(kOmega * t)));
        v.push_back(size * (-turns * std::sin(turns * t + phase) + c * kOmega * std::sin(kOmega * t) +
                            s * turns * std::cos(kOmega * t)));
      }
      const auto size_of = [](double value) { return std::abs(value); };
      double scale = 1e-3 * std::abs(std::ranges::max(x, {}, size_of)),
             scale_v = 1e-3 * std::abs(std::ranges::max(v, {}, size_of));
      for (std::size_t i = 0; i < times.size(); ++i) {
        scale = std::max(scale, std::abs(x[i]));
        scale_v = std::max(scale_v, std::abs(v[i]));
        ASSERT_NEAR(sampler.x[i], x[i], 10.0 * tolerance * scale) << tolerance << " at " << times[i] << text;
        ASSERT_NEAR(sampler.v[i], v[i], 10.0 * tolerance * scale_v) << tolerance << " at " << times[i] << text;
      }
    }
}

/// Runs of 0.02 to 0.1 periods of a body that is pushed from rest, -0.6 mm from where its spring is slack. The first
/// step is a part of the run, and the displacement changes less than its rounding between rows. With X = x0 - F/k,
/// b = c/(2 m) and omega^2 = k/m - b^2: x = F/k + e^(-b t) X (cos(omega t) + b sin(omega t)/omega).
TEST_P(Tolerance, HoldsInRunsOfAPartOfAPeriod) {
  constexpr double kMass = 2.4, kStiffness = 9000.0, kDamping = 21.0, kStart = -6e-4, kForce = 11.0;
  constexpr double kAway = kStart - kForce / kStiffness, kDecay = kDamping / (2.0 * kMass);
  const double omega = std::sqrt(kStiffness / kMass - kDecay * kDecay);
  for (const double end : {0.002, 0.006, 0.012})
    for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-8, 1e-10}) {
      if (tolerance < (GetParam().ends_with("_adaptive") ? 1e-5 : end < 0.005 ? 1e-8 : 1e-10)) continue;
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.4\n[[element]]\ntype = \"spring\"\n"
          "node = \"m\"\nstiffness = 9000.0\ndamping = 21.0\n[initial]\ndisplacement = [{ nodes = \"m\", value = "
          "-6e-4 }]\n[[load]]\ntype = \"constant\"\nnode = \"m\"\nvalue = 11.0\n[integrator]\ntype = \"" +
          GetParam() + "\"\nend_time = " + to_text(end) + "\ntolerance = " + to_text(tolerance) + "\n");
      std::vector<double> times;
      for (int i = 1; i <= 600; ++i) times.push_back(end / 600.0 * i);
      Sampler sampler(run.dof("m"), times);
      run.simulation().add(sampler);
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      const double largest_v = std::abs(kAway) * kStiffness / kMass * end;
      double scale_v = 0.0;
      for (std::size_t i = 0; i < times.size(); ++i) {
        const double t = times[i], decayed = kAway * std::exp(-kDecay * t);
        const double x = kForce / kStiffness + decayed * (std::cos(omega * t) + kDecay / omega * std::sin(omega * t));
        const double v = -decayed * kStiffness / (kMass * omega) * std::sin(omega * t);
        scale_v = std::max({scale_v, std::abs(v), 1e-3 * largest_v});
        ASSERT_NEAR(sampler.x[i], x, 10.0 * tolerance * std::abs(kStart)) << tolerance << " at " << t << " of " << end;
        ASSERT_NEAR(sampler.v[i], v, 10.0 * tolerance * scale_v) << tolerance << " at " << t << " of " << end;
      }
    }
}

/// A moment in the middle of a symmetric beam: the displacement there is rounding of the rotations, and no step can
/// meet the tolerance relative to it.
TEST_P(Tolerance, IgnoresDisplacementsThatAreRounding) {
  for (const double tolerance : {1e-4, 1e-7}) {
    if (tolerance < 1e-6 && GetParam().ends_with("_adaptive")) continue;
    SceneRun run(
        "schema = 1\n[material.s]\nyoung_modulus = 2.1e11\ndensity = 7800.0\n[section.t]\nshape = "
        "\"tube\"\nouter_radius = 0.02\ninner_radius = 0.015\n[[element]]\ntype = \"beam\"\nname = "
        "\"b\"\nmaterial = \"s\"\nsection = \"t\"\nlength = 2.0\nelements = 2\n[[support]]\nnodes = [\"b:first\", "
        "\"b:last\"]\nfix = [\"u\"]\n[[load]]\nnode = \"b:middle\"\ndof = \"theta\"\ntype = \"ramp\"\nto = "
        "100.0\nstart = 0.01\nend = 0.010001\n[integrator]\ntype = \"" +
        GetParam() + "\"\nend_time = 0.02\ntolerance = " + to_text(tolerance) + "\n");
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    const Vector& x = run.simulation().state().x;
    EXPECT_LT(std::abs(x[run.dof("b:middle")]), 1e-11 * x.lpNorm<Eigen::Infinity>());
  }
}

/// The rounding of a body that travels far is not that of another one that strikes a stop slowly: x = G - V (t - t_out)
/// after half a period pi/omega of contact.
TEST_P(Tolerance, HoldsForASlowImpactBesideALongJourney) {
  constexpr double kGap = 1e-3, kSpeed = 5e-3, kStiffness = 1e11;
  const double duration = std::numbers::pi / std::sqrt(kStiffness);
  for (const double tolerance : {1e-6, 1e-8}) {
    if (tolerance < 1e-6 && GetParam().ends_with("_adaptive")) continue;
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = "
        "\"mass\"\nname = \"far\"\nmass = 1.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = "
        "0.001\nstiffness = 1e11\nlaw = \"linear\"\n[initial]\nvelocity = [{nodes = \"m\", value = 0.005}, {nodes "
        "= \"far\", value = 5.0}]\n[integrator]\ntype = \"" +
        GetParam() + "\"\nend_time = 0.3\ntolerance = " + to_text(tolerance) + "\n");
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    const time::State& state = run.simulation().state();
    EXPECT_NEAR(state.v[run.dof("m")], -kSpeed, 10.0 * tolerance * kSpeed) << tolerance;
    EXPECT_NEAR(state.x[run.dof("m")], kGap - kSpeed * (0.3 - kGap / kSpeed - duration), 10.0 * tolerance * kGap)
        << tolerance;
  }
}

/// Stages of a step that ends before an impact may lie behind the stop, whose force must not act on them:
/// x = V/omega sin(omega t) until x = G at t = T.
TEST(ToleranceBeforeAnImpact, IsNotDisturbedByTheStop) {
  constexpr double kOmega = 50.0, kSpeed = 1.5, kGap = 0.02, kTolerance = 1e-6;
  const double impact = std::asin(kGap * kOmega / kSpeed) / kOmega;
  for (const std::string method : {"dopri5", "extrapolation8"}) {
    for (double early = 1e-3; early > 1e-8; early *= 0.8) {
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = "
          "\"spring\"\nnode = \"m\"\nstiffness = 5000.0\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = "
          "0.02\nstiffness = 4e8\nlaw = \"hertz\"\ndamping = { type = \"jankowski\", restitution = 0.65, mass = 2.0 }\n"
          "[initial]\nvelocity = [{nodes = \"m\", value = 1.5}]\n[integrator]\ntype = \"" +
          method + "\"\nend_time = 0.02\ntolerance = 1e-6\n");
      Sampler sampler(run.dof("m"), {0.6 * impact, impact - early});
      run.simulation().add(sampler);
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      EXPECT_NEAR(sampler.v[1], kSpeed * std::cos(kOmega * (impact - early)), 10.0 * kTolerance * kSpeed)
          << method << ", " << early << " s before the impact";
    }
  }
}

/// A load that rises and falls within 1e-10 s at t = 4.3 s, where doubles are 9e-16 s apart: the rounding of an instant
/// changes it by 1e-5. With the impulse J and the instant T of its peak x = J/(m omega) sin(omega (t - T)) thereafter.
TEST_P(Tolerance, DoesNotFeelTheRoundingOfInstantsInAPulse) {
  constexpr double kStiffness = 3.9, kBegin = 4.283791715117179, kPeak = 4.283791715223565, kEnd = 4.28379171532995,
                   kForce = 6.7e8;
  const double omega = std::sqrt(kStiffness), impulse = 0.5 * kForce * (kEnd - kBegin);
  std::vector<double> times;
  for (int i = 0; i <= 40; ++i) times.push_back(4.3 + 0.1 * i);
  for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
    if (tolerance < 1e-6 && GetParam().ends_with("_adaptive")) continue;
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
        "\"m\"\nstiffness = 3.9\n[[load]]\ntype = \"table\"\nnode = \"m\"\ntimes = [4.283791715117179, "
        "4.283791715223565, 4.28379171532995]\nvalues = [0.0, 6.7e8, 0.0]\n[integrator]\ntype = \"" +
        GetParam() + "\"\nend_time = 8.4\ntolerance = " + to_text(tolerance) + "\n");
    Sampler sampler(run.dof("m"), times);
    run.simulation().add(sampler);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double phase = omega * (times[i] - kPeak);
      EXPECT_NEAR(sampler.v[i], impulse * std::cos(phase), 10.0 * tolerance * impulse) << tolerance;
      EXPECT_NEAR(sampler.x[i], impulse / omega * std::sin(phase), 10.0 * tolerance * impulse / omega) << tolerance;
    }
  }
}

/// A load that sets a stiff mass in motion after a long rest, in which steps have become a thousand periods long. An
/// L-stable method that kept them would go to the static displacement, and its estimate would agree. With a ramp from T
/// to T + r of a force F: x = F/k (1 - (sin(omega (t - T)) - sin(omega (t - T - r)))/(omega r)).
TEST_P(Tolerance, SeesAVibrationThatALoadStarts) {
  constexpr double kStiffness = 1e8, kForce = 10.0, kStart = 1.0, kRamp = 1e-6, kTolerance = 4e-3;
  const double omega = std::sqrt(kStiffness);
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 1e8\n[[load]]\ntype = \"ramp\"\nnode = \"m\"\nto = 10.0\nstart = 1.0\nend = "
      "1.000001\n[integrator]\ntype = \"" +
      GetParam() + "\"\nend_time = 1.2\ntolerance = 4e-3\n");
  std::vector<double> times;
  for (int i = 1; i <= 1000; ++i) times.push_back(kStart + 1e-5 * i);
  Sampler sampler(run.dof("m"), times);
  run.simulation().add(sampler);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = omega * (times[i] - kStart), since = t - omega * kRamp, turn = omega * kRamp;
    const double x = kForce / kStiffness * (1.0 - (std::sin(t) - std::sin(since)) / turn),
                 v = -kForce / kStiffness * omega * (std::cos(t) - std::cos(since)) / turn;
    ASSERT_NEAR(sampler.x[i], x, 10.0 * kTolerance * 2.0 * kForce / kStiffness) << times[i];
    ASSERT_NEAR(sampler.v[i], v, 10.0 * kTolerance * kForce / kStiffness * omega) << times[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Tolerance,
                         testing::Values("exponential", "rodas4", "dopri5", "extrapolation8", "bathe_adaptive",
                                         "generalized_alpha_adaptive", "hht_alpha_adaptive",
                                         "discrete_gradient_adaptive", "central_differences_adaptive"),
                         [](const auto& one) { return one.param; });

/// The largest errors within steps of x and v of one DOF, relative to given scales.
class WithinSteps final : public time::Observer {
 public:
  using Motion = std::function<std::array<double, 2>(double)>;
  WithinSteps(Motion motion, std::array<double, 2> scales) : motion_(std::move(motion)), scales_(scales) {}
  void step(const time::AcceptedStep& step) override {
    constexpr Index kDof = 0;
    for (int k = 1; k <= 8; ++k) {
      const double t = step.from.t + k / 8.0 * (step.to.t - step.from.t);
      double x = 0.0, v = 0.0;
      step.motion.interpolate(t, {&kDof, 1}, {{&x, 1}, {&v, 1}, {}});
      const auto [wanted_x, wanted_v] = motion_(t);
      error = std::max({error, std::abs(x - wanted_x) / scales_[0], std::abs(v - wanted_v) / scales_[1]});
    }
  }

  double error = 0.0;

 private:
  Motion motion_;
  std::array<double, 2> scales_;
};

/// A stiff mass whose vibration decays, so that a load moves it quasi-statically in steps of many periods. There the
/// error of a solution does not fall with a higher power of the step than the estimate (order reduction), and the error
/// of a velocity, times the long step, is one of displacements in outputs.
TEST(ToleranceOfStiffMotion, HoldsInLongSteps) {
  constexpr double kMass = 0.111, kStiffness = 4.0e6, kDashpot = 54.4, kForce = 3000.0, kTurn = 26.7, kStart = 2.8e-3;
  const double delta = 0.5 * kDashpot / kMass, fast = std::sqrt(kStiffness / kMass - delta * delta);
  const std::complex<double> steady =
      kForce / std::complex<double>(kStiffness - kMass * kTurn * kTurn, kDashpot * kTurn);
  // x = Re(P e^(i Omega t)) + e^(-delta t) (a cos + b sin)
  const double a = kStart - steady.real(), b = (delta * a + kTurn * steady.imag()) / fast;
  const auto motion = [&](double t) {
    const std::complex<double> forced = steady * std::polar(1.0, kTurn * t);
    const double c = std::cos(fast * t), s = std::sin(fast * t), decay = std::exp(-delta * t);
    return std::array<double, 2>{
        forced.real() + decay * (a * c + b * s),
        -kTurn * forced.imag() + decay * ((b * fast - delta * a) * c - (a * fast + delta * b) * s)};
  };
  for (const char* method : {"rodas4", "dopri5", "extrapolation8", "exponential"})
    for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6}) {
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 0.111\n[[element]]\ntype = "
          "\"spring\"\nnode = \"m\"\nstiffness = 4e6\ndamping = 54.4\n[[load]]\ntype = \"harmonic\"\nnode = "
          "\"m\"\namplitude = 3000.0\nangular_frequency = 26.7\n[initial]\ndisplacement = [{ nodes = \"m\", "
          "value = 2.8e-3 }]\n[integrator]\nend_time = 0.2\n",
          {std::string("integrator.type=") + method, "integrator.tolerance=" + to_text(tolerance)});
      WithinSteps errors(motion, {kStart, kStart * fast});
      run.simulation().add(errors);
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      EXPECT_LE(errors.error, 10.0 * tolerance) << method << " " << tolerance;
    }
}

/// A body that turns 1e-8 m before its stop: stages with few parts of a step meet the stop, the motion does not.
TEST(ToleranceBesideAStop, HoldsWhereOnlyStagesMeetIt) {
  constexpr double kSpeed = 0.1, kTurn = 100.0;
  for (const char* method : {"extrapolation8", "dopri5", "rodas4"})
    for (const double tolerance : {1e-5, 1e-6, 1e-7, 1e-8}) {
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
          "\"m\"\nstiffness = 1e4\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 1.00001e-3\nlaw = "
          "\"linear\"\nstiffness = 2e4\n[initial]\nvelocity = [{ nodes = \"m\", value = 0.1 }]\n[integrator]\nend_time "
          "= "
          "5.0\n",
          {std::string("integrator.type=") + method, "integrator.tolerance=" + to_text(tolerance)});
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      const time::State& end = run.simulation().state();
      EXPECT_NEAR(end.x[0], kSpeed / kTurn * std::sin(kTurn * 5.0), 10.0 * tolerance * kSpeed / kTurn)
          << method << " " << tolerance;
      EXPECT_NEAR(end.v[0], kSpeed * std::cos(kTurn * 5.0), 10.0 * tolerance * kSpeed) << method << " " << tolerance;
    }
}

/// A load 300 times faster than the structure. A disturbance of the velocity by one tolerance moves the body by 160
/// tolerances of its displacement.
TEST(ToleranceUnderAFastLoad, IsKeptByMethodsOfOrderTwo) {
  constexpr double kForce = 1e4, kTurn = 1e4, kDelta = 0.5, kEnd = 0.1;
  const double own = std::sqrt(1000.0 - kDelta * kDelta);
  const std::complex<double> steady = kForce / std::complex<double>(1000.0 - kTurn * kTurn, kTurn);
  const double a = -steady.real(), b = (kDelta * a + kTurn * steady.imag()) / own;
  const double wanted = (steady * std::polar(1.0, kTurn * kEnd)).real() +
                        std::exp(-kDelta * kEnd) * (a * std::cos(own * kEnd) + b * std::sin(own * kEnd));
  for (const char* method : {"bathe_adaptive", "hht_alpha_adaptive", "generalized_alpha_adaptive",
                             "discrete_gradient_adaptive", "central_differences_adaptive"})
    for (const double tolerance : {1e-2, 1e-3}) {
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
          "\"m\"\nstiffness = 1000.0\ndamping = 1.0\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = "
          "1e4\nangular_frequency = 1e4\n[integrator]\nend_time = 0.1\n",
          {std::string("integrator.type=") + method, "integrator.tolerance=" + to_text(tolerance)});
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      EXPECT_NEAR(run.simulation().state().x[0], wanted, 160.0 * tolerance * 2e-4) << method << " " << tolerance;
    }
}

/// A pulse of two nanoseconds in whose corners the load changes by more than a thousandth over the rounding of t.
TEST(ToleranceAfterAShortPulse, IsKeptByMethodsOfOrderTwo) {
  constexpr double kPulse = 1.0, kMass = 0.9, kBegin = 0.0415, kWidth = 1.119e-9;
  for (const char* method :
       {"bathe_adaptive", "hht_alpha_adaptive", "generalized_alpha_adaptive", "discrete_gradient_adaptive"})
    for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 0.9\n[[element]]\ntype = "
          "\"spring\"\nnode = \"m\"\nstiffness = 6770.0\n[[load]]\ntype = \"table\"\nnode = \"m\"\ntimes = [" +
              to_text(kBegin) + ", " + to_text(kBegin + kWidth) + ", " + to_text(kBegin + 2.0 * kWidth) +
              "]\nvalues = [0.0, " + to_text(kPulse / kWidth) +
              ", 0.0]\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 0.1\nangular_frequency = "
              "108.0\n[integrator]\nend_time = 0.0416\n",
          {std::string("integrator.type=") + method, "integrator.tolerance=" + to_text(tolerance)});
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      EXPECT_NEAR(run.simulation().state().v[0], kPulse / kMass, 10.0 * tolerance * kPulse / kMass + 2e-3)
          << method << " " << tolerance;
    }
}

TEST(ToleranceScene, StrikesItsStopAndMagnifiesLittle) {
  Index impacts = 0;
  const std::vector<double> first = course("type = \"exact\"\ntime_step = 1e-3\n", &impacts);
  EXPECT_GE(impacts, 4);
  SceneRun disturbed(scene("type = \"exact\"\ntime_step = 1e-3\n"), {"initial.velocity[0].value=-0.9000009"});
  std::vector<double> times;
  for (int i = 1; i <= 400; ++i) times.push_back(0.01 * i);
  Sampler sampler(disturbed.dof("a"), times);
  disturbed.simulation().add(sampler);
  ASSERT_TRUE(disturbed.run().completed);
  // A relative change of 1e-6 of the initial velocity.
  EXPECT_LT(relative_rms(sampler.x, first), 3e-6);
}

}  // namespace
}  // namespace butee::test::tolerance_test
