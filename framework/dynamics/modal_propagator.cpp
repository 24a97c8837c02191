#include "butee/dynamics/modal_propagator.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "butee/core/error.hpp"
#include "butee/dynamics/kernel/modal_series.hpp"

namespace butee::dynamics {
namespace {

using Eigen::ArrayXd;

/// (omega + delta + Omega) h, for which the number of terms of the series is sufficient.
constexpr double kShort = 0.5;

kernel::Values chunk_of(const ArrayXd& all, Index begin) {
  kernel::Values chunk{};
  const auto values = all.segment(begin, std::min(linalg::kernel::kChunk, all.size() - begin));
  std::copy(values.begin(), values.end(), chunk.begin());
  return chunk;
}

}  // namespace

double ModalPropagator::longest_series(const ArrayXd& omega, const ArrayXd& delta,
                                       const std::vector<ModalHarmonic>& all) {
  double fastest = (omega + delta.abs()).maxCoeff();
  for (const ModalHarmonic& harmonic : all) fastest = std::max(fastest, harmonic.angular_frequency);
  return kShort / fastest;
}

ModalPropagator::ModalPropagator(const ArrayXd& omega, const ArrayXd& delta,
                                 const std::vector<ModalHarmonic>& harmonics, double h)
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

void ModalPropagator::start_by_series(const ArrayXd& omega, const ArrayXd& delta,
                                      const std::vector<ModalHarmonic>& all) {
  columns_.resize(omega.size(), harmonic_column(all.size()));
  std::vector<kernel::HarmonicSeries> loads;
  for (const ModalHarmonic& harmonic : all) {
    auto& turn = loads.emplace_back().turn;
    turn[0] = 1.0;
    for (std::size_t k = 1; k < turn.size(); ++k)
      turn[k] = turn[k - 1] * std::complex<double>(0.0, harmonic.angular_frequency * h_ / static_cast<double>(k));
  }
  std::vector<kernel::Values> chunk(static_cast<std::size_t>(columns_.cols()));
  for (Index begin = 0; begin < omega.size(); begin += linalg::kernel::kChunk) {
    for (std::size_t j = 0; j < all.size(); ++j) {
      loads[j].cosine = chunk_of(all[j].cosine, begin);
      loads[j].sine = chunk_of(all[j].sine, begin);
    }
    kernel::sum_series()({h_, chunk_of(omega, begin), chunk_of(delta, begin)}, loads, chunk.data());
    const Index count = std::min(linalg::kernel::kChunk, omega.size() - begin);
    for (Index column = 0; column < columns_.cols(); ++column)
      for (Index i = 0; i < count; ++i)
        columns_(begin + i, column) = chunk[static_cast<std::size_t>(column)][static_cast<std::size_t>(i)];
  }
}

ModalPropagator ModalPropagator::doubled() const {
  ModalPropagator to;
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
    // The response to the first half of the forcing, propagated through the second half, plus the
    // response to the second.
    struct Pair {
      double q, v;
    };
    const auto join = [&](Index column, const Pair& first, const Pair& second) {
      to.columns_(i, column) = qq * first.q + qv * first.v + second.q;
      to.columns_(i, column + 1) = vq * first.q + vv * first.v + second.v;
    };
    const auto old = [&](Index column) { return Pair{columns_(i, column), columns_(i, column + 1)}; };
    const Pair f0 = old(kForce), f1 = old(kForce + 2), f2 = old(kForce + 4);
    // Within each half of the double step P_1 and P_2 are combinations of the polynomials of the
    // half.
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

void ModalPropagator::refine(const ArrayXd& omega, const ArrayXd& delta) {
  double decay = 1.0, decay_of = 0.0;  // often the same for all modes
  for (Index i = 0; i < omega.size(); ++i) {
    const double d = delta[i], square = omega[i] * omega[i] - d * d;
    const double kappa = std::sqrt(std::abs(square)), angle = kappa * h_;
    if (angle < 1e-4) continue;  // The series is equally accurate.
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

}  // namespace butee::dynamics
