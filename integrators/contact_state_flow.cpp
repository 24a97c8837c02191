#include "integrators/contact_state_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/core/error.hpp"
#include "butee/dynamics/slow_modes.hpp"
#include "butee/linalg/dense_pairs.hpp"
#include "butee/linalg/general_pairs.hpp"

namespace butee::integrators {
namespace {

using LongComplex = std::complex<long double>;
using LongComplexMatrix = Eigen::Matrix<LongComplex, Eigen::Dynamic, Eigen::Dynamic>;

/// Damping couples modes i and j if phi_i^T C phi_j exceeds this fraction of (b_i b_j)^(1/2), b_i = |phi_i|^T |C|
/// |phi_i|. Rounding of proportional damping, which is given in doubles, stays below.
constexpr long double kUncoupled = 1e-14L;
/// Eigenvalues are found once more if the largest is this multiple of another one.
constexpr long double kGraded = 1e6L;
/// Eigenvalues closer than this part of the larger are not found once more: each iteration might find the same.
constexpr long double kSeparate = 1e-6L;
/// Real parts of eigenvalues below this fraction of the largest eigenvalue are rounding.
constexpr long double kGrowing = 1e-15L;
/// A squared frequency phi^T K phi below this fraction of |phi|^T |K| |phi| is rounding of the entries of K, which are
/// doubles: the motion is rigid.
constexpr long double kRigid = dynamics::kRoundingOfEntries * std::numeric_limits<double>::epsilon();
/// Largest condition number of the eigenvector matrix; a larger one loses six digits or more.
constexpr long double kParallel = 1e6L;
/// Modes below this fraction of the largest squared frequency are found once more, among themselves.
constexpr long double kSoft = 1e-6L;

/// Removes the rounding of the largest squared frequencies from the lowest ones: K restricted to the slow modes, the
/// first columns of `shapes`, has eigenvalues with rounding of the largest of these only. Beside a stop of 1e11 N/m on
/// 1e-8 kg a spring of 22 N/m would be lost.
bool refine_slow(const LongMatrix& stiffness, const LongMatrix& mass, LongMatrix& shapes, LongVector& squares) {
  for (Index before = squares.size(), count = 0; before > 1; before = count) {
    const long double largest = squares.head(before).cwiseAbs().maxCoeff();
    count = (squares.head(before).array().abs() < kSoft * largest).count();
    if (count == 0) return true;
    const LongMatrix slow = shapes.leftCols(count);
    const LongMatrix their_mass = slow.transpose() * mass * slow;
    if (count == 1) {
      squares[0] = (slow.transpose() * stiffness * slow)(0, 0) / their_mass(0, 0);
      return true;
    }
    const auto pairs = linalg::extended_pairs(slow.transpose() * stiffness * slow, their_mass);
    if (!pairs) return false;
    shapes.leftCols(count) = slow * pairs->vectors;
    squares.head(count) = pairs->values;
    if (count == before) return true;
  }
  return true;
}

/// Removes the rounding of the largest eigenvalues from the pairs of q'' + C q' + diag(squares) q = 0, given in (scale
/// q, q'): inverse iteration with Q(lambda) = lambda^2 + lambda C + diag(squares), whose solutions have the rounding of
/// their own rows. C is symmetric, so that the left vector of (v, lambda v) is (-squares v/lambda, v) = (lambda v + C
/// v, v). Beside a dashpot of 50 N s/m on 6e-8 kg motion of 2 rad/s would have errors of 1e-9.
void refine_pairs(const LongVector& squares, const LongMatrix& damping, const LongVector& scale,
                  linalg::ExtendedComplexPairs& pairs) {
  const Index p = squares.size(), count = 2 * p;
  const auto size = [&](Index m) { return std::abs(pairs.values[m]); };
  const long double largest = pairs.values.cwiseAbs().maxCoeff();
  if (largest < kGraded * pairs.values.cwiseAbs().minCoeff()) return;
  for (Index m = 0; m < count; ++m)
    for (Index j = 0; j < m; ++j)
      if (std::abs(pairs.values[m] - pairs.values[j]) <= kSeparate * std::max(size(m), size(j))) return;
  linalg::ExtendedComplexPairs fine = pairs;
  const LongComplexMatrix c = damping.cast<LongComplex>();
  using Column = Eigen::Matrix<LongComplex, Eigen::Dynamic, 1>;
  for (Index m = 0; m < count; ++m) {
    LongComplex lambda = pairs.values[m];
    if (lambda.imag() < 0.0L) continue;  // the conjugate of the one before
    Column v = scale.cwiseInverse().cast<LongComplex>().cwiseProduct(pairs.vectors.col(m).head(p));
    for (int iteration = 0; iteration < 2; ++iteration) {
      LongComplexMatrix q = lambda * c;
      q.diagonal().array() += squares.array().cast<LongComplex>() + lambda * lambda;
      const Column next = q.partialPivLu().solve(2.0L * lambda * v + c * v).normalized();
      if (!next.allFinite()) break;  // Q is singular: lambda is exact
      v = next;
      const LongComplex slope = (v.transpose() * (2.0L * lambda * v + c * v)).value();
      const LongComplex value =
          (v.transpose() * (lambda * lambda * v + lambda * (c * v) + squares.cast<LongComplex>().cwiseProduct(v)))
              .value();
      lambda -= value / slope;
    }
    if (pairs.values[m].imag() == 0.0L) {
      lambda = lambda.real();
      v = v.real().cast<LongComplex>().eval();
    }
    const Column by_stiffness = squares.cast<LongComplex>().cwiseProduct(v), by_damping = c * v;
    // Either form, with less rounding.
    const long double of_damping = (damping.cwiseAbs() * v.cwiseAbs()).norm() + std::abs(lambda);
    Column left = lambda * v + by_damping;
    if (by_stiffness.norm() < std::abs(lambda) * of_damping) left = -by_stiffness / lambda;
    const LongComplex product = (left.transpose() * v).value() + lambda * (v.transpose() * v).value();
    fine.values[m] = lambda;
    fine.vectors.col(m) << scale.cast<LongComplex>().cwiseProduct(v), lambda * v;
    fine.inverse.row(m) << (left.cwiseQuotient(scale.cast<LongComplex>()) / product).transpose(),
        (v / product).transpose();
    if (lambda.imag() == 0.0L) continue;
    fine.values[m + 1] = std::conj(lambda);
    fine.vectors.col(m + 1) = fine.vectors.col(m).conjugate();
    fine.inverse.row(m + 1) = fine.inverse.row(m).conjugate();
  }
  const long double departure =
      (fine.inverse * fine.vectors - LongComplexMatrix::Identity(count, count)).cwiseAbs().maxCoeff();
  if (departure < kSeparate) pairs = std::move(fine);
}

LongMatrix closed_stiffness(const SmallSystem& system, const std::vector<bool>& closed, bool of_damping) {
  LongMatrix sum = of_damping ? system.damping : system.stiffness;
  for (std::size_t i = 0; i < closed.size(); ++i) {
    const LinearStop& stop = system.stops[i];
    const long double k = of_damping ? stop.damping : stop.stiffness;
    if (!closed[i] || k == 0.0L) continue;
    if (stop.a >= 0) sum(stop.a, stop.a) += k;
    if (stop.b >= 0) sum(stop.b, stop.b) += k;
    if (stop.a >= 0 && stop.b >= 0) {
      sum(stop.a, stop.b) -= k;
      sum(stop.b, stop.a) -= k;
    }
  }
  return sum;
}

[[noreturn]] void refuse_growth() {
  throw RunError(
      "piecewise: the motion of a contact state grows without its loads (negative damping); take exponential, exact or "
      "rodas4");
}

}  // namespace

ContactStateFlow::ContactStateFlow(const SmallSystem& system, const std::vector<bool>& closed, double end_time)
    : system_(system), n_(system.size()), longest_(end_time) {
  const LongMatrix stiffness = closed_stiffness(system, closed, false),
                   damping = closed_stiffness(system, closed, true);
  const LongMatrix inverse = system.mass.ldlt().solve(LongMatrix::Identity(n_, n_));
  forms_ = LongMatrix::Zero(system.stop_count(), n_);
  for (Index i = 0; i < forms_.rows(); ++i) {
    const LinearStop& stop = system.stops[static_cast<std::size_t>(i)];
    if (stop.a >= 0) forms_(i, stop.a) += 1.0L;
    if (stop.b >= 0) forms_(i, stop.b) -= 1.0L;
  }
  by_force_ = with_stops(inverse).cast<double>();
  by_x_ = (inverse * stiffness).cast<double>();
  by_v_ = (inverse * damping).cast<double>();
  LongMatrix shapes(n_, n_);
  LongVector squares(n_);
  if (n_ == 1) {
    shapes(0, 0) = 1.0L / std::sqrt(system.mass(0, 0));
    squares[0] = stiffness(0, 0) / system.mass(0, 0);
  } else {
    const auto pairs = linalg::extended_pairs(stiffness, system.mass);
    if (pairs) {
      shapes = pairs->vectors;
      squares = pairs->values;
    }
    if (!pairs || !refine_slow(stiffness, system.mass, shapes, squares))
      throw RunError("piecewise: the modes of a contact state could not be computed; take exact or rodas4");
  }
  for (Index i = 0; i < n_; ++i) {
    const LongVector sizes = shapes.col(i).cwiseAbs();
    if (std::abs(squares[i]) <= kRigid * sizes.dot(stiffness.cwiseAbs() * sizes)) squares[i] = 0.0L;
  }
  if (squares.minCoeff() < 0.0L)
    throw RunError(
        "piecewise: the structure is not stable without its loads (a negative stiffness); take exact or rodas4");
  LongMatrix modal = shapes.transpose() * damping * shapes;
  const LongMatrix sizes = shapes.cwiseAbs();
  const LongVector root = (sizes.transpose() * damping.cwiseAbs() * sizes).diagonal().cwiseSqrt();
  const auto least = [&](Index i, Index j) { return kUncoupled * root[i] * root[j]; };
  for (Index i = 0; i < n_; ++i)
    if (std::abs(modal(i, i)) <= 0.1L * least(i, i)) modal(i, i) = 0.0L;
  std::vector<Index> coupled;
  for (Index i = 0; i < n_; ++i) {
    bool is_alone = true;
    for (Index j = 0; j < n_; ++j) is_alone = is_alone && (j == i || std::abs(modal(i, j)) <= least(i, j));
    if (is_alone && modal(i, i) < 0.0L) refuse_growth();
    if (is_alone)
      add_alone(shapes, squares, modal, i);
    else
      coupled.push_back(i);
  }
  if (!coupled.empty()) add_coupled(shapes, squares, modal, coupled);
  forcing_ = with_stops(forcing_);
  find_extras(end_time);
  find_response();
  dofs_ = rows_of(LongMatrix::Identity(n_, n_));
  stops_ = rows_of(forms_);
  project_ = left_.cast<double>();
  force_of_ = forcing_.cast<double>();
  x_.resize(static_cast<std::size_t>(n_));
  v_ = x_;
}

LongMatrix ContactStateFlow::with_stops(const LongMatrix& by_force) const {
  LongMatrix both(by_force.rows(), n_ + forms_.rows());
  both << by_force, by_force * forms_.transpose();
  return both;
}

void ContactStateFlow::append(Block block, const LongMatrix& right, const LongMatrix& left, const LongMatrix& forcing) {
  const Index k = 2 * static_cast<Index>(blocks_.size());
  right_.conservativeResize(n_, k + 2);
  left_.conservativeResize(k + 2, 2 * n_);
  forcing_.conservativeResize(k + 2, n_);
  right_.rightCols(2) = right;
  left_.bottomRows(2) = left;
  forcing_.bottomRows(2) = forcing;
  largest_decay_ =
      std::max(largest_decay_, block.kind == Kind::reals || !block.oscillates() ? block.rate : block.decay);
  grows_ = grows_ || !block.oscillates();
  fastest_ = std::max(fastest_, block.rate);
  blocks_.push_back(std::move(block));
}

void ContactStateFlow::add_alone(const LongMatrix& shapes, const LongVector& squares, const LongMatrix& damping,
                                 Index mode) {
  Block block;
  const long double d = 0.5L * damping(mode, mode), turning = squares[mode] - d * d;
  block.decay = static_cast<double>(d);
  block.square = static_cast<double>(squares[mode]);
  block.turning = static_cast<double>(turning);
  block.frequency = static_cast<double>(std::sqrt(std::abs(turning)));
  block.rate = std::sqrt(block.square);
  if (turning < 0.0L) block.rate = std::max(block.rate, block.decay + block.frequency);
  LongMatrix right = LongMatrix::Zero(n_, 2), left = LongMatrix::Zero(2, 2 * n_), forcing = LongMatrix::Zero(2, n_);
  right.col(0) = shapes.col(mode);
  left.topLeftCorner(1, n_) = shapes.col(mode).transpose() * system_.mass;
  left.bottomRightCorner(1, n_) = left.topLeftCorner(1, n_);
  forcing.row(0) = shapes.col(mode).transpose();
  append(std::move(block), right, left, forcing);
}

void ContactStateFlow::add_coupled(const LongMatrix& shapes, const LongVector& squares, const LongMatrix& damping,
                                   const std::vector<Index>& modes) {
  const auto p = static_cast<Index>(modes.size());
  LongMatrix motion = LongMatrix::Zero(2 * p, 2 * p), some(n_, p);  // of (scale q, q')
  // Scaled by the frequency of their mode, the two vectors of a conjugate pair are as far from parallel in slow modes
  // as in fast ones. A coupled mode without stiffness is damped.
  LongVector scale(p);
  for (Index i = 0; i < p; ++i) {
    const Index mode = modes[static_cast<std::size_t>(i)];
    if (squares[mode] <= 0.0L && damping(mode, mode) <= 0.0L) refuse_growth();
    scale[i] = squares[mode] > 0.0L ? std::sqrt(squares[mode]) : damping(mode, mode);
    some.col(i) = shapes.col(mode);
    motion(i, p + i) = scale[i];
    motion(p + i, i) = -squares[mode] / scale[i];
    for (Index j = 0; j < p; ++j) motion(p + i, p + j) = -damping(mode, modes[static_cast<std::size_t>(j)]);
  }
  auto pairs = linalg::general_pairs(motion);
  if (!pairs || !(pairs->vectors.norm() * pairs->inverse.norm() < kParallel))
    throw RunError(
        "piecewise: dashpots make two motions of a contact state nearly the same (critical damping), so that they are "
        "no basis; take exact or rodas4");
  if (pairs->values.real().maxCoeff() > kGrowing * pairs->values.cwiseAbs().maxCoeff()) refuse_growth();
  refine_pairs(squares(modes), damping(modes, modes), scale, *pairs);
  const LongComplexMatrix &vectors = pairs->vectors, &inverse = pairs->inverse;
  const LongMatrix weighted = some.transpose() * system_.mass;
  const auto right_of = [&](Index m) -> Eigen::Matrix<LongComplex, Eigen::Dynamic, 1> {
    return some.cast<LongComplex>() * scale.cwiseInverse().cast<LongComplex>().cwiseProduct(vectors.col(m).head(p));
  };
  LongMatrix right(n_, 2), left(2, 2 * n_), forcing(2, n_);
  const auto fill_left = [&](Index row, const auto& of_q, const auto& of_v) {
    left.block(row, 0, 1, n_) = of_q.cwiseProduct(scale.transpose()) * weighted;
    left.block(row, n_, 1, n_) = of_v * weighted;
    forcing.row(row) = of_v * some.transpose();
  };
  Block reals;
  int held = 0;
  for (Index m = 0; m < 2 * p; ++m) {
    const LongComplex lambda = pairs->values[m];
    const LongMatrix of_q_re = inverse.row(m).head(p).real(), of_v_re = inverse.row(m).tail(p).real();
    if (lambda.imag() < 0.0L) continue;  // the conjugate eigenvalue of a pair
    if (lambda.imag() > 0.0L) {
      Block block;
      block.kind = Kind::pair;
      block.decay = std::max(0.0, static_cast<double>(-lambda.real()));
      block.frequency = static_cast<double>(lambda.imag());
      block.square = static_cast<double>(std::norm(lambda));
      block.rate = static_cast<double>(std::abs(lambda));
      const auto r = right_of(m);
      LongMatrix shape(n_, 2);
      shape.col(0) = 2.0L * r.real();
      shape.col(1) = -2.0L * r.imag();
      fill_left(0, of_q_re, of_v_re);
      const LongMatrix of_q_im = inverse.row(m).head(p).imag(), of_v_im = inverse.row(m).tail(p).imag();
      fill_left(1, of_q_im, of_v_im);
      append(std::move(block), shape, left, forcing);
    }
  }
  for (Index m = 0; m < 2 * p; ++m) {
    const LongComplex lambda = pairs->values[m];
    if (lambda.imag() != 0.0L) continue;
    const LongMatrix of_q = inverse.row(m).head(p).real(), of_v = inverse.row(m).tail(p).real();
    reals.rates[static_cast<std::size_t>(held)] = std::min(0.0, static_cast<double>(lambda.real()));
    right.col(held) = right_of(m).real();
    fill_left(held, of_q, of_v);
    if (++held == 1) continue;
    reals.kind = Kind::reals;
    reals.rate = std::max(-reals.rates[0], -reals.rates[1]);
    append(reals, right, left, forcing);
    held = 0;
  }
}

}  // namespace butee::integrators
