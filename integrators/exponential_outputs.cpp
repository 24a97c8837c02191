// Of ExponentialStep: what outputs within and at the ends of a step take.
#include <algorithm>
#include <cmath>

#include "integrators/exponential_step.hpp"

namespace butee::integrators {
namespace {

using Eigen::ArrayXd;
using solve::StepFlow;

/// A step between outputs is rounded to so many digits, so that equal intervals are equal.
constexpr double kSameDigits = 1e10;

double rounded(double h) {
  const double unit = std::pow(10.0, std::floor(std::log10(h))) / kSameDigits;
  return std::round(h / unit) * unit;
}

}  // namespace

Trial ExponentialStep::attempt_length(double h) {
  return attempt(modal_.odd(has_stops() ? h : rounded(h)));
}

bool ExponentialStep::is_smooth(const StepFlow& flow) {
  const double square = flow.h() * flow.h() * kQuintic;
  const double allowed = output_tolerance_ * reached_.displacement;
  const double bound =
      load_swing_ + ((flow.swing_q * q_.abs() + flow.swing_v * v_.abs()) * (square * squares_).min(1.0)).sum();
  unsmooth_ = bound > 0.0 ? bound / allowed : 0.0;
  if (unsmooth_ <= 1.0 && !is_strongly_damped_) return true;
  propagate(flow.half, knots_.steps(), q_half_, &v_half_);
  modal_.stop_shapes().displacement(q_half_.data(), path_.middle.data());
  const double h = flow.h(), t = knots_.last();
  find_accelerations(t, q_, v_, a_);
  find_accelerations(t + h, q_new_, v_new_, excess_);
  const double miss =
      (path_.middle - 0.5 * (w_ + w_new_) - (5.0 / 32.0 * h) * (wv_ - wv_new_) - (h * h / 64.0) * (a_ + excess_))
          .head(modal_.stop_count())
          .abs()
          .maxCoeff();
  unsmooth_ = miss > 0.0 ? miss / allowed : 0.0;
  if (unsmooth_ > 1.0) {
    middle_knot_ = t + 0.5 * h;
    unsmooth_ /= kHalved;
  }
  return unsmooth_ <= 1.0;
}

void ExponentialStep::find_accelerations(double t, const ArrayXd& q, const ArrayXd& v, ArrayXd& a) {
  sums_[0] = -squares_ * q - 2.0 * modal_.decay() * v;
  modal_.add_load(t, sums_[0]);
  if (has_far_forces_) sums_[0] += pull_sum_;
  modal_.stop_shapes().displacement(sums_[0].data(), a.data());
}

void ExponentialStep::interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
  if (has_stops()) return knots_.interpolate(times, dofs, out);
  for (std::size_t i = 0; i < times.size(); ++i) evaluate_exactly(times[i], dofs, i * dofs.size(), out);
}

void ExponentialStep::evaluate_exactly(double t, std::span<const Index> dofs, std::size_t place,
                                       time::Interpolated out) {
  const std::size_t knot = knots_.before(t);
  ArrayXd &q = q_new_, &v = v_new_, &a = q_half_;
  q = Eigen::Map<const ArrayXd>(knots_.q(knot), q.size());
  v = Eigen::Map<const ArrayXd>(knots_.v(knot), v.size());
  if (t > knots_.time(knot)) propagate(modal_.odd(rounded(t - knots_.time(knot))).whole, knot, q, &v);
  a = -modal_.frequencies().square() * q - 2.0 * modal_.decay() * v;
  modal_.add_load(t, a);
  for (const Index dof : dofs) {
    const auto shape = modal_.shape_rows().col(dof).array();
    if (!out.x.empty()) out.x[place] = (shape * q).sum();
    if (!out.v.empty()) out.v[place] = (shape * v).sum();
    if (!out.a.empty()) out.a[place] = (shape * a).sum();
    ++place;
  }
}

}  // namespace butee::integrators
