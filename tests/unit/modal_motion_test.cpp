#include <cmath>
#include <random>

#include <butee/core/target.hpp>
#include <butee/dynamics/modal_motion.hpp>
#include <gtest/gtest.h>

namespace butee::test::modal_motion_test {
namespace {

using dynamics::ModalHarmonic;
using dynamics::ModalMotion;
using dynamics::ModalPropagator;
using Eigen::ArrayXd;

/// Rounding of the largest term of the motion, and of the propagator's doublings, relative to that term.
constexpr double kTight = 1e-12;

/// Rigid, rigid with damping, slow, damped, resonant, nearly critical, overdamped, and increasingly fast
/// modes.
struct Modes {
  ArrayXd omega = ArrayXd(19), delta = ArrayXd::Zero(19);
  std::vector<ModalHarmonic> loads;
  std::vector<dynamics::ModalSystem::OtherLoad> others;

  Modes() {
    omega << 0, 0, 1e-3, 0.5, 2, 3, 4, 7, 9, 20, 50, 90, 200, 430, 900, 2e3, 5e3, 1e4, 3e5;
    delta.segment(1, 8) << 0.5, 0, 0.1, 400, 11, 0, 7, 0.01;
    delta.tail(6) << 1, 30, 0, 40, 3, 0;
    loads = {{4.0, ArrayXd::Constant(19, 1.5), ArrayXd::Constant(19, -0.7)},
             {50.0, ArrayXd::LinSpaced(19, -1, 1), ArrayXd::Zero(19)},
             {0.0, ArrayXd::LinSpaced(19, 2, 3), ArrayXd::Zero(19)}};
  }
};

/// The largest difference in q and v between ModalMotion and a ModalPropagator over the same time, for each
/// mode relative to its largest term.
double difference(const Modes& modes, double h, double part) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  ArrayXd q(19), v(19);
  std::array<ArrayXd, 3> f;
  for (ArrayXd* array : {&q, &v, &f[0], &f[1], &f[2]})
    *array = ArrayXd::NullaryExpr(19, [&] { return number(random); });
  v *= modes.omega + 1.0;
  for (ArrayXd& moment : f) moment *= modes.omega.square() + 1.0;
  const double t = 0.31, tau = part * h;
  ModalMotion motion(modes.omega, modes.delta, modes.loads, modes.others);
  // The forces over the partial step alone, as the propagator applies them: one within the step, the others
  // added.
  const auto padded = [](const ArrayXd& array) {
    Vector all = Vector::Zero(ModalMotion::padded(array.size()));
    all.head(array.size()) = array;
    return all;
  };
  const Vector q0 = padded(q), v0 = padded(v), constant = padded(f[0]), none = Vector::Zero(q0.size());
  const std::array<const double*, 3> moments = {constant.data(), none.data(), none.data()};
  motion.begin(t, h, q0.data(), v0.data(), moments.data());
  for (Index i = 0; i < q.size(); ++i) motion.add_force(Vector::Unit(q.size(), i), {0.0, f[1][i], f[2][i]}, part);
  motion.find(part);
  const Eigen::Map<const ArrayXd> found_q(motion.q(), q.size()), found_v(motion.v(), v.size());

