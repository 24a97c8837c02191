#include "integrators/exponential/derivative_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "butee/dynamics/load_parabola.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

using Eigen::ArrayXd;

namespace {

using OfModes = std::array<ArrayXd, 7>;

/// Nearer to critical damping, with |delta^2 - omega^2| below this part of omega^2, both rates are about the same.
constexpr double kCritical = 1e-2;
/// The decay of free motion is that at the beginning of one of so many equal pieces of a step.
constexpr double kPieces = 64.0;
/// Lengths that differ by less than this part are the same.
constexpr double kSameLength = 1e-6;

// The departures from a quintic over h of motion whose derivatives are at most of[0], of[1], of[2] and of[6]. The sums
// of the Hermite functions and of their derivatives also bound the difference from a quintic.

ArrayXd departure_of_x(double h, const OfModes& of) {
  return (quintic_error(h, 1.0).x * of[6]).min(2.0 * of[0] + 0.4 * h * of[1] + 0.035 * h * h * of[2]);
}

ArrayXd departure_of_v(double h, const OfModes& of) {
  return (quintic_error(h, 1.0).v * of[6]).min(5.0 * of[1] + 0.3 * h * of[2]);
}

ArrayXd departure_of_a(double h, const OfModes& of) {
  return (quintic_error(h, 1.0).a * of[6]).min(18.0 / h * of[1] + 3.0 * of[2]);
}

}  // namespace

DerivativeBounds::DerivativeBounds(const dynamics::ModalSystem& modal, const Breakpoints& breakpoints)
    : modal_(modal), breakpoints_(breakpoints) {
  for (OfModes* bounds : {&by_energy_, &forced_, &of_, &of_fast_})
    for (ArrayXd& bound : *bounds) bound.setZero(modal.size());
  for (Decaying* part : {&free_, &fast_})
    for (ArrayXd* of : {&part->amplitude, &part->rate, &part->decay}) of->setZero(modal.size());
}

// Without contact only its load adds energy to a mode: sqrt(v^2 + omega^2 q^2) grows by at most the
// integral of |f|. Higher derivatives follow from q'' = f - omega^2 q - 2 delta q'.
void DerivativeBounds::find(std::size_t breakpoint) {
  if (known_ == breakpoint) return;
  known_ = breakpoint;
  since_ = -1.0;
  const double t = breakpoints_.time(breakpoint), h = longest_ = breakpoints_.time(breakpoint + 1) - t;
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
    const dynamics::LoadParabola f(*other.in_time, t, t + h);
    const double bend = 4.0 * std::abs(f.bend());
    load[0] += f.largest() * other.shape.abs();
    load[1] += (std::abs(f.end - f.begin) + bend) / h * other.shape.abs();
    load[2] += bend / (h * h) * other.shape.abs();
  }
  const ArrayXd &omega = modal_.frequencies(), squares = omega.square();
  const ArrayXd decay = 2.0 * modal_.decay();
  const Eigen::Map<const ArrayXd> q(breakpoints_.q(breakpoint), modal_.size()),
      v(breakpoints_.v(breakpoint), modal_.size());
  OfModes& of = by_energy_;
  of[1] = (v.square() + squares * q.square()).sqrt() + h * load[0];
  of[0] = (omega * h > 1.0).select(of[1] / omega, q.abs() + h * of[1]);
  of[2] = load[0] + omega * (omega * of[0]).min(of[1]) + decay * of[1];
  for (std::size_t k = 3; k < of.size(); ++k) of[k] = load[k - 2] + squares * of[k - 2] + decay * of[k - 1];
  for (Index i = 0; i < modal_.size(); ++i) find(i, t, h, q[i], v[i]);
}

