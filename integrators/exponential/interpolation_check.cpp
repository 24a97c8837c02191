#include "integrators/exponential/interpolation_check.hpp"

#include <algorithm>

namespace butee::integrators {
namespace {

using Eigen::ArrayXd;

/// An error that is odd about the middle shows there in the speed only: 16 s^2 (1 - s)^2 (2 s - 1)
/// has a slope of magnitude 2 in the middle and is at most 0.29.
constexpr double kOddPart = 0.15;
/// A breakpoint in the middle divides the error indicator by this. It reduces the error of quintics
/// to 1/64, or to 1/4 if modes are too fast for any quintic.
constexpr double kHalved = 10.0;
/// Rounding of a sum over the modes, as a fraction of the sum of the sizes of its terms (chosen: 9 eps).
constexpr double kRounding = 2e-15;

}  // namespace

InterpolationCheck::InterpolationCheck(const dynamics::ModalSystem& modal, double tolerance)
    : modal_(modal),
      tolerance_(tolerance),
      squares_(modal.frequencies().square()),
      is_strongly_damped_((4.0 * modal.decay() > modal.frequencies()).any()) {
  for (ArrayXd* array : {&a_, &a_end_}) array->setZero(dynamics::ContactPropagator::padded(modal.stop_count()));
}

bool InterpolationCheck::is_bounded(const dynamics::ContactPropagator& flow, const TriedStep& step, double of_loads) {
  const double square = step.h * step.h * kQuintic;
  const double bound =
      of_loads +
      ((flow.swing_q * step.from.q.abs() + flow.swing_v * step.from.v.abs()) * (square * squares_).min(1.0)).sum();
  error_ = bound > 0.0 ? bound / (tolerance_ * step.reached.displacement) : 0.0;
  return error_ <= 1.0 && !is_strongly_damped_;
}

bool InterpolationCheck::is_close(TriedStep& step, const ArrayXd* constant_force) {
  const double h = step.h;
  const auto &w = step.from.w, &w_end = step.to.w, &wv = step.from.wv, &wv_end = step.to.wv;
  find_accelerations(step.t, step.from, constant_force, a_);
  find_accelerations(step.t + h, step.to, constant_force, a_end_);
  const Index m = modal_.stop_count();
  const double of_middle =
      (step.middle.w - 0.5 * (w + w_end) - (5.0 / 32.0 * h) * (wv - wv_end) - (h * h / 64.0) * (a_ + a_end_))
          .head(m)
          .abs()
          .maxCoeff();
  const double of_speed =
      (h * step.middle.wv - 1.875 * (w_end - w) + (0.4375 * h) * (wv + wv_end) - (h * h / 32.0) * (a_end_ - a_))
          .head(m)
          .abs()
          .maxCoeff();
  const double miss = std::max(of_middle, kOddPart * of_speed);
  error_ = miss > 0.0 ? miss / (tolerance_ * step.reached.displacement) : 0.0;
  // At a start stops far from the motion have moved less than their modal sums round.
  if (error_ > 1.0 && miss <= rounding(step)) error_ = 0.0;
  if (error_ > 1.0) {
    step.breakpoint = step.t + 0.5 * h;
    error_ /= kHalved;
  }
  return error_ <= 1.0;
}

double InterpolationCheck::rounding(const TriedStep& step) const {
  const double h = step.h;
  const ArrayXd size = (1.0 + h * h * squares_) * step.from.q.abs().max(step.to.q.abs()) +
                       h * step.from.v.abs().max(step.to.v.abs());
  double largest = 0.0;
  for (Index i = 0; i < modal_.stop_count(); ++i)
    largest = std::max(largest, modal_.stop_shapes().of(i).cwiseAbs().dot(size.matrix()));
  return kRounding * largest;
}

void InterpolationCheck::find_accelerations(double t, const ModalState& state, const ArrayXd* constant_force,
                                            ArrayXd& a) {
  modal_acceleration_ = -squares_ * state.q - 2.0 * modal_.decay() * state.v;
  modal_.add_load(t, modal_acceleration_);
  if (constant_force != nullptr) modal_acceleration_ += *constant_force;
  modal_.stop_shapes().displacement(modal_acceleration_.data(), a.data());
}

}  // namespace butee::integrators