  ModalPropagator flow(modes.omega, modes.delta, modes.loads, tau);
  flow.refine(modes.omega, modes.delta);
  ArrayXd x = flow.qq() * q + flow.qv() * v, speed = flow.vq() * q + flow.vv() * v;
  for (std::size_t k = 0; k < 3; ++k) {
    x += f[k] * flow.force_q(static_cast<int>(k));
    speed += f[k] * flow.force_v(static_cast<int>(k));
  }
  for (std::size_t j = 0; j < modes.loads.size(); ++j) {
    const double angle = modes.loads[j].angular_frequency * t, c = std::cos(angle), s = std::sin(angle);
    x += c * flow.harmonic_q(j, 0) - s * flow.harmonic_q(j, 1);
    speed += c * flow.harmonic_v(j, 0) - s * flow.harmonic_v(j, 1);
  }
  const ArrayXd size = q.abs() + v.abs() * std::min(tau, 1.0) + 10.0 + tau * tau,
                fast = (modes.omega + 1.0) * (q.abs() + 20.0) + v.abs() + tau;
  return std::max(((found_q - x).abs() / size).maxCoeff(), ((found_v - speed).abs() / fast).maxCoeff());
}

TEST(ModalMotion, AgreesWithTheFlowOverTheSameTimeForEveryInstructionSet) {
  const std::string chosen = target();
  for (const std::string& set : targets()) {
    choose_target(set);
    for (const double h : {1e-6, 1e-3, 0.02, 0.4})
      for (const double part : {0.07, 0.5, 1.0})
        EXPECT_LT(difference(Modes{}, h, part), kTight) << set << ", h = " << h << ", part " << part;
  }
  choose_target(chosen);
}

/// From rest, in a step that is far shorter than the periods of modes and loads: x = f t^2/2 and v = f t, where the
/// steady-state response to the loads is 1e16 times larger.
TEST(ModalMotion, KeepsDigitsInShortSteps) {
  const Modes modes;
  ModalMotion motion(modes.omega, modes.delta, modes.loads, modes.others);
  const Vector rest = Vector::Zero(ModalMotion::padded(modes.omega.size()));
  const double t = 0.31, h = 1e-9;
  motion.begin(t, h, rest.data(), rest.data(), nullptr);
  for (const double part : {0.3, 1.0}) {
    motion.find(part);
    for (Index i = 0; i < modes.omega.size(); ++i) {
      double force = 0.0;
      for (const ModalHarmonic& load : modes.loads)
        force +=
            load.cosine[i] * std::cos(load.angular_frequency * t) + load.sine[i] * std::sin(load.angular_frequency * t);
      const double tau = part * h;
      // The first terms left out are (omega t)^2/12 <= 8e-9, delta t <= 4e-7 and Omega t <= 5e-8.
      EXPECT_NEAR(motion.q()[i], 0.5 * tau * tau * force, 1e-6 * tau * tau * std::abs(force)) << i << ", " << part;
      EXPECT_NEAR(motion.v()[i], tau * force, 1e-6 * tau * std::abs(force)) << i << ", " << part;
    }
  }
}

/// A rigid mode from rest under a load of 50 rad/s, in a step of 1e-5 rad of it: x = (f(0) - f(t) + f'(0) t)/Omega^2 in
/// powers of t, of which the third and fourth are 3e-6 and 8e-12 of the second.
TEST(ModalMotion, TakesLoadsAsParabolasInShortSteps) {
  constexpr double kTurn = 50.0, kBegin = 0.31, kStep = 2e-7;
  const ArrayXd zero = ArrayXd::Zero(1);
  const std::vector<ModalHarmonic> loads = {{kTurn, ArrayXd::Constant(1, 1.5), ArrayXd::Constant(1, -0.7)}};
  const std::vector<dynamics::ModalSystem::OtherLoad> none;
  ModalMotion motion(zero, zero, loads, none);
  const Vector rest = Vector::Zero(ModalMotion::padded(1));
  motion.begin(kBegin, kStep, rest.data(), rest.data(), nullptr);
  motion.find(1.0);
  const double c = std::cos(kTurn * kBegin), s = std::sin(kTurn * kBegin), f = 1.5 * c - 0.7 * s,
               slope = kTurn * (-0.7 * c - 1.5 * s), curvature = -kTurn * kTurn * f;
  const double expected = kStep * kStep * (f / 2.0 + kStep * (slope / 6.0 + kStep * curvature / 24.0));
  EXPECT_NEAR(motion.q()[0], expected, 1e-13 * std::abs(expected));
}

TEST(ModalMotion, ForcesOfTheWholeStepHoldWithinIt) {
  // f = 2 s - 1 and 6 s^2 - 6 s + 1 on a rigid mass from rest, in closed form.
  const ArrayXd zero = ArrayXd::Zero(1);
  const std::vector<ModalHarmonic> none;
  const std::vector<dynamics::ModalSystem::OtherLoad> no_other;
  ModalMotion motion(zero, zero, none, no_other);
  const Vector rest = Vector::Zero(ModalMotion::padded(1)), unit = Vector::Unit(rest.size(), 0);
  const double h = 0.3, s = 0.4;
  const auto move = [&](const Vector& f1, const Vector& f2) {
    const std::array<const double*, 3> moments = {rest.data(), f1.data(), f2.data()};
    motion.begin(1.0, h, rest.data(), rest.data(), moments.data());
    motion.find(s);
  };
  move(unit, rest);
  EXPECT_NEAR(motion.v()[0], h * (s * s - s), 1e-16);
  EXPECT_NEAR(motion.q()[0], h * h * (s * s * s / 3.0 - s * s / 2.0), 1e-17);
  move(rest, unit);
  EXPECT_NEAR(motion.v()[0], h * (2.0 * s * s * s - 3.0 * s * s + s), 1e-16);
  const std::array<double, 3> products = motion.products(unit, 2.0 * unit);
  EXPECT_DOUBLE_EQ(products[0], motion.q()[0]);
  EXPECT_DOUBLE_EQ(products[1], motion.v()[0]);
  EXPECT_DOUBLE_EQ(products[2], 2.0 * motion.q()[0]);
}

}  // namespace
}  // namespace butee::test::modal_motion_test
