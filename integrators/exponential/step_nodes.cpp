#include "integrators/exponential/step_nodes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

namespace butee::integrators {
namespace {

using Square = StepNodes::Matrix;

constexpr int kLooks = 32;
/// A start is on the border if its distance is below this fraction of the distance at the first
/// sample.
constexpr double kOnBorder = 1e-3;
/// A step that follows one which was shortened starts on a border whose distance is below this part of the motion in
/// the step. Steps are shortened to kCoarsestCut = 1e-6 of their length (modal_collocation.cpp), a tenth of it.
constexpr double kSameBorder = 1e-5;

Square interpolation(bool has_middle) {
  std::vector<Index> used;
  for (Index j = 0; j < StepNodes::kCount; ++j)
    if (has_middle || j != StepNodes::kMiddle) used.push_back(j);
  const auto n = static_cast<Index>(used.size());
  Eigen::MatrixXd powers(n, n);
  for (Index j = 0; j < n; ++j)
    for (Index r = 0; r < n; ++r)
      powers(j, r) = std::pow(StepNodes::kPlaces[static_cast<std::size_t>(used[static_cast<std::size_t>(j)])],
                              static_cast<double>(r));
  const Eigen::MatrixXd inverse = powers.fullPivLu().inverse();  // coefficient r from value j
  Square all = Square::Zero();
  for (Index j = 0; j < n; ++j)
    for (Index r = 0; r < n; ++r) all(used[static_cast<std::size_t>(j)], r) = inverse(r, j);
  return all;
}

}  // namespace

const std::array<double, StepNodes::kCount> StepNodes::kPlaces = {
    0.0, 0.5 - 0.5 * 0.76505532392946469, 0.5 - 0.5 * 0.28523151648064510,
    0.5, 0.5 + 0.5 * 0.28523151648064510, 0.5 + 0.5 * 0.76505532392946469,
    1.0};

const Square& StepNodes::with_middle() {
  static const Square matrix = interpolation(true);
  return matrix;
}

const Square& StepNodes::without_middle() {
  static const Square matrix = interpolation(false);
  return matrix;
}

const Square& StepNodes::legendre() {
  static const Square matrix = [] {
    // Row n holds the shifted P_n in powers: n P_n = (2n - 1)(2s - 1) P_(n-1) - (n - 1) P_(n-2).
    Square powers = Square::Zero();
    powers(0, 0) = 1.0;
    powers.row(1) << -1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0;
    for (Index n = 2; n < kCount; ++n) {
      Row shifted = Row::Zero();
      shifted.tail(kCount - 1) = 2.0 * powers.row(n - 1).head(kCount - 1);
      shifted -= powers.row(n - 1);
      const auto degree = static_cast<double>(n);
      powers.row(n) = ((2.0 * degree - 1.0) * shifted - (degree - 1.0) * powers.row(n - 2)) / degree;
    }
    return Square(with_middle() * powers.inverse());
  }();
  return matrix;
}

namespace {

/// The size of the two highest coefficients, and its ratio to that of the two before.
struct Tail {
  double size, decay;
};

Tail tail_of(const StepNodes::Row& coefficients) {
  const double low = std::abs(coefficients[3]) + std::abs(coefficients[4]),
               high = std::abs(coefficients[5]) + std::abs(coefficients[6]);
  return {high, high < low ? high / low : 1.0};
}

}  // namespace

double StepNodes::quadrature_error(const Row& coefficients) {
  const Tail tail = tail_of(coefficients);
  return kRule * tail.size * tail.decay * tail.decay;
}

double StepNodes::inner_error(const Row& coefficients) {
  const Tail tail = tail_of(coefficients);
  return kInner * tail.size * tail.decay;
}

Eigen::Matrix<double, StepNodes::kCount, 1> StepNodes::lagrange(double place) {
  // As products, whose rounding errors are small beside each weight; those of powers of `place` are not.
  static const std::array<double, kCount> scales = [] {
    std::array<double, kCount> of;
    for (std::size_t j = 0; j < of.size(); ++j) {
      double product = 1.0;
      for (std::size_t k = 0; k < of.size(); ++k)
        if (k != j) product *= kPlaces[j] - kPlaces[k];
      of[j] = 1.0 / product;
    }
    return of;
  }();
  Eigen::Matrix<double, kCount, 1> weights;
  double before = 1.0, behind = 1.0;
  for (Index j = 0; j < kCount; ++j) {
    weights[j] = before * scales[static_cast<std::size_t>(j)];
    before *= place - kPlaces[static_cast<std::size_t>(j)];
  }
  for (Index j = kEnd; j >= 0; --j) {
    weights[j] *= behind;
    behind *= place - kPlaces[static_cast<std::size_t>(j)];
  }
  return weights;
}

StepNodes::Hermite StepNodes::hermite(double place) {
  // The derivatives of Lagrange's polynomials at both ends, which mirror each other, as the nodes do.
  static const Eigen::Matrix<double, kCount, 1> begin_slopes = [] {
    Eigen::Matrix<double, kCount, 1> slopes;
    slopes[0] = 0.0;
    for (Index j = 1; j < kCount; ++j) {
      const double own = kPlaces[static_cast<std::size_t>(j)];
      double product = 1.0 / own;
      for (Index k = 1; k < kCount; ++k)
        if (const double other = kPlaces[static_cast<std::size_t>(k)]; k != j) product *= other / (other - own);
      slopes[j] = product;
      slopes[0] -= product;
    }
    return slopes;
  }();
  double begin = place * (1.0 - place), end = begin * place;
  begin *= 1.0 - place;
  for (Index j = 1; j < kEnd; ++j) {
    const double node = kPlaces[static_cast<std::size_t>(j)], factor = (node - place) / node;
    begin *= factor;
    end *= factor;
  }
  return {lagrange(place) - begin * begin_slopes + end * begin_slopes.reverse(), begin, end};
}

double StepNodes::first_crossing(const Row& coefficients, double border, const CrossingRange& range) {
  const double last = range.last;
  const auto at = [&](double s) {
    double sum = 0.0;
    for (Index r = kCount - 1; r >= 0; --r) sum = sum * s + coefficients[r];
    return sum - border;
  };
  const auto beyond_rounding = [&](double s) {
    const double distance = at(s);
    return std::abs(distance) > range.rounding ? distance : 0.0;
  };
  const bool starts_there = std::abs(at(0.0)) <= kSameBorder * coefficients.tail(kCount - 1).lpNorm<1>();
  const double first = starts_there ? range.begin : 0.0;
  double begin = first, at_begin = beyond_rounding(begin);
  for (int k = 1; begin < last; ++k) {
    double end = k <= kLooks ? static_cast<double>(k) / kLooks : last;
    if (end <= begin) continue;
    const double at_end = beyond_rounding(end);
    if (begin == first && std::abs(at_begin) <= kOnBorder * std::abs(at_end)) at_begin = at_end;
    if (at_begin * at_end < 0.0) {
      while (true) {
        const double middle = 0.5 * (begin + end);
        if (middle <= begin || middle >= end) return std::min(end, last);
        (at(middle) * at_begin > 0.0 ? begin : end) = middle;
      }
    }
    // A sample on the border tells nothing about a crossing; the next one does.
    if (at_end == 0.0 && end < last) continue;
    begin = end;
    at_begin = at_end;
  }
  return last;
}

}  // namespace butee::integrators
