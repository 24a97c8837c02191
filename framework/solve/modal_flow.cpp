#include "butee/solve/modal_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "butee/core/error.hpp"
#include "butee/solve/lanes.hpp"

namespace butee::solve {
namespace {

using Eigen::ArrayXd;

/// Of the series: with (omega + delta + Omega) h up to kShort the first term left out is below rounding.
constexpr int kTerms = 16;
constexpr double kShort = 0.5;

/// (k + 1)(k + 2) in reciprocal.
constexpr auto kDivisors = [] {
  std::array<double, kTerms> all{};
  for (int k = 0; k < kTerms; ++k) all[static_cast<std::size_t>(k)] = 1.0 / static_cast<double>((k + 1) * (k + 2));
  return all;
}();

using Series = std::array<Lane, kTerms>;

/// Of eight modes at once.
struct Response {
  Lane q{}, v{};
};

/// y(h) and y'(h) of y'' + 2 delta y' + omega^2 y = sum over k of c_k (t/h)^k, at rest at t = 0; damping = 2 delta h,
/// stiffness = omega^2 h^2; `last` is the last k with c_k != 0.
void series_at_end(const Lane& damping, const Lane& stiffness, double h, const Series& forcing, int last,
                   Response& sum) {
  Lane before{}, latest{};  // y_k, y_{k+1}
  sum = {};
  for (int k = 0; k + 2 <= kTerms; ++k) {
    const auto order = static_cast<std::size_t>(k);
    Lane next = -damping * latest * static_cast<double>(k + 1) - stiffness * before;
    if (k <= last) next += h * h * forcing[order];
    next *= kDivisors[order];
    sum.q += next;
    sum.v += static_cast<double>(k + 2) * next;
    before = latest;
    latest = next;
  }
  sum.v *= 1.0 / h;
}

void take(const ArrayXd& from, Index begin, Lane& to) {
  to = Lane{};
  for (Index i = begin; i < std::min(begin + kLaneSize, from.size()); ++i) to[i - begin] = from[i];
}

}  // namespace

double ModalFlow::longest_series(const ArrayXd& omega, const ArrayXd& delta, const std::vector<ModalHarmonic>& all) {
  double fastest = (omega + delta).maxCoeff();
  for (const ModalHarmonic& harmonic : all) fastest = std::max(fastest, harmonic.angular_frequency);
  return kShort / fastest;
}

ModalFlow::ModalFlow(const ArrayXd& omega, const ArrayXd& delta, const std::vector<ModalHarmonic>& harmonics, double h)
    : h_(h) {
  require(h > 0.0 && omega.size() > 0, "a flow takes modes over a positive time");
  for (const ModalHarmonic& harmonic : harmonics) angular_frequencies_.push_back(harmonic.angular_frequency);
  const double longest = longest_series(omega, delta, harmonics);
  int doublings = 0;
  while (h_ > longest) {
    h_ *= 0.5;
    ++doublings;
  }
  start_by_series(omega, delta, harmonics);
  for (int i = 0; i < doublings; ++i) *this = doubled();
}

void ModalFlow::start_by_series(const ArrayXd& omega, const ArrayXd& delta, const std::vector<ModalHarmonic>& all) {
  columns_.resize(omega.size(), harmonic_column(all.size()));
  std::vector<std::array<std::complex<double>, kTerms>> turns;  // of e^(i Omega t)
  for (const ModalHarmonic& harmonic : all) {
    auto& turn = turns.emplace_back();
    turn[0] = 1.0;
    for (std::size_t k = 1; k < kTerms; ++k)
      turn[k] = turn[k - 1] * std::complex<double>(0.0, harmonic.angular_frequency * h_ / static_cast<double>(k));
  }
  constexpr Lane kOne = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  for (Index begin = 0; begin < omega.size(); begin += kLaneSize) {
    const Index count = std::min(kLaneSize, omega.size() - begin);
    Lane frequency, decay;
    take(omega, begin, frequency);
    take(delta, begin, decay);
    const Lane square = frequency * frequency, damping = 2.0 * h_ * decay, stiffness = h_ * h_ * square;
    Series forcing{};
    const auto solve = [&](int last, Response& to) { series_at_end(damping, stiffness, h_, forcing, last, to); };
    const auto put = [&](Index column, const Lane& values) {
      for (Index i = 0; i < count; ++i) columns_(begin + i, column) = values[i];
    };
    // Free motion by its departure from q = 1 at rest, and from a straight line with v = 1.
    Response from_q, from_v;
    forcing[0] = -square;
    solve(0, from_q);
    forcing[0] = -2.0 * decay;
    forcing[1] = -square * h_;
    solve(1, from_v);
    put(0, kOne + from_q.q);
    put(1, h_ * kOne + from_v.q);
    put(2, from_q.v);
    put(3, kOne + from_v.v);

    std::array<Response, 3> power;
    for (std::size_t k = 0; k < 3; ++k) {
      forcing = {};
      forcing[k] = kOne;
      solve(static_cast<int>(k), power[k]);
    }
    const auto put_force = [&](Index column, const Lane& p0, const Lane& p1, const Lane& p2) {
      put(column, p0);
      put(column + 2, 2.0 * p1 - p0);
      put(column + 4, 6.0 * p2 - 6.0 * p1 + p0);
    };
    put_force(kForce, power[0].q, power[1].q, power[2].q);
    put_force(kForce + 1, power[0].v, power[1].v, power[2].v);

    for (std::size_t j = 0; j < all.size(); ++j) {
      // cosine - i sine, turned.
      Lane cosine, sine;
      take(all[j].cosine, begin, cosine);
      take(all[j].sine, begin, sine);
      Response real, imaginary;
      for (std::size_t k = 0; k < kTerms; ++k) forcing[k] = turns[j][k].real() * cosine + turns[j][k].imag() * sine;
      solve(kTerms, real);
      for (std::size_t k = 0; k < kTerms; ++k) forcing[k] = turns[j][k].imag() * cosine - turns[j][k].real() * sine;
      solve(kTerms, imaginary);
      put(harmonic_column(j), real.q);
      put(harmonic_column(j) + 1, real.v);
      put(harmonic_column(j) + 2, imaginary.q);
      put(harmonic_column(j) + 3, imaginary.v);
    }
  }
}

ModalFlow ModalFlow::doubled() const {
  ModalFlow to;
  to.h_ = 2.0 * h_;
  to.angular_frequencies_ = angular_frequencies_;
  to.columns_.resize(columns_.rows(), columns_.cols());
  std::vector<std::complex<double>> turns;
  for (const double frequency : angular_frequencies_) turns.push_back(std::polar(1.0, frequency * h_));
  for (Index i = 0; i < columns_.rows(); ++i) {
    const double qq = columns_(i, 0), qv = columns_(i, 1), vq = columns_(i, 2), vv = columns_(i, 3);
    to.columns_(i, 0) = qq * qq + qv * vq;
    to.columns_(i, 1) = qq * qv + qv * vv;
    to.columns_(i, 2) = vq * qq + vv * vq;
    to.columns_(i, 3) = vq * qv + vv * vv;
    // A response to the first half of the forcing, carried through the second half, and one to that.
    struct Pair {
      double q, v;
    };
    const auto join = [&](Index column, const Pair& first, const Pair& second) {
      to.columns_(i, column) = qq * first.q + qv * first.v + second.q;
      to.columns_(i, column + 1) = vq * first.q + vv * first.v + second.v;
    };
    const auto old = [&](Index column) { return Pair{columns_(i, column), columns_(i, column + 1)}; };
    const Pair f0 = old(kForce), f1 = old(kForce + 2), f2 = old(kForce + 4);
    // In the halves of the double step P_1 and P_2 are combinations of those of the half.
    join(kForce, f0, f0);
    join(kForce + 2, {0.5 * (f1.q - f0.q), 0.5 * (f1.v - f0.v)}, {0.5 * (f1.q + f0.q), 0.5 * (f1.v + f0.v)});
    join(kForce + 4, {0.25 * f2.q - 0.75 * f1.q, 0.25 * f2.v - 0.75 * f1.v},
         {0.25 * f2.q + 0.75 * f1.q, 0.25 * f2.v + 0.75 * f1.v});
    for (std::size_t j = 0; j < turns.size(); ++j) {
      const Index column = harmonic_column(j);
      const Pair re = old(column), im = old(column + 2);
      const std::complex<double> q = turns[j] * std::complex<double>(re.q, im.q),
                                 v = turns[j] * std::complex<double>(re.v, im.v);
      join(column, re, {q.real(), v.real()});
      join(column + 2, im, {q.imag(), v.imag()});
    }
  }
  return to;
}

void ModalFlow::refine(const ArrayXd& omega, const ArrayXd& delta) {
  double decay = 1.0, decay_of = 0.0;  // often the same for all modes
  for (Index i = 0; i < omega.size(); ++i) {
    const double d = delta[i], square = omega[i] * omega[i] - d * d;
    const double kappa = std::sqrt(std::abs(square)), angle = kappa * h_;
    if (angle < 1e-4) continue;  // The series is as good.
    // e^(-delta h) times cos and sin/kappa, or cosh and sinh/kappa
    double cosine = 0.0, sine = 0.0;
    if (square > 0.0) {
      if (d != decay_of) decay = std::exp(-d * h_);
      decay_of = d;
      cosine = decay * std::cos(angle);
      sine = decay * std::sin(angle) / kappa;
    } else {
      const double slow = std::exp((kappa - d) * h_), fast = std::exp(-(kappa + d) * h_);
      cosine = 0.5 * (slow + fast);
      sine = 0.5 * (slow - fast) / kappa;
    }
    columns_.row(i).head(kForce) << cosine + d * sine, sine, -omega[i] * omega[i] * sine, cosine - d * sine;
  }
}

}  // namespace butee::solve
