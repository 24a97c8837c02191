#include "integrators/exponential/derivative_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "integrators/exponential/load_parabola.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

using Eigen::ArrayXd;

namespace {

/// Nearer to critical damping, with (kappa/omega)^2 below this, both rates are about the same.
constexpr double kCritical = 1e-2;

/// A part e^x of less than this x is below the smallest number.
constexpr double kForgotten = -750.0;

/// The largest departures from a quintic over h of motion whose derivatives are at most of[0], of[1], of[2] and of6.
/// The sums of the Hermite functions and of their derivatives also bound the difference from a quintic.
struct Departure {
  double x, v, a;

  Departure(double h, double of0, double of1, double of2, double of6) {
    const QuinticError error = quintic_error(h, of6);
    x = std::min(error.x, 2.0 * of0 + 0.4 * h * of1 + 0.035 * h * h * of2);
    v = std::min(error.v, 5.0 * of1 + 0.3 * h * of2);
    a = std::min(error.a, 18.0 / h * of1 + 3.0 * of2);
  }
};

}  // namespace

DerivativeBounds::DerivativeBounds(const dynamics::ModalSystem& modal, const Breakpoints& breakpoints)
    : modal_(modal), breakpoints_(breakpoints) {
  for (Index i = 0; i < modal.size(); ++i) {
    const double omega = modal.frequencies()[i], delta = modal.decay()[i], square = delta * delta - omega * omega;
    if (omega == 0.0 || square < kCritical * omega * omega) continue;
    const double fast = -(delta + std::sqrt(square));
    overdamped_.push_back({i, omega * omega / fast, fast});
  }
}

// Without contact only its load adds energy to a mode: sqrt(v^2 + omega^2 q^2) grows by at most the
// integral of |f|. Higher derivatives follow from q'' = f - omega^2 q - 2 delta q'.
void DerivativeBounds::find(std::size_t breakpoint) {
  if (known_ == breakpoint) return;
  known_ = breakpoint;
  const double t = breakpoints_.time(breakpoint), h = breakpoints_.time(breakpoint + 1) - t;
  std::array<ArrayXd, 5> load;  // bounds of f and its first four derivatives
  for (ArrayXd& bound : load) bound.setZero(modal_.size());
  for (const dynamics::ModalHarmonic& harmonic : modal_.harmonics()) {
    double factor = 1.0;
    for (ArrayXd& bound : load) {
      bound += factor * (harmonic.cosine.square() + harmonic.sine.square()).sqrt();
      factor *= harmonic.angular_frequency;
    }
  }
  for (const dynamics::ModalSystem::OtherLoad& other : modal_.other_loads()) {
    const LoadParabola f(*other.in_time, t, t + h);
    const double bend = 4.0 * std::abs(f.bend());
    load[0] += f.largest() * other.shape.abs();
    load[1] += (std::abs(f.end - f.begin) + bend) / h * other.shape.abs();
    load[2] += bend / (h * h) * other.shape.abs();
  }
  const ArrayXd &omega = modal_.frequencies(), squares = omega.square();
  const ArrayXd decay = 2.0 * modal_.decay();
  const Eigen::Map<const ArrayXd> q(breakpoints_.q(breakpoint), modal_.size()),
      v(breakpoints_.v(breakpoint), modal_.size());
  of_[1] = (v.square() + squares * q.square()).sqrt() + h * load[0];
  of_[0] = (omega * h > 1.0).select(of_[1] / omega, q.abs() + h * of_[1]);
  of_[2] = load[0] + omega * (omega * of_[0]).min(of_[1]) + decay * of_[1];
  for (std::size_t k = 3; k < of_.size(); ++k) of_[k] = load[k - 2] + squares * of_[k - 2] + decay * of_[k - 1];
  if (modal_.other_loads().empty()) find_beside_steady(t, q, v);
  for (Overdamped& mode : overdamped_) find(mode, t, h, q[mode.mode], v[mode.mode]);
}

