#include "integrators/modal_knots.hpp"

#include <algorithm>

namespace butee::integrators {

ModalKnots::ModalKnots(solve::Dynamics& dynamics, const solve::ModalSystem& modal, std::size_t most)
    : dynamics_(dynamics), modal_(modal) {
  times_.reserve(most + 1);
  for (Eigen::MatrixXd* matrix : {&q_, &v_, &a_}) matrix->setZero(modal.size(), static_cast<Index>(most) + 1);
  is_complete_.assign(most + 1, false);
  stop_displacement_ = stop_force_ = Vector::Zero(dynamics.stop_count());
}

void ModalKnots::begin(double t, const Eigen::ArrayXd& q, const Eigen::ArrayXd& v) {
  times_.clear();
  course_knot_ = kNone;
  add(t, q, v);
}

void ModalKnots::add(double t, const Eigen::ArrayXd& q, const Eigen::ArrayXd& v) {
  const auto knot = static_cast<Index>(times_.size());
  times_.push_back(t);
  q_.col(knot) = q;
  v_.col(knot) = v;
  is_complete_[times_.size() - 1] = false;
}

std::span<const double> ModalKnots::inner() const {
  if (times_.size() < 3) return {};
  return {times_.data() + 1, times_.size() - 2};
}

std::size_t ModalKnots::before(double t) const {
  if (course_knot_ != kNone && times_[course_knot_] <= t && t < times_[course_knot_ + 1]) return course_knot_;
  return static_cast<std::size_t>(std::upper_bound(times_.begin() + 1, times_.end() - 1, t) - times_.begin()) - 1;
}

void ModalKnots::complete(std::size_t knot) {
  if (is_complete_[knot]) return;
  const auto k = static_cast<Index>(knot);
  auto a = a_.col(k).array();
  a = -modal_.frequencies().square() * q_.col(k).array() - 2.0 * modal_.decay() * v_.col(k).array();
  modal_.add_load(times_[knot], a);
  if (dynamics_.stop_count() > 0) {
    modal_.stop_displacement(q(knot), stop_displacement_.data());
    dynamics_.contact().force(stop_displacement_, stop_force_);
    for (Index i = 0; i < stop_force_.size(); ++i)
      if (stop_force_[i] != 0.0) a += stop_force_[i] * modal_.stop_shapes().col(i).array();
  }
  is_complete_[knot] = true;
}

Motion ModalKnots::motion_at(std::size_t knot, Index dof) {
  complete(knot);
  const auto k = static_cast<Index>(knot);
  const auto shape = modal_.shape_rows().col(dof);
  return {shape.dot(q_.col(k)), shape.dot(v_.col(k)), shape.dot(a_.col(k))};
}

void ModalKnots::lay_courses(std::size_t knot, std::span<const Index> dofs) {
  // What was the end of the courses laid last is most often the beginning of these.
  const bool goes_on = course_knot_ != kNone && knot == course_knot_ + 1 && std::ranges::equal(dofs, course_dofs_);
  course_knot_ = knot;
  course_dofs_.assign(dofs.begin(), dofs.end());
  course_ends_.resize(dofs.size());
  courses_.clear();
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Motion begin = goes_on ? course_ends_[i] : motion_at(knot, dofs[i]);
    course_ends_[i] = motion_at(knot + 1, dofs[i]);
    courses_.emplace_back(times_[knot + 1] - times_[knot], begin, course_ends_[i]);
  }
}

void ModalKnots::interpolate(double t, std::span<const Index> dofs, time::Interpolated out) {
  const std::size_t knot = before(t);
  if (knot != course_knot_ || !std::ranges::equal(dofs, course_dofs_)) lay_courses(knot, dofs);
  const double s = (t - times_[knot]) / (times_[knot + 1] - times_[knot]);
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const Quintic& course = courses_[i];
    if (!out.x.empty()) out.x[i] = course.value(s);
    if (!out.v.empty()) out.v[i] = course.slope(s);
    if (!out.a.empty()) out.a[i] = course.curvature(s);
  }
}

}  // namespace butee::integrators
