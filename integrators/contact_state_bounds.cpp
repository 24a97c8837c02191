#include <algorithm>
#include <cmath>

#include "integrators/contact_state_flow.hpp"

namespace butee::integrators {
namespace {

using Complex = std::complex<double>;

/// Number of terms of a power series with argument at most 1 for accuracy to rounding.
constexpr int kBoundTerms = 22;

/// e^z - 1 without cancellation.
Complex expm1(Complex z) {
  const double half = std::sin(0.5 * z.imag());
  return {std::expm1(z.real()) * std::cos(z.imag()) - 2.0 * half * half, std::exp(z.real()) * std::sin(z.imag())};
}

/// The response from rest of z' = lambda z + e^(i omega s), with three derivatives.
std::array<Complex, 4> response(Complex lambda, double omega, double s) {
  const Complex turn(0.0, omega), apart = turn - lambda, load = std::exp(turn * s);
  const Complex ratio = apart == Complex(0.0) ? Complex(s) : expm1(apart * s) / apart;
  std::array<Complex, 4> z;
  z[0] = std::exp(lambda * s) * ratio;
  z[1] = lambda * z[0] + load;
  z[2] = lambda * z[1] + turn * load;
  z[3] = lambda * z[2] + turn * turn * load;
  return z;
}

double power(double base, int k) {
  double product = 1.0;
  while (k-- > 0) product *= base;
  return product;
}

/// The load of one coordinate of a slow block at s, with two derivatives, and its Taylor coefficients from the start of
/// the piece times s^k.
struct SlowLoad {
  std::array<double, 3> now{};
  std::array<double, kBoundTerms + 1> terms{};