// Loads do little work on a mode that is far faster, and a damped mode forgets its start: its motion is the steady
// response to harmonic loads, the polynomial response to parabolas, and free motion.
void DerivativeBounds::find(Index i, double t, double h, double q, double v) {
  const double omega = modal_.frequencies()[i], delta = modal_.decay()[i], square = omega * omega;
  std::array<double, 7> forced{};
  for (const dynamics::ModalHarmonic& load : modal_.harmonics()) {
    const double turn = load.angular_frequency;
    const std::complex<double> steady = std::complex<double>(load.cosine[i], -load.sine[i]) /
                                        std::complex<double>(square - turn * turn, 2.0 * delta * turn),
                               now = steady * std::polar(1.0, turn * t);
    q -= now.real();
    v += turn * now.imag();
    double size = std::abs(steady);
    for (double& bound : forced) {
      bound += size;
      size *= turn;
    }
  }
  for (const dynamics::ModalSystem::OtherLoad& other : modal_.other_loads()) {
    const dynamics::LoadParabola f(*other.in_time, t, t + h);
    const double shape = other.shape[i], bend = 2.0 * f.bend() / (h * h) * shape,
                 slope = (4.0 * f.middle - 3.0 * f.begin - f.end) / h * shape;
    const double led2 = bend / square, led1 = (slope - 4.0 * delta * led2) / square,
                 led0 = (f.begin * shape - 2.0 * led2 - 2.0 * delta * led1) / square;
    q -= led0;
    v -= led1;
    forced[0] += std::abs(led0) + h * (std::abs(led1) + h * std::abs(led2));
    forced[1] += std::abs(led1) + 2.0 * h * std::abs(led2);
    forced[2] += 2.0 * std::abs(led2);
  }
  const auto set = [i](Decaying& part, double amplitude, double rate, double decay) {
    part.amplitude[i] = amplitude;
    part.rate[i] = rate;
    part.decay[i] = decay;
  };
  set(fast_, 0.0, 0.0, 0.0);
  if (const double over = delta * delta - square; over < -kCritical * square) {
    set(free_, std::hypot(q, (v + delta * q) / std::sqrt(-over)), omega, delta);
  } else if (over < kCritical * square) {
    // q(s) is at most (|q| + |v + delta q| s) e^(-(delta - kappa) s) with kappa <= delta/10; each derivative adds at
    // most 1/delta to s, and s e^(-0.5 delta s) <= 2/(e delta).
    set(free_, std::abs(q) + 7.0 * std::abs(v + delta * q) / delta, 1.1 * delta, 0.4 * delta);
  } else {
    const double fast = delta + std::sqrt(over), slow = square / fast;
    set(free_, std::abs((v + fast * q) / (fast - slow)), slow, slow);
    set(fast_, std::abs((v + slow * q) / (fast - slow)), fast, fast);
  }
  const bool is_known = std::isfinite(forced[6]) && std::isfinite(free_.amplitude[i] + fast_.amplitude[i]);
  for (std::size_t k = 0; k < forced.size(); ++k)
    forced_[k][i] = is_known ? forced[k] : std::numeric_limits<double>::infinity();
  if (!is_known) {
    set(free_, 0.0, 0.0, 0.0);
    set(fast_, 0.0, 0.0, 0.0);
  }
}

void DerivativeBounds::find_bounds(double since) {
  for (std::vector<ArrayXd>& known : departures_) known.clear();
  const auto raise = [since](const Decaying& part, OfModes& of) {
    ArrayXd size = part.amplitude * (-since * part.decay).exp();
    for (ArrayXd& bound : of) {
      bound += size;
      size *= part.rate;
    }
  };
  of_ = forced_;
  raise(free_, of_);
  for (ArrayXd& bound : of_fast_) bound.setZero();
  raise(fast_, of_fast_);
}

ArrayXd DerivativeBounds::find_of_modes(std::size_t order, double h) const {
  const auto departure_of = std::array{departure_of_x, departure_of_v, departure_of_a}[order];
  return (departure_of(h, of_) + departure_of(h, of_fast_)).min(departure_of(h, by_energy_));
}

const ArrayXd& DerivativeBounds::of_modes(std::size_t order, double h) {
  const double halvings = std::round(std::log2(longest_ / h));
  if (!(halvings >= 0.0) || std::abs(std::exp2(halvings) * h - longest_) > kSameLength * longest_)
    return of_other_ = find_of_modes(order, h);
  std::vector<ArrayXd>& known = departures_[order];
  const auto place = static_cast<std::size_t>(halvings);
  if (known.size() <= place) known.resize(place + 1);
  if (known[place].size() == 0)
    known[place] = find_of_modes(order, (1.0 + kSameLength) * std::ldexp(longest_, -static_cast<int>(place)));
  return known[place];
}

void DerivativeBounds::departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out) {
  const std::size_t breakpoint = breakpoints_.before(begin);
  find(breakpoint);
  const double t = breakpoints_.time(breakpoint),
               since = std::floor((begin - t) / longest_ * kPieces) / kPieces * longest_;
  if (since != since_) find_bounds(since_ = since);
  const std::array<std::span<double>, 3> wanted = {out.x, out.v, out.a};
  for (std::size_t order = 0; order < wanted.size(); ++order) {
    if (wanted[order].empty()) continue;
    const ArrayXd& of_mode = of_modes(order, end - begin);
    for (std::size_t i = 0; i < dofs.size(); ++i)
      wanted[order][i] = (modal_.shape_rows().col(dofs[i]).array().abs() * of_mode).sum();
  }
}

}  // namespace butee::integrators
