#include <cmath>
#include <numbers>

#include <butee/dynamics/frequencies.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::modal_damping_test {
namespace {

/// Half a unit in the last printed digit of each number.
constexpr double kFrequencyPrinted = 5e-6, kStaticPrinted = 5e-10, kPeakPrinted = 5e-10, kPeakTimePrinted = 5e-6;

/// Every mode decays with its own damping ratio and frequency: q = e^(-zeta w t) [cos(w_d t) + zeta w/w_d
/// sin(w_d t)], w_d = w sqrt(1 - zeta^2). Source: A. K. Chopra, Dynamics of Structures, 4th ed., sections 2.2
/// and 10.10.
double free_vibration(double omega, double zeta, double t) {
  const double wd = omega * std::sqrt(1.0 - zeta * zeta);
  return std::exp(-zeta * omega * t) * (std::cos(wd * t) + zeta * omega / wd * std::sin(wd * t));
}

/// A pinned beam of four elements, with eight modes and a stop that it never reaches.
std::string pinned_beam(const std::string& modal, const std::string& method, double h) {
  return R"(
schema = 1

[material.steel]
young_modulus = 2.0e11
density       = 8000.0

[section.bar]
shape  = "circle"
radius = 0.05

[[element]]
type     = "beam"
name     = "rod"
material = "steel"
section  = "bar"
length   = 4.0
elements = 4

[[support]]
nodes = ["rod:first", "rod:last"]
fix   = ["u"]

[[contact]]
type      = "stop"
nodes     = "rod:middle"
gap       = 1.0e3
stiffness = 1.0e6

[damping]
modal = )" +
         modal + "\n\n[integrator]\ntype = \"" + method + "\"\nend_time = 1.0\ntime_step = " + std::to_string(h) + R"(

[integrator.newmark]
residual_tolerance  = 1.0e-13
increment_tolerance = 1.0e-13
max_iterations      = 20
)";
}

struct Decay {
  const char* name;
  const char* modal;
  std::vector<double> ratios;  ///< of the eight modes
};

std::ostream& operator<<(std::ostream& stream, const Decay& decay) {
  return stream << decay.name;
}

class ModalDecay : public testing::TestWithParam<Decay> {
 protected:
  /// The modal coordinates after two periods of the lowest mode; initially all are 1, at rest.
  Vector end(const std::string& method) {
    SceneRun scene(pinned_beam(GetParam().modal, method, 1e-6));
    modes_ = *dynamics::lowest_modes(scene.system(), 8);
    h_ = 0.02 / modes_.frequencies[7];
    steps_ = static_cast<int>(std::ceil(4.0 * std::numbers::pi / modes_.frequencies[0] / h_));
    time::State from, to;
    from.x = modes_.shapes.rowwise().sum();
    from.v = Vector::Zero(from.x.size());
    scene.integrator().start(from);
    for (int i = 1; i <= steps_; ++i) {
      EXPECT_EQ(scene.integrator().step(from, {h_, i * h_}, to).status, time::StepStatus::ok);
      std::swap(from, to);
    }
    return modes_.shapes.transpose() * scene.system().mass * from.x;
  }
  double exact(Index mode) const {
    return free_vibration(modes_.frequencies[mode], GetParam().ratios[static_cast<std::size_t>(mode)], steps_ * h_);
  }
  /// Relative error due to a phase error, rad.
  double left_of(double phase, Index mode) const {
    const double zeta = GetParam().ratios[static_cast<std::size_t>(mode)];
    return phase * std::exp(-zeta * modes_.frequencies[mode] * steps_ * h_);
  }

  dynamics::Modes modes_;
  double h_ = 0.0;
  int steps_ = 0;
};

/// Rounding of the projections onto the modes, over some 50 000 steps.
constexpr double kProjection = 1e-9;

TEST_P(ModalDecay, FollowsTheClosedFormInEveryModeByRungeKutta) {
  const Vector q = end("rk4");
  // Phase error (w h)^4/120 per radian: 1.3e-9 per radian over 1000 rad in the highest mode.
  for (Index i = 0; i < 8; ++i) {
    const double wh = modes_.frequencies[i] * h_;
    EXPECT_NEAR(q[i], exact(i), left_of(std::pow(wh, 4) / 100 * wh * steps_, i) + kProjection) << "mode " << i + 1;
  }
}