  void add_parabola(const double* f, double s) {
    now[0] += f[0] + s * (f[1] + s * f[2]);
    now[1] += f[1] + 2.0 * s * f[2];
    now[2] += 2.0 * f[2];
    for (std::size_t k = 0; k < 3; ++k) terms[k] += f[k] * power(s, static_cast<int>(k));
  }
  /// gc cos + gs sin of omega t; cosine and sine of it at the start.
  void add_harmonic(double omega, double gc, double gs, double cosine, double sine, double s) {
    const double turn = omega * s, c = std::cos(turn) * cosine - std::sin(turn) * sine,
                 w = std::sin(turn) * cosine + std::cos(turn) * sine;
    now[0] += gc * c + gs * w;
    now[1] += omega * (gs * c - gc * w);
    now[2] -= omega * omega * (gc * c + gs * w);
    double even = gc * cosine + gs * sine, odd = gs * cosine - gc * sine;
    for (std::size_t k = 0; k <= kBoundTerms; ++k) {
      terms[k] += even;
      const double step = turn / static_cast<double>(k + 1), next = odd * step;
      odd = -even * step;
      even = next;
    }
  }
};

}  // namespace

void ContactStateFlow::respond_slowly(const Piece& piece, const Block& block, double s, double* extra) const {
  const double* parabola = &piece.forcing[6 * static_cast<std::size_t>(block.extra)];
  const auto place = static_cast<Index>(2 * with_extras_[static_cast<std::size_t>(block.extra)]);
  std::array<SlowLoad, 2> loads{};
  for (Index i = 0; i < 2; ++i) {
    SlowLoad& load = loads[static_cast<std::size_t>(i)];
    if (!block.slow[static_cast<std::size_t>(i)]) continue;
    load.add_parabola(parabola + 3 * i, s);
    for (const Index j : block.resonant) {
      const auto p = static_cast<std::size_t>(2 * j);
      load.add_harmonic(system_.frequencies[static_cast<std::size_t>(j)], harmonic_c_(place + i, j),
                        harmonic_s_(place + i, j), piece.phases[p], piece.phases[p + 1], s);
    }
  }
  if (block.kind == Kind::pair) {
    const Complex lambda(-block.decay, block.frequency), i(0.0, 1.0);
    Complex term, sum;
    for (std::size_t k = 0; k <= kBoundTerms; ++k) {
      term = (lambda * s * term + s * Complex(loads[0].terms[k], loads[1].terms[k])) / static_cast<double>(k + 1);
      sum += term;
    }
    for (int k = 0; k < 4; ++k) {
      extra[k] = sum.real();
      extra[4 + k] = sum.imag();
      if (k < 3) sum = lambda * sum + loads[0].now[k] + i * loads[1].now[k];
    }
    return;
  }
  if (block.kind == Kind::reals) {
    for (std::size_t i = 0; i < 2; ++i) {
      if (!block.slow[i]) continue;
      double term = 0.0, sum = 0.0;
      for (std::size_t k = 0; k <= kBoundTerms; ++k) {
        term = (block.rates[i] * s * term + s * loads[i].terms[k]) / static_cast<double>(k + 1);
        sum += term;
      }
      for (std::size_t k = 0; k < 4; ++k) {
        extra[4 * i + k] = sum;
        if (k < 3) sum = block.rates[i] * sum + loads[i].now[k];
      }
    }
    return;
  }
  const double d = block.decay;
  if (2.0 * d * s > 1.0 && block.square == 0.0) {
    // q' = u_0 + u_1 s + u_2 s^2 - u_0 e^(-2 d s)
    const double r = 0.5 / d, u2 = parabola[2] * r, u1 = (parabola[1] - 2.0 * u2) * r, u0 = (parabola[0] - u1) * r;
    extra[0] = s * (u0 + s * (0.5 * u1 + s * u2 / 3.0)) + u0 * r * std::expm1(-2.0 * d * s);
    extra[1] = s * (u1 + s * u2) - u0 * std::expm1(-2.0 * d * s);
  } else {
    double before = 0.0, latest = 0.0, q = 0.0, v = 0.0;
    for (int k = 0; k + 2 <= kBoundTerms; ++k) {
      const double next = (s * s * loads[0].terms[static_cast<std::size_t>(k)] - (k + 1) * 2.0 * d * s * latest -
                           block.square * s * s * before) /
                          ((k + 1) * (k + 2));
      q += next;
      v += (k + 2) * next;
      before = latest;
      latest = next;
    }
    extra[0] = q;
    extra[1] = s > 0.0 ? v / s : 0.0;
  }
  extra[2] = loads[0].now[0] - 2.0 * d * extra[1] - block.square * extra[0];
  extra[3] = loads[0].now[1] - 2.0 * d * extra[2] - block.square * extra[1];
}

void ContactStateFlow::resonate(const Piece& piece, const Block& block, double s, double* extra) const {
  const auto place = static_cast<Index>(2 * with_extras_[static_cast<std::size_t>(block.extra)]);
  const Complex lambda(-block.decay, block.frequency), i(0.0, 1.0);
  for (const Index j : block.resonant) {
    const double omega = system_.frequencies[static_cast<std::size_t>(j)];
    const Complex phase(piece.phases[static_cast<std::size_t>(2 * j)],
                        piece.phases[static_cast<std::size_t>(2 * j + 1)]);
    const auto with = response(lambda, omega, s);
    if (block.kind == Kind::mode) {
      const auto against = response(std::conj(lambda), omega, s);
      const Complex load = (harmonic_c_(place, j) - i * harmonic_s_(place, j)) * phase / (2.0 * i * block.frequency);
      for (std::size_t k = 0; k < 4; ++k) extra[k] += (load * (with[k] - against[k])).real();
      continue;
    }
    const auto against = response(lambda, -omega, s);
    const Complex gc(harmonic_c_(place, j), harmonic_c_(place + 1, j)),
        gs(harmonic_s_(place, j), harmonic_s_(place + 1, j));
    const Complex ahead = 0.5 * (gc - i * gs) * phase, back = 0.5 * (gc + i * gs) * std::conj(phase);
    for (std::size_t k = 0; k < 4; ++k) {
      const Complex z = ahead * with[k] + back * against[k];
      extra[k] += z.real();
      extra[4 + k] += z.imag();
    }
  }
}

double ContactStateFlow::bound_of(const Block& block, const double* y, int k, double until) const {
  const double d = block.decay;
  if (block.kind == Kind::pair) return std::hypot(y[0], y[1]) * power(block.rate, k);
  if (block.kind == Kind::reals) return std::hypot(y[0] * power(block.rates[0], k), y[1] * power(block.rates[1], k));
  if (block.oscillates()) {
    const double other = (y[1] + d * y[0]) / block.frequency;
    return std::sqrt(y[0] * y[0] + other * other) * power(std::sqrt(block.square), k);
  }
  double here = y[0], next = y[1];
  for (int order = 0; order < k; ++order) {
    const double after = -2.0 * d * next - block.square * here;
    here = next;
    next = after;
  }
  // |C + d S| <= 1 and S <= 1/(2 d) for heavily damped motion; S = s for rigid motion.
  return std::abs(here) + std::abs(next) * (d > 0.0 ? std::min(until, 0.5 / d) : until);
}

double ContactStateFlow::extra_bound(const Piece& piece, const Block& block, int k, double until) const {
  const double* parabola = &piece.forcing[6 * static_cast<std::size_t>(block.extra)];
  const auto place = static_cast<Index>(2 * with_extras_[static_cast<std::size_t>(block.extra)]);
  double sum = 0.0;
  for (Index i = 0; i < 2; ++i) {
    const double* f = parabola + 3 * i;
    const bool is_slow = block.slow[static_cast<std::size_t>(i)];
    // Bounds of the load and of its first two derivatives.
    double load = 0.0, rise = 0.0, bend = 0.0, fastest = 0.0, strength = 0.0;
    if (is_slow) {
      load = std::abs(f[0]) + until * (std::abs(f[1]) + until * std::abs(f[2]));
      rise = std::abs(f[1]) + 2.0 * until * std::abs(f[2]);
      bend = 2.0 * std::abs(f[2]);
    }
    for (const Index j : block.resonant) {
      const double omega = system_.frequencies[static_cast<std::size_t>(j)];
      const double size = std::hypot(harmonic_c_(place + i, j), harmonic_s_(place + i, j));
      load += size;
      rise += size * omega;
      bend += size * omega * omega;
      strength += size;
      fastest = std::max(fastest, omega);
    }
    if (is_slow) {
      // From rest |q| <= s^2/2 max |f| and |q'| <= s max |f|, since damping only removes energy;
      // likewise |z| <= s max |f|.
      const double rate = block.kind == Kind::mode ? std::sqrt(block.square) + 2.0 * block.decay : block.rate;
      const int lifted = block.kind == Kind::mode ? k - 2 : k - 1;
      if (lifted < 0)
        sum += load * (block.kind == Kind::mode && k == 0 ? 0.5 * until * until : until);
      else
        sum +=
            (lifted == 0   ? load
             : lifted == 1 ? rise + load * rate
                           : (bend + rise * rate + load * rate * rate) * power(std::max(rate, fastest), lifted - 2)) +
            (lifted == 0 ? rise * until : 0.0);
      continue;
    }
    if (strength == 0.0 || block.slow[0]) continue;
    const double rate = std::max(block.rate, fastest), most = std::max(until, 2.0 / rate);
    const double response = 2.0 * strength * (power(rate, k) * most + (k > 0 ? k * power(rate, k - 1) : 0.0));
    sum += block.kind == Kind::mode ? response / (2.0 * block.frequency) : response;
  }
  return sum;
}

std::array<double, 5> ContactStateFlow::stop_bounds(const Piece& piece, Index i, double until) const {
  std::array<double, 5> bounds{};
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const double size = stops_.size(i, static_cast<Index>(b));
    if (size == 0.0) continue;
    if (block.oscillates()) {
      double bound = size * bound_of(block, &piece.y[2 * b], 0, until);
      const double rate = block.kind == Kind::pair ? block.rate : std::sqrt(block.square);
      for (double& each : bounds) {
        each += bound;
        bound *= rate;
      }
    } else {
      for (int k = 0; k < 5; ++k)
        bounds[static_cast<std::size_t>(k)] += size * bound_of(block, &piece.y[2 * b], k, until);
    }
    if (block.extra >= 0)
      for (int k = 0; k < 5; ++k) bounds[static_cast<std::size_t>(k)] += size * extra_bound(piece, block, k, until);
  }
  for (std::size_t j = 0; j < system_.frequencies.size(); ++j) {
    double swing = stops_.swing(i, static_cast<Index>(j));
    for (double& each : bounds) {
      each += swing;
      swing *= system_.frequencies[j];
    }
  }
  const LinearStop& stop = system_.stops[static_cast<std::size_t>(i)];
  if (piece.is_short) {
    const double s = std::min((piece.s + until) / piece.length, 1.0);
    for (Index k = 0; k < piece.series.cols(); ++k) {
      double term =
          std::abs((stop.a >= 0 ? piece.series(stop.a, k) : 0.0) - (stop.b >= 0 ? piece.series(stop.b, k) : 0.0));
      for (int order = 0; order < 5 && order <= k; ++order) {
        bounds[static_cast<std::size_t>(order)] += term * power(s, static_cast<int>(k) - order);
        term *= static_cast<double>(k - order) / piece.length;
      }
    }
  }
  if (!piece.has_parabola) return bounds;
  std::array<double, 3> p{};
  for (Index k = 0; k < 3; ++k)
    p[static_cast<std::size_t>(k)] =
        std::abs((stop.a >= 0 ? piece.parabola(stop.a, k) : 0.0) - (stop.b >= 0 ? piece.parabola(stop.b, k) : 0.0));
  bounds[0] += p[0] + until * (p[1] + until * p[2]);
  bounds[1] += p[1] + 2.0 * until * p[2];
  bounds[2] += 2.0 * p[2];
  return bounds;
}

