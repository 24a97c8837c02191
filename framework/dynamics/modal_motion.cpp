#include "butee/dynamics/modal_motion.hpp"

#include <cmath>
#include <complex>

#include "butee/dynamics/kernel/modal_motion.hpp"
#include "butee/dynamics/kernel/modal_series.hpp"
#include "butee/dynamics/load_parabola.hpp"

namespace butee::dynamics {
namespace {

using Eigen::ArrayXd;

/// A mode is in resonance if |omega^2 - Omega^2 + 2 i delta Omega| over omega^2 + Omega^2 is below
/// this.
constexpr double kResonance = 1e-7;
/// A harmonic load that turns by less than this in a step, in rad, is a parabola to rounding: its third derivative
/// changes it by 1e-15. The steady-state response, of which the motion within a short step is a small difference, would
/// lose digits by 1/angle^2.
constexpr double kParabola = 2e-5;
/// An oscillation is too near to critical damping for its closed form if (omega_d/omega)^2 is below
/// this.
constexpr double kCritical = 1e-2;

/// The closed form of an overdamped mode is too near to critical damping if (kappa/omega)^2 is below kCritical. Its
/// particular solution for forces that vary loses digits if its slower root turns less than this in a step.
constexpr double kLeastDecay = 1e-2;

/// The number of terms needed if (omega + delta) t is at most x: beyond them x^k/k! is below
/// rounding.
int terms_of(double x) {
  constexpr double kRounding = 1e-17;
  int terms = 5;
  for (double term = x * x * x * x * x / 120.0; term > kRounding && terms < kernel::kTerms; term *= x / ++terms) {
  }
  return terms;
}

}  // namespace

struct ModalMotion::Parts {
  /// The steady-state response to a harmonic load: cosine cos(Omega t) + sine sin(Omega t).
  struct Kept {
    double angular_frequency;
    ArrayXd cosine, sine;
  };
  struct Rates {
    double smallest, largest;
  };

  Parts(const ArrayXd& omega, const ArrayXd& delta, const std::vector<ModalHarmonic>& harmonics,
        const std::vector<ModalSystem::OtherLoad>& other_loads);
  kernel::ModesInMotion modes();
  /// The load is taken as a parabola in this step.
  bool is_parabola(const ModalHarmonic& load) const { return load.angular_frequency * h_ < kParabola; }
  std::span<const kernel::KeptUp> kept_at(double t);
  void begin(double t, double h, const double* q, const double* v, const double* const* moments);
  void add_parabolas();
  void add_other_loads();
  void add_force(Eigen::Ref<const Eigen::VectorXd> shape, const std::array<double, 3>& f, double part);
  void find(double part);
  void find_others(double tau);
  void find_other(Index mode, double tau);
  /// Finds an oscillating mode that has turned by more than kernel::kLargestAngle.
  void find_fast(Index mode, double tau);
  /// Finds an overdamped mode in closed form. Returns false where that would lose digits.
  bool find_overdamped(Index mode, double tau);
  /// Adds the steady-state responses at the instant of the last kept_at().
  void add_kept(Index mode);

  const ArrayXd &omega_, &delta_;
  const std::vector<ModalHarmonic>& harmonics_;
  const std::vector<ModalSystem::OtherLoad>& other_loads_;
  // Padded by modes at rest.
  ArrayXd square_, decay_, frequency_;
  ArrayXd compliance_;        ///< 1/omega^2; 0 for rigid modes, which are always slow or without closed form
  double single_decay_;       ///< 1/s, if all modes share it; negative if they differ
  std::vector<Rates> rates_;  ///< omega + delta in each register
  std::vector<Kept> kept_;
  std::vector<kernel::KeptUp> kept_up_;
  std::vector<Index> resonant_, damped_;  ///< modes without closed form; the damped ones use a series while slow
  std::vector<char> is_oscillation_;      ///< of each mode: it is neither of them

