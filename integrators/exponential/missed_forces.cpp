#include "integrators/exponential/missed_forces.hpp"

#include <cmath>

namespace butee::integrators {

using Eigen::ArrayXd;

MissedForces::MissedForces(const dynamics::ModalSystem& modal)
    : modal_(modal),
      row_squares_(modal.shape_rows().colwise().squaredNorm().transpose()),
      stiffness_(Vector::Zero(modal.stop_count())),
      speeds_(Vector::Zero(row_squares_.size())),
      weights_(speeds_) {
  for (ArrayXd* of : {&swing_, &mean_, &cubic_, &to_mean_, &to_cubic_, &work_}) of->setZero(modal.size());
}

void MissedForces::begin(const ArrayXd& amplitudes, const Vector& stiffness, const Vector& speeds) {
  constexpr double kExpected = 0.1;
  const ArrayXd& frequencies = modal_.frequencies();
  swing_ = (frequencies > 0.0).select(amplitudes / frequencies, 0.0);
  stiffness_ = stiffness;
  work_ = amplitudes.square();
  for (Index d = 0; d < speeds.size(); ++d) {
    const double by_modes = std::sqrt((modal_.shape_rows().col(d).array().square() * work_).sum());
    speeds_[d] = std::max(speeds[d], kExpected * by_modes);
    weights_[d] = speeds_[d] > 0.0 ? 1.0 / (speeds_[d] * speeds_[d]) : 0.0;
  }
  largest_row_ = (row_squares_ * weights_).maxCoeff();
  h_ = 0.0;
}

double MissedForces::error(double h, double enough) {
  if (h == h_ && enough >= enough_) return error_;
  h_ = h;
  enough_ = enough;
  // mean_ is the angle until the last line.
  mean_ = h * modal_.frequencies();
  cubic_ = mean_.unaryExpr(&missed_cubic);
  to_mean_ = mean_.unaryExpr(&received_mean);
  to_cubic_ = mean_.unaryExpr(&received_cubic);
  mean_ = mean_.unaryExpr(&missed_mean).eval();
  error_ = 0.0;
  for (Index j = 0; j < stiffness_.size(); ++j)
    if (stiffness_[j] > 0.0) error_ = std::max(error_, of_stop(j, enough));
  return error_;
}

double MissedForces::of_stop(Index stop, double enough) {
  const auto shape = modal_.stop_shapes().of(stop).array();
  const double impulse = stiffness_[stop] * h_, mean = (shape * swing_ * mean_).matrix().squaredNorm(),
               cubic = (shape * swing_ * cubic_).matrix().squaredNorm();
  work_ = shape.square() * (mean * to_mean_.square() + cubic * to_cubic_.square());
  if (const double bound = impulse * std::sqrt(work_.maxCoeff() * largest_row_); bound <= enough) return bound;
  double largest = 0.0;
  for (Index d = 0; d < weights_.size(); ++d)
    largest = std::max(largest, weights_[d] * (modal_.shape_rows().col(d).array().square() * work_).sum());
  return impulse * std::sqrt(largest);
}

}  // namespace butee::integrators