double ContactStateFlow::rate(const Piece& piece) const {
  constexpr double kUnseen = 1e-9;
  double largest = 0.0, fastest = 0.0;
  for (int look = 0; look < 2; ++look) {
    const auto take = [&](double speed, double rate) {
      if (look == 0)
        largest = std::max(largest, speed);
      else if (speed > kUnseen * largest)
        fastest = std::max(fastest, rate);
    };
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      take(dofs_.size.col(static_cast<Index>(b)).maxCoeff() * bound_of(blocks_[b], &piece.y[2 * b], 1, 0.0),
           blocks_[b].rate);
    for (std::size_t j = 0; j < system_.frequencies.size(); ++j)
      take(dofs_.swing.col(static_cast<Index>(j)).maxCoeff() * system_.frequencies[j], system_.frequencies[j]);
    for (const std::size_t b : with_extras_)
      for (const Index j : blocks_[b].resonant) take(largest, system_.frequencies[static_cast<std::size_t>(j)]);
  }
  return fastest;
}

double ContactStateFlow::sixth_derivative(const Piece& piece, Index i, double until) const {
  double sum = 0.0;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const double size = dofs_.size(i, static_cast<Index>(b));
    sum += size * bound_of(block, &piece.y[2 * b], 6, until);
    if (block.extra >= 0) sum += size * extra_bound(piece, block, 6, until);
  }
  if (piece.is_short)
    for (Index k = 6; k < piece.series.cols(); ++k)
      sum += std::abs(piece.series(i, k)) * power(static_cast<double>(k) / piece.length, 6);
  for (std::size_t j = 0; j < system_.frequencies.size(); ++j)
    sum += dofs_.swing(i, static_cast<Index>(j)) * power(system_.frequencies[j], 6);
  return sum;
}

}  // namespace butee::integrators
