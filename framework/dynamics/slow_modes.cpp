#include "butee/dynamics/slow_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SVD>

#include "butee/linalg/extended.hpp"

namespace butee::dynamics {
namespace {

/// A mode with (omega T)^2 below this does not oscillate within a run of T seconds. In coordinates of its own scale a
/// motion of speed v would be one of amplitude v/omega, of which x keeps too few digits.
constexpr double kStill = 1e-12;

}  // namespace

Index count_rigid(const Vector& squares, double run_time) {
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
  const double most = std::max(kStill / (run_time * run_time), kRounding * squares[squares.size() - 1]);
  return std::upper_bound(squares.begin(), squares.end(), most) - squares.begin();
}

bool separate_rigid(Index count, double run_time, Eigen::MatrixXd& shapes, Eigen::MatrixXd& damping) {
  constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon(), kUndamped = 1e-10;
  if (count < 2 || damping.leftCols(count).isZero(0.0)) return false;
  const Eigen::JacobiSVD<Eigen::MatrixXd> parts(damping.leftCols(count), Eigen::ComputeThinV);
  const Eigen::MatrixXd& turn = parts.matrixV();
  shapes.leftCols(count) *= turn;
  damping.leftCols(count) *= turn;
  damping.topRows(count) = turn.transpose() * damping.topRows(count).eval();
  const double least = std::min(kRounding * damping.norm(), kUndamped / run_time);
  for (Index i = 0; i < count; ++i)
    if (parts.singularValues()[i] <= least) {
      damping.col(i).setZero();
      damping.row(i).setZero();
    }
  return true;
}

Index count_soft(ConstVectorRef squares, double highest) {
  constexpr double kSoft = 1e-6;
  return std::upper_bound(squares.begin(), squares.end(), kSoft * highest) - squares.begin();
}

Eigen::MatrixXd soft_product(Index count, const SparseMatrix& matrix, const Eigen::MatrixXd& shapes) {
  const linalg::ExtendedColumns soft = shapes.leftCols(count).cast<long double>();
  linalg::ExtendedColumns forces = linalg::ExtendedColumns::Zero(shapes.rows(), count);
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry)
      forces.row(entry.row()) += static_cast<long double>(entry.value()) * soft.row(column);
  const linalg::ExtendedColumns product = soft.transpose() * forces;
  return product.cast<double>();
}

Eigen::MatrixXd SoftStiffness::of(Index count, const Eigen::MatrixXd& shapes) {
  constexpr double kMixed = 1e-9;
  // Products whose rounding is a larger part than this are summed again by the elements.
  constexpr double kDoubtful = 1e-10;
  Eigen::MatrixXd product = soft_product(count, stiffness_, shapes);
  const Eigen::MatrixXd sizes = shapes.leftCols(count).cwiseAbs();
  const SparseMatrix all = stiffness_.cwiseAbs();
  const Eigen::MatrixXd of_all = all * sizes;
  Eigen::MatrixXd rounding = std::numeric_limits<double>::epsilon() * (sizes.transpose() * of_all);
  rounding_ = kRoundingOfEntries * rounding.diagonal();
  if ((rounding_.array() > kDoubtful * product.diagonal().array()).any() && has_elements()) {
    constexpr double kMargin = 4.0;     // as in find_modes()
    constexpr double kOfShapes = 1e-3;  // shapes are rounded too: free beams of random meshes keep 1e-4 (chosen)
    const Eigen::MatrixXd soft = shapes.leftCols(count);
    const Structure::Elastic elastic = structure_->elastic(soft, true);
    const linalg::ExtendedColumns by_elements = soft.cast<long double>().transpose() * elastic.forces;
    product = by_elements.cast<double>();
    product = (0.5 * (product + product.transpose())).eval();
    rounding_ = (kMargin * elastic.rounding).cwiseMax(kOfShapes * rounding_);
    const Vector root = rounding_.cwiseSqrt();
    rounding = root * root.transpose();
  }
  const Vector squares = product.diagonal();
  const double still = kStill / (run_time_ * run_time_);
  const bool is_unlimited = std::isinf(run_time_);
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j) {
      double& value = product(i, j);
      if (i == j ? std::abs(value) <= still || (value < 0.0 && -value < rounding(i, i)) ||
                       (is_unlimited && std::abs(value) < rounding_[i])
                 : std::abs(value) <= std::max(rounding(i, j), kMixed * std::abs(squares[i] - squares[j])))
        value = 0.0;
    }
  return product;
}

bool SoftStiffness::has_elements() {
  if (!has_tried_)
    if (auto found = Structure::of(system_, stiffness_)) structure_.emplace(std::move(*found));
  has_tried_ = true;
  return structure_.has_value();
}

}  // namespace butee::dynamics
