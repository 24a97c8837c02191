#include "integrators/exponential/modal_response.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <type_traits>

namespace butee::integrators {
namespace {

using Complex = std::complex<double>;
using Series = ResponseSeries;

constexpr int kPowers = Series::kPowers;

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
  while (slow < p && speed[slow] * place * h <= Series::kSmall) ++slow;
  // A few modes at a time stay in registers and take the terms that the fastest of them needs.
  const auto sum_series = [&](Index k, auto size) {
    constexpr int kSize = decltype(size)::value;
    using Part = Eigen::Array<double, kSize, 1>;
    const Part dr = h * decay.segment<kSize>(k), di = h * turn.segment<kSize>(k), wr = place * dr, wi = place * di;
    std::array<Part, kPowers + 1> powers;
    for (std::size_t r = 0; r < powers.size(); ++r) powers[r].setConstant(power[r]);
    Series::moments(dr, di, wr, wi, powers, speed[k + kSize - 1] * place * h,
                    [this, k](int r, const Part& re, const Part& im) {
                      moments_.col(2 * r).segment<kSize>(k) = re;
                      moments_.col(2 * r + 1).segment<kSize>(k) = im;
                    });
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
      if (std::norm(w(k)) > Series::kNearResonance) continue;
      using One = Eigen::Array<double, 1, 1>;
      const auto [sum_re, sum_im] = Series::phi(One(w(k).real()), One(w(k).imag()));
      const Complex part = Complex(pr[k], pi[k]) * length * Complex(sum_re[0], sum_im[0]) * Complex(of_re[k], of_im[k]);
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

}  // namespace butee::integrators