TEST_P(ModalDecay, FollowsTheClosedFormInEveryModeByNewmark) {
  const Vector q = end("newmark");
  // Phase error (w h)^2/12 per radian.
  for (Index i = 0; i < 8; ++i) {
    const double wh = modes_.frequencies[i] * h_;
    EXPECT_NEAR(q[i], exact(i), left_of(wh * wh / 10 * wh * steps_, i) + kProjection) << "mode " << i + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(
    ratios, ModalDecay,
    testing::Values(Decay{"one_for_all", "0.02", std::vector<double>(8, 0.02)},
                    Decay{"a_list", "[0.05, 0.01, 0.03]", {0.05, 0.01, 0.03, 0.0, 0.0, 0.0, 0.0, 0.0}}),
    [](const auto& instance) { return std::string(instance.param.name); });

/// The NAFEMS benchmark 5T as an Euler-Bernoulli beam: pinned, 10 m, 2 m square, a step load of 1e6 N/m, 2 %
/// damping in every mode. Source: NAFEMS, Selected Benchmarks for Forced Vibration, 1989, test 5T. The
/// numbers are those of the modal sum below, confirmed by an independent program. (The published ones are for
/// a deep beam with shear.)
constexpr const char* kNafems = R"(
schema = 1

[material.steel]
young_modulus = 2.0e11
density       = 8000.0

[section.square]
shape  = "rectangle"
width  = 2.0
height = 2.0

[[element]]
type     = "beam"
name     = "deep"
material = "steel"
section  = "square"
length   = 10.0
elements = 20

[[support]]
nodes = ["deep:first", "deep:last"]
fix   = ["u"]

[[load]]
type  = "distributed"
beam  = "deep"
value = 1.0e6

[damping]
modal = 0.02

[integrator]
type      = "rk4"
time_step = 2.5e-6    # s; Runge-Kutta is stable to 4.8e-6
end_time  = 0.02

[integrator.newmark]
residual_tolerance  = 1.0e-12
increment_tolerance = 1.0e-12
max_iterations      = 20
)";

constexpr double kBending = 2.0e11 * 16.0 / 12.0, kMassPerLength = 8000.0 * 4.0, kLength = 10.0, kLoad = 1e6;

/// u(L/2, t) = sum over odd n of 4 q L^4/(E I pi^5 n^5) sin(n pi/2) [1 - free_vibration(n^2 w_1)].
double modal_sum(double t) {
  const double w1 = std::pow(std::numbers::pi / kLength, 2) * std::sqrt(kBending / kMassPerLength);
  double u = 0.0;
  for (int n = 1; n < 60; n += 2) {
    const double part = 4.0 * kLoad * std::pow(kLength, 4) / (kBending * std::pow(std::numbers::pi * n, 5));
    const double sign = n % 4 == 1 ? 1.0 : -1.0;
    u += sign * part * (1.0 - free_vibration(n * n * w1, 0.02, t));
  }
  return u;
}

struct Largest {
  double t = 0.0, u = 0.0;
  void see(double time, double value) {
    if (value > u) *this = {time, value};
  }
};

Largest largest_of_modal_sum() {
  Largest largest;
  for (int i = 0; i <= 20000; ++i) largest.see(i * 1e-6, modal_sum(i * 1e-6));
  return largest;
}

class Watch final : public time::Observer {
 public:
  explicit Watch(Index dof) : dof_(dof) {}
  void step(const time::AcceptedStep& step) override { largest.see(step.to.t, step.to.x[dof_]); }

  Largest largest;

 private:
  Index dof_;
};

TEST(Nafems5t, ClosedFormsAreTheRecomputedNumbers) {
  EXPECT_NEAR(std::numbers::pi / (2 * kLength * kLength) * std::sqrt(kBending / kMassPerLength), 45.34498,
              kFrequencyPrinted);
  EXPECT_NEAR(5.0 * kLoad * std::pow(kLength, 4) / (384.0 * kBending), 0.488281e-3, kStaticPrinted);
  EXPECT_NEAR(largest_of_modal_sum().u, 0.947475e-3, kPeakPrinted);
  EXPECT_NEAR(largest_of_modal_sum().t, 0.01103, kPeakTimePrinted);
}

TEST(Nafems5t, LowestFrequencyOfTheMesh) {
  const SceneRun scene(kNafems);
  const auto modes = dynamics::lowest_modes(scene.system(), 1);
  ASSERT_TRUE(modes.has_value());
  // The relative mesh error is (pi/20)^4/1440 = 4e-7.
  EXPECT_NEAR(modes->frequencies[0] / (2 * std::numbers::pi), 45.34498, 5e-7 * 45.34498 + kFrequencyPrinted);
}

class Nafems : public testing::TestWithParam<const char*> {};

TEST_P(Nafems, PeakAndItsTimeAreThoseOfTheModalSum) {
  SceneRun scene(kNafems, {std::string("integrator.type=") + GetParam()});
  Watch middle(scene.dof("deep:middle"));
  record::EnergyRecorder energy(scene.dynamics());
  scene.simulation().add(middle);
  scene.simulation().add(energy);
  ASSERT_TRUE(scene.run().completed);
  // Newmark and the mesh change the periods of the relevant modes by less than 1e-5, which hardly matters
  // near a maximum. Half a unit of the last printed digit is 5e-7 of the value; it is doubled.
  EXPECT_NEAR(middle.largest.u, 0.947475e-3, 2 * kPeakPrinted);
  // Four steps, in which the maximum changes by less than the rounding of the printed digits.
  EXPECT_NEAR(middle.largest.t, 0.01103, 2 * kPeakTimePrinted);
  EXPECT_GT(energy.dissipated(), 0.0);
  // Error of Simpson's rule with steps of w h up to 0.5 in modes with little energy.
  EXPECT_LE(std::abs(energy.balance_error()), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(methods, Nafems, testing::Values("rk4", "newmark"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace butee::test::modal_damping_test
