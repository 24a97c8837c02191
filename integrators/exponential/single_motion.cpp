#include "integrators/exponential/single_motion.hpp"

#include <cmath>
#include <complex>

namespace butee::integrators {

SingleMotion::SingleMotion(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, const SingleMode& mode,
                           ContactForce& contact)
    : dynamics_(dynamics),
      mode_(mode),
      contact_(contact),
      oscillator_(modal.frequencies()[0], mode.decay),
      motion_(modal) {
  for (const dynamics::ModalHarmonic& harmonic : mode.harmonics) {
    constexpr double kResonance = 1e-7;
    const double turn = harmonic.angular_frequency;
    const std::complex<double> hold(mode.square - turn * turn, 2.0 * mode.decay * turn),
        motion = std::complex<double>(harmonic.cosine[0], -harmonic.sine[0]) / hold;
    is_resonant_ = is_resonant_ || !(std::abs(hold) > kResonance * (mode.square + turn * turn));
    maintained_.push_back({motion.real(), -motion.imag()});
  }
  for (Eigen::VectorXd* one : {&padded_q_, &padded_v_, &padded_force_[0], &padded_force_[1], &padded_force_[2]})
    one->setZero(dynamics::ModalMotion::padded(1));
}

Motion SingleMotion::motion_of(Oscillator::Point at, double load) const {
  const double force = dynamics_.stops().force_of(0, mode_.stop_shape * at.q);
  const double a = load + mode_.stop_shape * force - mode_.square * at.q - 2.0 * mode_.decay * at.v;
  return {mode_.shape * at.q, mode_.shape * at.v, mode_.shape * a};
}

Motion SingleMotion::at(Oscillator::Point point, std::span<const Phase> phases) const {
  double load = 0.0;
  for (std::size_t j = 0; j < mode_.harmonics.size(); ++j) {
    const auto [c, s] = phases[j];
    load += c * mode_.harmonics[j].cosine[0] + s * mode_.harmonics[j].sine[0];
  }
  return motion_of(point, load);
}

Motion SingleMotion::within(const SingleBreakpoint& from, const SingleBreakpoint& to, std::span<const Phase> phases,
                            double t) {
  const double h = to.t - from.t, tau = t - from.t, part = tau / h;
  const ContactPath path = path_between(mode_, from, to);
  const bool is_changing =
      contact_.status(path) == ContactStatus::changing || contact_.jump(path) > 0.0 || contact_.bend(path) > 0.0;
  ForceMoments force = moments_within(from.step.force, 0.0, part);
  if (is_changing) {
    const ContactPath so_far = path.until(part);
    force = contact_.project(so_far, contact_.status(so_far)).force;
  }
  for (double& moment : force) moment *= mode_.stop_shape;
  double load_force = 0.0;
  Oscillator::Point at = from.at, kept{};
  for (std::size_t j = 0; j < mode_.harmonics.size(); ++j) {
    const dynamics::ModalHarmonic& load = mode_.harmonics[j];
    const Maintained& motion = maintained_[j];
    const Phase before = phases[j];
    const double angle = load.angular_frequency * t, c = std::cos(angle), s = std::sin(angle);
    load_force += c * load.cosine[0] + s * load.sine[0];
    at.q -= before.cosine * motion.cosine + before.sine * motion.sine;
    at.v -= load.angular_frequency * (before.cosine * motion.sine - before.sine * motion.cosine);
    kept.q += c * motion.cosine + s * motion.sine;
    kept.v += load.angular_frequency * (c * motion.sine - s * motion.cosine);
  }
  if (!is_resonant_ && oscillator_.can_move(tau)) {
    const double r = 1.0 / tau;
    at = oscillator_.move(
        at, {force[0] - force[1] + force[2], r * (2.0 * force[1] - 6.0 * force[2]), 6.0 * r * r * force[2]}, tau);
    return motion_of({at.q + kept.q, at.v + kept.v}, load_force);
  }
  padded_q_[0] = from.at.q;
  padded_v_[0] = from.at.v;
  std::array<const double*, 3> moments{};
  for (std::size_t k = 0; k < 3; ++k) {
    padded_force_[k][0] = force[k];
    moments[k] = padded_force_[k].data();
  }
  motion_.begin(from.t, tau, padded_q_.data(), padded_v_.data(), moments.data());
  motion_.find(1.0);
  return motion_of({motion_.q()[0], motion_.v()[0]}, load_force);
}

}  // namespace butee::integrators