// Modes far faster than their loads follow these: their motion is the steady response and a free vibration, whose
// sqrt(v^2 + omega^2 q^2) does not grow.
void DerivativeBounds::find_beside_steady(double t, const ArrayXd& q, const ArrayXd& v) {
  const ArrayXd &omega = modal_.frequencies(), squares = omega.square(), decay = 2.0 * modal_.decay();
  ArrayXd free_q = q, free_v = v;
  std::array<ArrayXd, 7> steady;
  for (ArrayXd& bound : steady) bound.setZero(modal_.size());
  for (const dynamics::ModalHarmonic& load : modal_.harmonics()) {
    const double turn = load.angular_frequency, cosine = std::cos(turn * t), sine = std::sin(turn * t);
    const ArrayXd real = squares - turn * turn, imaginary = decay * turn, size = real.square() + imaginary.square(),
                  a = (load.cosine * real - load.sine * imaginary) / size,
                  b = (-load.sine * real - load.cosine * imaginary) / size;
    free_q -= a * cosine - b * sine;
    free_v += turn * (a * sine + b * cosine);
    ArrayXd amplitude = (a.square() + b.square()).sqrt();
    for (ArrayXd& bound : steady) {
      bound += amplitude;
      amplitude *= turn;
    }
  }
  const ArrayXd speed = (free_v.square() + squares * free_q.square()).sqrt();
  std::array<ArrayXd, 7> all = {speed / omega, speed, omega * speed + decay * speed};
  for (std::size_t k = 3; k < all.size(); ++k) all[k] = squares * all[k - 2] + decay * all[k - 1];
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k] += steady[k];
    of_[k] = all[k].isFinite().select(of_[k].min(all[k]), of_[k]);
  }
}

// The equation bounds the derivatives of an overdamped mode by powers of its fast rate, although hardly anything moves
// at that rate. Its motion is the steady response to harmonic loads, the polynomial response to parabolas, and
// exponentials of both rates.
void DerivativeBounds::find(Overdamped& mode, double t, double h, double q, double v) {
  const Index i = mode.mode;
  const double square = modal_.frequencies()[i] * modal_.frequencies()[i], damping = 2.0 * modal_.decay()[i];
  std::array<double, 7> of{};
  for (const dynamics::ModalHarmonic& load : modal_.harmonics()) {
    const double turn = load.angular_frequency;
    const std::complex<double> steady = std::complex<double>(load.cosine[i], -load.sine[i]) /
                                        std::complex<double>(square - turn * turn, damping * turn),
                               now = steady * std::polar(1.0, turn * t);
    q -= now.real();
    v += turn * now.imag();
    double size = std::abs(steady);
    for (double& bound : of) {
      bound += size;
      size *= turn;
    }
  }
  for (const dynamics::ModalSystem::OtherLoad& other : modal_.other_loads()) {
    const LoadParabola f(*other.in_time, t, t + h);
    const double shape = other.shape[i], bend = 2.0 * f.bend() / (h * h) * shape,
                 slope = (4.0 * f.middle - 3.0 * f.begin - f.end) / h * shape;
    const double led2 = bend / square, led1 = (slope - 2.0 * damping * led2) / square,
                 led0 = (f.begin * shape - 2.0 * led2 - damping * led1) / square;
    q -= led0;
    v -= led1;
    of[0] += std::abs(led0) + h * (std::abs(led1) + h * std::abs(led2));
    of[1] += std::abs(led1) + 2.0 * h * std::abs(led2);
    of[2] += 2.0 * std::abs(led2);
  }
  double slow = std::abs((v - mode.fast * q) / (mode.slow - mode.fast));
  mode.of_fast = std::abs((mode.slow * q - v) / (mode.slow - mode.fast));
  for (std::size_t k = 0; k < of_.size(); ++k) {
    of_[k][i] = of[k] + slow;
    slow *= -mode.slow;
  }
}

void DerivativeBounds::departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out) {
  const std::size_t breakpoint = breakpoints_.before(begin);
  find(breakpoint);
  const double h = end - begin, since = begin - breakpoints_.time(breakpoint);
  const QuinticError error = quintic_error(h, 1.0);
  const auto& of = of_;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const auto shape = modal_.shape_rows().col(dofs[i]).array().abs();
    if (!out.x.empty())
      out.x[i] = (shape * (error.x * of[6]).min(2.0 * of[0] + 0.4 * h * of[1] + 0.035 * h * h * of[2])).sum();
    if (!out.v.empty()) out.v[i] = (shape * (error.v * of[6]).min(5.0 * of[1] + 0.3 * h * of[2])).sum();
    if (!out.a.empty()) out.a[i] = (shape * (error.a * of[6]).min(18.0 / h * of[1] + 3.0 * of[2])).sum();
    for (const Overdamped& mode : overdamped_) {
      if (mode.fast * since < kForgotten) continue;
      const double rate = -mode.fast, square = rate * rate,
                   size = shape[mode.mode] * mode.of_fast * std::exp(-rate * since);
      const Departure fast(h, size, rate * size, square * size, square * square * square * size);
      if (!out.x.empty()) out.x[i] += fast.x;
      if (!out.v.empty()) out.v[i] += fast.v;
      if (!out.a.empty()) out.a[i] += fast.a;
    }
  }
}

}  // namespace butee::integrators
