#include "integrators/exponential/modal_response.hpp"

#include <cmath>
#include <complex>

namespace butee::integrators {
namespace {

using Complex = std::complex<double>;

constexpr int kPowers = static_cast<int>(StepNodes::kCount);
/// Largest |lambda c h| for which the series is used, and its number of terms; the last term is
/// below rounding there.
constexpr double kSmall = 7.0;
constexpr int kMostTerms = 34;
constexpr double kRounding = 1e-18;

/// (e^w - 1)/w for |w| <= 1/2.
Complex phi(Complex w) {
  Complex sum = 1.0, term = 1.0;
  for (int k = 2; k < 18; ++k) sum += term *= w / static_cast<double>(k);
  return sum;
}

}  // namespace

PlaceResponse::PlaceResponse(const dynamics::DampedModes& modes, const std::vector<TurningLoad>& loads, double place,
                             double h, Index first, Index last)
    : first_(first), count_(modes.count()) {
  const Index rest = last - first;
  const double length = place * h;
  propagator_.resize(rest, 2);
  const auto decay = modes.decay().segment(first, rest), turn = modes.turn().segment(first, rest);
  modes.turn_by(length, first, propagator_.col(0), propagator_.col(1));
  find_moments(decay, turn, modes.speed().segment(first, rest), place, h);
  for (const TurningLoad& load : loads) add_harmonics(decay, turn, load, length);
}

void PlaceResponse::find_moments(ConstArrayRef decay, ConstArrayRef turn, ConstArrayRef speed, double place, double h) {
  const Index p = decay.size();
  moments_.resize(p, 2 * kPowers);
  std::array<double, kPowers + 1> power{};  // h c^r
  power[0] = h;
  for (std::size_t r = 1; r < power.size(); ++r) power[r] = power[r - 1] * place;
  Index slow = 0;
  while (slow < p && speed[slow] * place * h <= kSmall) ++slow;
  // With w = lambda c h: moment_r = h c^(r+1) sum_k w^k r!/(r+k+1)!, here for the highest r.
  constexpr int top = kPowers - 1;
  // A few modes at a time stay in registers and take the terms that the fastest of them needs.
  const auto sum_series = [&](Index k, auto size) {
    constexpr int kSize = decltype(size)::value;
    using Part = Eigen::Array<double, kSize, 1>;
    const Part dr = h * decay.segment<kSize>(k), di = h * turn.segment<kSize>(k), wr = place * dr, wi = place * di;
    Part tr = Part::Constant(power[kPowers] / kPowers), ti = Part::Zero(), sr = tr, si = ti;
    const double largest = speed[k + kSize - 1] * place * h;
    double bound = 1.0;
    for (int n = 1; n < kMostTerms && bound > kRounding; ++n) {
      const double factor = 1.0 / (top + n + 1);
      bound *= largest * factor;
      const Part re = factor * (tr * wr - ti * wi);
      ti = factor * (tr * wi + ti * wr);
      tr = re;
      sr += tr;
      si += ti;
    }
    // moment_(r-1) = (lambda h moment_r + h c^r)/r
    for (int r = top; r >= 0; --r) {
      moments_.col(2 * r).segment<kSize>(k) = sr;
      moments_.col(2 * r + 1).segment<kSize>(k) = si;
      if (r == 0) break;
      const Part re = (dr * sr - di * si + power[static_cast<std::size_t>(r)]) / r;
      si = (dr * si + di * sr) / r;
      sr = re;
    }
  };
  constexpr Index kTogether = 8;
  Index k = 0;
  for (; k + kTogether <= slow; k += kTogether) sum_series(k, std::integral_constant<int, kTogether>());
  if (slow >= kTogether && k < slow)
    sum_series(slow - kTogether, std::integral_constant<int, kTogether>());
  else
    for (; k < slow; ++k) sum_series(k, std::integral_constant<int, 1>());
  if (slow == p) return;
  // moment_r = (r moment_(r-1) - h c^r)/(lambda h), from moment_0 = h (e^w - 1)/(lambda h)
  const Index fast = p - slow;
  const Eigen::ArrayXd dr = decay.tail(fast) * h, di = turn.tail(fast) * h, square = dr.square() + di.square(),
                       on_dr = dr / square, on_di = di / square;
  Eigen::ArrayXd re = h * (propagator_.col(0).tail(fast) - 1.0), im = h * propagator_.col(1).tail(fast);
  for (int r = 0; r < kPowers; ++r) {
    if (r > 0) {
      re = r * moments_.col(2 * r - 2).tail(fast) - power[static_cast<std::size_t>(r)];
      im = r * moments_.col(2 * r - 1).tail(fast);
    }
    moments_.col(2 * r).tail(fast) = re * on_dr + im * on_di;
    moments_.col(2 * r + 1).tail(fast) = im * on_dr - re * on_di;
  }
}

void PlaceResponse::add_harmonics(ConstArrayRef decay, ConstArrayRef turn, const TurningLoad& load, double length) {
  const Index p = decay.size();
  Harmonic& harmonic = harmonics_.emplace_back();
  harmonic.angular_frequency = load.angular_frequency;
  const double c = std::cos(load.angular_frequency * length), s = std::sin(load.angular_frequency * length);
  for (const double sense : {1.0, -1.0}) {
    const Eigen::VectorXd& force = sense > 0.0 ? load.forth : load.back;
    Eigen::VectorXd& out = sense > 0.0 ? harmonic.forth : harmonic.back;
    out.resize(2 * p);
    const double *const of_re = force.data() + first_, *const of_im = of_re + count_;
    const double *const pr = propagator_.col(0).data(), *const pi = propagator_.col(1).data();
    double *const out_re = out.data(), *const out_im = out_re + p;
    // w = (i Omega - lambda) length: (e^(i Omega length) - e^(lambda length)) length/w
    const auto w = [&](Index k) {
      return Complex(-decay[k] * length, (sense * load.angular_frequency - turn[k]) * length);
    };
    for (Index k = 0; k < p; ++k) {
      const double wr = w(k).real(), wi = w(k).imag(), factor = length / (wr * wr + wi * wi), dr = c - pr[k],
                   di = sense * s - pi[k], re = factor * (dr * wr + di * wi), im = factor * (di * wr - dr * wi);
      out_re[k] = re * of_re[k] - im * of_im[k];
      out_im[k] = re * of_im[k] + im * of_re[k];
    }
    // For small w this cancels; then e^(lambda length) length phi(w).
    for (Index k = 0; k < p; ++k) {
      if (std::norm(w(k)) > 0.25) continue;
      const Complex part = Complex(pr[k], pi[k]) * length * phi(w(k)) * Complex(of_re[k], of_im[k]);
      out[k] = part.real();
      out[p + k] = part.imag();
    }
  }
}

void PlaceResponse::move(double t, const double* z, const double* g, Eigen::Ref<Eigen::VectorXd> out) const {
  const Index rest = propagator_.rows();
  const Eigen::Map<const Eigen::ArrayXd> zr(z + first_, rest), zi(z + count_ + first_, rest);
  auto re = out.segment(first_, rest), im = out.segment(count_ + first_, rest);
  re.array() = propagator_.col(0) * zr - propagator_.col(1) * zi;
  im.array() = propagator_.col(0) * zi + propagator_.col(1) * zr;
  for (const Harmonic& load : harmonics_) {
    const double c = std::cos(load.angular_frequency * t), s = std::sin(load.angular_frequency * t);
    re += c * (load.forth.head(rest) + load.back.head(rest)) - s * (load.forth.tail(rest) - load.back.tail(rest));
    im += c * (load.forth.tail(rest) + load.back.tail(rest)) + s * (load.forth.head(rest) - load.back.head(rest));
  }
  if (g != nullptr) add_force(g, out);
}

void PlaceResponse::add_force(const double* g, Eigen::Ref<Eigen::VectorXd> out) const {
  const Index rest = propagator_.rows();
  double* const re = out.data() + first_;
  double* const im = re + count_;
  // Sums of a few modes at a time stay in registers.
  const auto add = [&](Index k, auto size) {
    using Part = Eigen::Array<double, decltype(size)::value, 1>;
    Eigen::Map<Part> to_re(re + k), to_im(im + k);
    Part sum_re = to_re, sum_im = to_im;
    for (Index r = 0; r < kPowers; ++r) {
      const double* const gr = g + 2 * count_ * r + first_ + k;
      const Eigen::Map<const Part> of_re(gr), of_im(gr + count_), mr(moments_.col(2 * r).data() + k),
          mi(moments_.col(2 * r + 1).data() + k);
      sum_re += mr * of_re - mi * of_im;
      sum_im += mr * of_im + mi * of_re;
    }
    to_re = sum_re;
    to_im = sum_im;
  };
  constexpr Index kTogether = 16;
  Index k = 0;
  for (; k + kTogether <= rest; k += kTogether) add(k, std::integral_constant<int, kTogether>());
  for (; k < rest; ++k) add(k, std::integral_constant<int, 1>());
}

bool FastMotion::begin(double t, double h, const double* z, const double* g, Index first,
                       const Eigen::ArrayXd& silent) {
  const Index p = modes_.count(), rest = p - first, loads = static_cast<Index>(loads_.size());
  const auto complex = [&](const double* numbers) {
    const Eigen::Map<const Eigen::ArrayXd> re(numbers + first, rest), im(numbers + p + first, rest);
    Eigen::ArrayXcd all(rest);
    all.real() = re;
    all.imag() = im;
    return all;
  };
  Eigen::ArrayXcd lambda(rest);
  lambda.real() = modes_.decay().tail(rest);
  lambda.imag() = modes_.turn().tail(rest);
  t_ = t;
  h_ = h;
  first_ = first;
  polynomial_.resize(rest, kPowers);
  for (Index r = kPowers - 1; r >= 0; --r) {
    polynomial_.col(r) = -complex(g + 2 * p * r) / lambda;
    if (r < kPowers - 1) polynomial_.col(r) += (static_cast<double>(r + 1) / h) * polynomial_.col(r + 1) / lambda;
  }
  silent_ = silent.tail(rest);
  free_ = complex(z) - polynomial_.col(0);
  forth_.resize(rest, loads);
  back_.resize(rest, loads);
  for (Index j = 0; j < loads; ++j) {
    const TurningLoad& load = loads_[static_cast<std::size_t>(j)];
    const Complex turn(0.0, load.angular_frequency), phase = std::exp(turn * t);
    if (((turn - lambda).abs() * h < kResonant).any() || ((turn + lambda).abs() * h < kResonant).any()) return false;
    forth_.col(j) = complex(load.forth.data()) / (turn - lambda);
    back_.col(j) = -complex(load.back.data()) / (turn + lambda);
    free_ -= forth_.col(j) * phase + back_.col(j) * std::conj(phase);
  }
  return true;
}

void FastMotion::move(double place, Eigen::VectorXd& z) const {
  const Index p = modes_.count(), rest = p - first_;
  const double length = place * h_;
  Eigen::ArrayXcd sum = polynomial_.col(kPowers - 1);
  for (Index r = kPowers - 2; r >= 0; --r) sum = sum * place + polynomial_.col(r);
  for (Index j = 0; j < forth_.cols(); ++j) {
    const Complex phase = std::polar(1.0, loads_[static_cast<std::size_t>(j)].angular_frequency * (t_ + length));
    sum += forth_.col(j) * phase + back_.col(j) * std::conj(phase);
  }
  const auto decay = modes_.decay().tail(rest), turn = modes_.turn().tail(rest);
  for (Index k = 0; k < rest; ++k) {
    const double largest = std::abs(free_[k].real()) + std::abs(free_[k].imag());
    if (largest < silent_[k]) continue;
    const double size = std::exp(decay[k] * length);
    if (largest * size >= silent_[k]) sum[k] += free_[k] * std::polar(size, turn[k] * length);
  }
  z.segment(first_, rest) = sum.real();
  z.tail(rest) = sum.imag();
}

StepResponse::StepResponse(const dynamics::DampedModes& modes, const std::vector<TurningLoad>& loads, double h)
    : h_(h) {
  for (Index j = 1; j < StepNodes::kCount; ++j)
    places_.emplace_back(modes, loads, StepNodes::kPlaces[static_cast<std::size_t>(j)], h);
}

void StepResponse::move(double t, const double* z, const double* g, Eigen::MatrixXd& nodes) const {
  nodes.col(0) = Eigen::Map<const Eigen::VectorXd>(z, nodes.rows());
  for (std::size_t j = 0; j < places_.size(); ++j) places_[j].move(t, z, g, nodes.col(static_cast<Index>(j) + 1));
}

void StepResponse::add_force(const double* g, Eigen::MatrixXd& nodes) const {
  for (std::size_t j = 0; j < places_.size(); ++j) places_[j].add_force(g, nodes.col(static_cast<Index>(j) + 1));
}

}  // namespace butee::integrators