  double t_ = 0.0, h_ = 0.0;
  ArrayXd q0_, v0_;  ///< without the steady-state response
  std::array<ArrayXd, 3> force_;
  std::array<ArrayXd, 3> led_;  ///< the polynomial particular solution for the forces
  ArrayXd cosine_, sine_;       ///< of the oscillation about it
  bool has_force_ = false, is_led_ = false;
  ArrayXd q_, v_;
};

ModalMotion::ModalMotion(const ModalSystem& modal)
    : ModalMotion(modal.frequencies(), modal.decay(), modal.harmonics(), modal.other_loads()) {}

ModalMotion::ModalMotion(const ArrayXd& omega, const ArrayXd& delta, const std::vector<ModalHarmonic>& harmonics,
                         const std::vector<ModalSystem::OtherLoad>& other_loads)
    : parts_(std::make_unique<Parts>(omega, delta, harmonics, other_loads)) {}

ModalMotion::~ModalMotion() = default;

const double* ModalMotion::q() const {
  return parts_->q_.data();
}

const double* ModalMotion::v() const {
  return parts_->v_.data();
}

void ModalMotion::begin(double t, double h, const double* q, const double* v, const double* const* moments) {
  parts_->begin(t, h, q, v, moments);
}

void ModalMotion::add_force(Eigen::Ref<const Eigen::VectorXd> shape, const std::array<double, 3>& f, double part) {
  parts_->add_force(shape, f, part);
}

void ModalMotion::find(double part) {
  parts_->find(part);
}

ModalMotion::Parts::Parts(const ArrayXd& omega, const ArrayXd& delta, const std::vector<ModalHarmonic>& harmonics,
                          const std::vector<ModalSystem::OtherLoad>& other_loads)
    : omega_(omega), delta_(delta), harmonics_(harmonics), other_loads_(other_loads) {
  const Index n = omega.size(), room = padded(n);
  for (ArrayXd* array : {&decay_, &q0_, &v0_, &q_, &v_, &cosine_, &sine_}) array->setZero(room);
  for (auto* arrays : {&force_, &led_})
    for (ArrayXd& array : *arrays) array.setZero(room);
  square_.setConstant(room, 1.0);
  frequency_.setConstant(room, 1.0);
  square_.head(n) = omega.square();
  compliance_ = (square_ > 0.0).select(1.0 / square_, 0.0);
  decay_.head(n) = delta;
  single_decay_ = (delta == delta[0]).all() ? delta[0] : -1.0;
  for (Index begin = 0; begin < n; begin += kernel::kModesAtOnce) {
    const auto rates = (omega + delta).segment(begin, std::min(kernel::kModesAtOnce, n - begin));
    rates_.push_back({rates.minCoeff(), rates.maxCoeff()});
  }
  for (Index i = 0; i < n; ++i) {
    const double turning = omega[i] * omega[i] - delta[i] * delta[i];
    if (turning > kCritical * omega[i] * omega[i])
      frequency_[i] = std::sqrt(turning);
    else
      damped_.push_back(i);
  }
  std::vector<bool> is_resonant(static_cast<std::size_t>(n), false);
  for (const ModalHarmonic& load : harmonics) {
    const double turn = load.angular_frequency;
    Kept& kept = kept_.emplace_back(Kept{turn, ArrayXd::Zero(room), ArrayXd::Zero(room)});
    if (turn == 0.0) continue;  // A constant force has no such response.
    for (Index i = 0; i < n; ++i) {
      const std::complex<double> hold(omega[i] * omega[i] - turn * turn, 2.0 * delta[i] * turn);
      if (std::abs(hold) < kResonance * (omega[i] * omega[i] + turn * turn)) {
        is_resonant[static_cast<std::size_t>(i)] = true;
        continue;
      }
      const std::complex<double> motion = std::complex<double>(load.cosine[i], -load.sine[i]) / hold;
      kept.cosine[i] = motion.real();
      kept.sine[i] = -motion.imag();
    }
  }
  for (Index i = 0; i < n; ++i)
    if (is_resonant[static_cast<std::size_t>(i)]) resonant_.push_back(i);
  is_oscillation_.assign(static_cast<std::size_t>(n), 1);
  for (const auto* others : {&resonant_, &damped_})
    for (const Index i : *others) is_oscillation_[static_cast<std::size_t>(i)] = 0;
}

Index ModalMotion::padded(Index modes) {
  return (modes + kernel::kModesAtOnce - 1) / kernel::kModesAtOnce * kernel::kModesAtOnce;
}

std::array<double, 3> ModalMotion::products(const Eigen::VectorXd& shape, const Eigen::VectorXd& weight,
                                            const double* q, const double* v) {
  const kernel::Products of = kernel::modal_motion().multiply(shape.size(), shape.data(), weight.data(), q, v);
  return {of.q, of.v, of.weighted};
}

kernel::ModesInMotion ModalMotion::Parts::modes() {
  return {square_.size(),
          square_.data(),
          compliance_.data(),
          decay_.data(),
          frequency_.data(),
          single_decay_,
          q0_.data(),
          v0_.data(),
          {force_[0].data(), force_[1].data(), force_[2].data()},
          {led_[0].data(), led_[1].data(), led_[2].data()},
          cosine_.data(),
          sine_.data()};
}

std::span<const kernel::KeptUp> ModalMotion::Parts::kept_at(double t) {
  kept_up_.clear();
  for (std::size_t j = 0; j < kept_.size(); ++j) {
    if (is_parabola(harmonics_[j])) continue;
    const Kept& kept = kept_[j];
    const double angle = kept.angular_frequency * t;
    kept_up_.push_back(
        {kept.angular_frequency, kept.cosine.data(), kept.sine.data(), std::cos(angle), std::sin(angle)});
  }
  return kept_up_;
}

void ModalMotion::Parts::begin(double t, double h, const double* q, const double* v, const double* const* moments) {
  t_ = t;
  h_ = h;
  const auto kept = kept_at(t);
  kernel::modal_motion().start(modes(), q, v, kept.data(), std::ssize(kept));
  if (has_force_)
    for (ArrayXd& power : force_) power.setZero();
  has_force_ = moments != nullptr || !other_loads_.empty();
  add_parabolas();
  add_other_loads();
  kernel::modal_motion().lead(modes(), moments, 1.0 / h);
  is_led_ = true;
}

void ModalMotion::Parts::add_parabolas() {
  const Index n = omega_.size();
  for (const ModalHarmonic& load : harmonics_) {
    if (!is_parabola(load)) continue;
    has_force_ = true;
    const double turn = load.angular_frequency;
    if (turn == 0.0) {
      force_[0].head(n) += load.cosine;
      continue;
    }
    const double c = std::cos(turn * t_), s = std::sin(turn * t_);
    force_[0].head(n) += c * load.cosine + s * load.sine;
    force_[1].head(n) += turn * (c * load.sine - s * load.cosine);
    force_[2].head(n) -= 0.5 * turn * turn * (c * load.cosine + s * load.sine);
  }
}

void ModalMotion::Parts::add_other_loads() {
  const Index n = omega_.size();
  for (const ModalSystem::OtherLoad& load : other_loads_) {
    const LoadParabola f(*load.in_time, t_, t_ + h_);
    force_[0].head(n) += f.begin * load.shape;
    force_[1].head(n) += (4.0 * f.middle - 3.0 * f.begin - f.end) / h_ * load.shape;
    force_[2].head(n) += 2.0 * f.bend() / (h_ * h_) * load.shape;
  }
}

void ModalMotion::Parts::add_force(Eigen::Ref<const Eigen::VectorXd> shape, const std::array<double, 3>& f,
                                   double part) {
  const double r = 1.0 / (part * h_),
               powers[] = {f[0] - f[1] + f[2], r * (2.0 * f[1] - 6.0 * f[2]), 6.0 * r * r * f[2]};
  for (std::size_t k = 0; k < force_.size(); ++k) force_[k].head(omega_.size()) += powers[k] * shape.array();
  has_force_ = true;
  is_led_ = false;
}

void ModalMotion::Parts::find(double part) {
  if (!is_led_) kernel::modal_motion().lead(modes(), nullptr, 0.0);
  is_led_ = true;
  const double tau = part * h_;
  kernel::Speeds speeds{0, square_.size(), 0};
  double largest = 0.0;
  for (const Rates& rates : rates_) {
    if (rates.largest * tau > kernel::kSlow) break;
    largest = std::max(largest, rates.largest * tau);
    speeds.slow += kernel::kModesAtOnce;
  }
  speeds.terms = terms_of(largest);
  for (auto rates = rates_.rbegin(); speeds.fast > speeds.slow && rates->smallest * tau > kernel::kSlow; ++rates)
    speeds.fast -= kernel::kModesAtOnce;
  const auto kept = kept_at(t_ + tau);
  kernel::modal_motion().move(modes(), tau, speeds, kept.data(), std::ssize(kept), q_.data(), v_.data());
  find_others(tau);
}

void ModalMotion::Parts::find_others(double tau) {
  for (const Index i : resonant_) find_other(i, tau);
  for (const Index i : damped_)
    if ((omega_[i] + delta_[i]) * tau > kernel::kSlow && !find_overdamped(i, tau)) find_other(i, tau);
  for (Index i = omega_.size(); i-- > 0 && omega_[i] * tau > kernel::kLargestAngle;)
    if (is_oscillation_[static_cast<std::size_t>(i)] != 0) find_fast(i, tau);
}

void ModalMotion::Parts::find_fast(Index i, double tau) {
  const double decayed = std::exp(-delta_[i] * tau), angle = frequency_[i] * tau, c = decayed * std::cos(angle),
               s = decayed * std::sin(angle), a = cosine_[i], b = sine_[i];
  q_[i] = a * c + b * s + led_[0][i] + tau * (led_[1][i] + tau * led_[2][i]);
  v_[i] = (b * frequency_[i] - delta_[i] * a) * c - (a * frequency_[i] + delta_[i] * b) * s + led_[1][i] +
          2.0 * tau * led_[2][i];
  add_kept(i);
}

bool ModalMotion::Parts::find_overdamped(Index i, double tau) {
  const double square = omega_[i] * omega_[i], kappa = std::sqrt(std::max(0.0, delta_[i] * delta_[i] - square));
  if (square == 0.0 || kappa * kappa < kCritical * square) return false;
  const double fast = -(delta_[i] + kappa), slow = square / fast;
  if ((force_[1][i] != 0.0 || force_[2][i] != 0.0) && -slow * tau < kLeastDecay) return false;
  const double led[] = {led_[0][i], led_[1][i], led_[2][i]}, q = q0_[i] - led[0], v = v0_[i] - led[1];
  const double of_slow = 0.5 * (v - fast * q) / kappa * std::exp(slow * tau),
               of_fast = 0.5 * (slow * q - v) / kappa * std::exp(fast * tau);
  q_[i] = of_slow + of_fast + led[0] + tau * (led[1] + tau * led[2]);
  v_[i] = slow * of_slow + fast * of_fast + led[1] + 2.0 * tau * led[2];
  add_kept(i);
  return true;
}

void ModalMotion::Parts::add_kept(Index i) {
  for (const kernel::KeptUp& kept : kept_up_) {
    q_[i] += kept.of_cosine * kept.cosine[i] + kept.of_sine * kept.sine[i];
    v_[i] += kept.angular_frequency * (kept.of_cosine * kept.sine[i] - kept.of_sine * kept.cosine[i]);
  }
}

void ModalMotion::Parts::find_other(Index i, double tau) {
  const ArrayXd of_omega = omega_.segment(i, 1), of_delta = delta_.segment(i, 1);
  std::vector<ModalHarmonic> loads;
  for (std::size_t j = 0; j < kept_.size(); ++j) {
    const ModalHarmonic& load = harmonics_[j];
    const bool is_kept = kept_[j].cosine[i] != 0.0 || kept_[j].sine[i] != 0.0;
    if (!is_parabola(load) && !is_kept)
      loads.push_back({load.angular_frequency, load.cosine.segment(i, 1), load.sine.segment(i, 1)});
  }
  ModalPropagator flow(of_omega, of_delta, loads, tau);
  flow.refine(of_omega, of_delta);
  const double c0 = force_[0][i], c1 = tau * force_[1][i], c2 = tau * tau * force_[2][i];
  const double f[] = {c0 + c1 / 2.0 + c2 / 3.0, (c1 + c2) / 2.0, c2 / 6.0};
  double q = flow.qq()[0] * q0_[i] + flow.qv()[0] * v0_[i], v = flow.vq()[0] * q0_[i] + flow.vv()[0] * v0_[i];
  for (int k = 0; k < 3; ++k) {
    q += f[k] * flow.force_q(k)[0];
    v += f[k] * flow.force_v(k)[0];
  }
  for (std::size_t j = 0; j < loads.size(); ++j) {
    const double angle = loads[j].angular_frequency * t_, c = std::cos(angle), s = std::sin(angle);
    q += c * flow.harmonic_q(j, 0)[0] - s * flow.harmonic_q(j, 1)[0];
    v += c * flow.harmonic_v(j, 0)[0] - s * flow.harmonic_v(j, 1)[0];
  }
  q_[i] = q;
  v_[i] = v;
  add_kept(i);
}

}  // namespace butee::dynamics
