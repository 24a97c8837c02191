#include "promise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace butee::stress {
namespace {

/// The scales S: `largest`, but at least a thousandth of the largest value of the kind; 1 for a kind that
/// never moves.
Eigen::MatrixXd scales_of(const Eigen::MatrixXd& largest, const std::vector<bool>& is_rotation) {
  std::array<double, 2> of_kind{};
  const Index last = largest.cols() - 1;
  for (Index i = 0; i < largest.rows(); ++i) {
    double& top = of_kind[is_rotation[static_cast<std::size_t>(i)] ? 1 : 0];
    top = std::max(top, largest(i, last));
  }
  Eigen::MatrixXd scales = largest;
  for (Index i = 0; i < largest.rows(); ++i) {
    const double top = of_kind[is_rotation[static_cast<std::size_t>(i)] ? 1 : 0];
    scales.row(i) = largest.row(i).cwiseMax(top > 0.0 ? Promise::kFloor * top : 1.0);
  }
  return scales;
}

}  // namespace

Promise::Promise(Trajectory reference, const Trajectory& largest, const std::vector<bool>& is_rotation,
                 double tolerance, double allowance)
    : reference_(std::move(reference)),
      scales_(largest),
      growth_(Vector::Zero(reference_.rows)),
      tolerance_(tolerance),
      allowance_(allowance),
      most_rows_(reference_.rows) {
  scales_.x = scales_of(largest.x, is_rotation);
  scales_.v = scales_of(largest.v, is_rotation);
  clear_bands();
}

void Promise::set_band(Index row, ConstVectorRef low, ConstVectorRef high) {
  low_.col(row) = low.cwiseMin(reference_.v.col(row));
  high_.col(row) = high.cwiseMax(reference_.v.col(row));
}

void Promise::clear_bands() {
  low_ = high_ = reference_.v;
}

double Promise::error_in_place(const Trajectory& of, Index row) const {
  return ((of.x.col(row) - reference_.x.col(row)).array().abs() / scales_.x.col(row).array()).maxCoeff();
}

double Promise::velocity_error(const Trajectory& of, Index row, Index i) const {
  const double v = of.v(i, row);
  return std::max({0.0, v - high_(i, row), low_(i, row) - v}) / scales_.v(i, row);
}

double Promise::error(const Trajectory& of, Index row) const {
  double e = error_in_place(of, row);
  for (Index i = 0; i < of.v.rows(); ++i) e = std::max(e, velocity_error(of, row, i));
  return e;
}

void Promise::raise_growth(const Trajectory& disturbed, Index from, double size, bool is_over, bool with_velocities) {
  double largest = 0.0;
  for (Index row = from; row < growth_.size(); ++row) {
    if (row < disturbed.rows)
      largest = std::max(largest, with_velocities ? error(disturbed, row) : error_in_place(disturbed, row));
    else if (!is_over)
      largest = std::numeric_limits<double>::infinity();
    growth_[row] = std::max(growth_[row], largest / size);
  }
}

double Promise::allowed(Index row) const {
  return kPromise * tolerance_ * allowance_ * std::max(1.0, growth_[row]);
}

Index Promise::rows() const {
  Index row = 0;
  while (row < most_rows_ && allowed(row) <= kHorizon * (1.0 + 1e-12)) ++row;
  return row;
}

Judgement Promise::judge(const Trajectory& of) const {
  Judgement found;
  const Index last = std::min(rows(), of.rows);
  for (Index row = 0; row < last; ++row) {
    const double e = error(of, row);
    found.error = std::max(found.error, e);
    if (!(e > found.excess * allowed(row))) continue;
    found.excess = e / allowed(row);
    found.allowed = allowed(row);
    found.row = row;
    for (Index i = 0; i < of.x.rows(); ++i) {
      const double place = std::abs(of.x(i, row) - reference_.x(i, row)) / scales_.x(i, row);
      if (place == e) found.component = i, found.in_velocity = false;
      if (velocity_error(of, row, i) == e) found.component = i, found.in_velocity = true;
    }
  }
  return found;
}

}  // namespace butee::stress
