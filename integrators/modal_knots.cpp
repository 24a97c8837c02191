#include "integrators/modal_knots.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {

ModalKnots::ModalKnots(solve::Dynamics& dynamics, const solve::ModalSystem& modal, std::size_t most)
    : dynamics_(dynamics), modal_(modal), single_decay_(modal.decay()[0]) {
  if ((modal.decay() != single_decay_).any()) single_decay_ = -1.0;
  times_.reserve(most + 1);
  const auto columns = static_cast<Index>(most) + 1;
  for (Eigen::MatrixXd* matrix : {&q_, &v_}) matrix->setZero(modal.size(), columns);
  for (Eigen::MatrixXd* matrix : {&w_, &stop_forces_}) matrix->setZero(dynamics.stop_count(), columns);
  has_forces_.assign(most + 1, false);
  has_phases_.assign(most + 1, false);
  phases_.resize((most + 1) * modal.harmonics().size());
}

void ModalKnots::begin(double t, const double* q, const double* v, const double* w) {
  times_.clear();
  add(t, q, v, w);
}

void ModalKnots::add(double t, const double* q, const double* v, const double* w) {
  const std::size_t knot = times_.size();
  const auto k = static_cast<Index>(knot);
  times_.push_back(t);
  q_.col(k) = Eigen::Map<const Vector>(q, q_.rows());
  v_.col(k) = Eigen::Map<const Vector>(v, v_.rows());
  w_.col(k) = Eigen::Map<const Vector>(w, w_.rows());
  has_forces_[knot] = has_phases_[knot] = false;
  for (View& view : views_) view.is_known[knot] = false;
}

std::span<const double> ModalKnots::inner() const {
  if (times_.size() < 3) return {};
  return {times_.data() + 1, times_.size() - 2};
}

std::span<const Phase> ModalKnots::phases(std::size_t knot) {
  const auto& harmonics = modal_.harmonics();
  Phase* phases = phases_.data() + knot * harmonics.size();
  if (!has_phases_[knot])
    for (std::size_t j = 0; j < harmonics.size(); ++j) {
      const double angle = harmonics[j].angular_frequency * times_[knot];
      phases[j] = {std::cos(angle), std::sin(angle)};
    }
  has_phases_[knot] = true;
  return {phases, harmonics.size()};
}

std::size_t ModalKnots::before(double t) const {
  return static_cast<std::size_t>(std::upper_bound(times_.begin() + 1, times_.end() - 1, t) - times_.begin()) - 1;
}

std::size_t ModalKnots::view_of(Index dof) {
  for (std::size_t i = 0; i < views_.size(); ++i)
    if (views_[i].dof == dof) return i;
  View& view = views_.emplace_back();
  view.dof = dof;
  const auto shape = modal_.shape_rows().col(dof);
  view.of_q = -modal_.frequencies().square() * shape.array();
  if (single_decay_ < 0.0) view.of_v = -2.0 * modal_.decay() * shape.array();
  view.of_harmonics.resize(2 * static_cast<Index>(modal_.harmonics().size()));
  for (std::size_t j = 0; j < modal_.harmonics().size(); ++j) {
    view.of_harmonics[2 * static_cast<Index>(j)] = shape.dot(modal_.harmonics()[j].cosine.matrix());
    view.of_harmonics[2 * static_cast<Index>(j) + 1] = shape.dot(modal_.harmonics()[j].sine.matrix());
  }
  view.of_loads.resize(static_cast<Index>(modal_.other_loads().size()));
  for (std::size_t j = 0; j < modal_.other_loads().size(); ++j)
    view.of_loads[static_cast<Index>(j)] = shape.dot(modal_.other_loads()[j].shape.matrix());
  view.of_stops = modal_.stop_shapes().matrix().transpose() * shape;
  view.motions.resize(has_forces_.size());
  view.is_known.assign(has_forces_.size(), false);
  return views_.size() - 1;
}

void ModalKnots::find_stop_forces(std::size_t knot) {
  if (has_forces_[knot]) return;
  const auto k = static_cast<Index>(knot);
  dynamics_.contact().force(w_.col(k), stop_forces_.col(k));
  has_forces_[knot] = true;
}

const Motion& ModalKnots::motion_at(std::size_t knot, View& view) {
  Motion& motion = view.motions[knot];
  if (view.is_known[knot]) return motion;
  view.is_known[knot] = true;
  const auto k = static_cast<Index>(knot);
  const auto shape = modal_.shape_rows().col(view.dof);
  motion = {shape.dot(q_.col(k)), shape.dot(v_.col(k)), view.of_q.dot(q_.col(k))};
  motion.a += single_decay_ < 0.0 ? view.of_v.dot(v_.col(k)) : -2.0 * single_decay_ * motion.v;
  const std::span<const Phase> turned = phases(knot);
  for (std::size_t j = 0; j < turned.size(); ++j)
    motion.a += turned[j].cosine * view.of_harmonics[2 * static_cast<Index>(j)] +
                turned[j].sine * view.of_harmonics[2 * static_cast<Index>(j) + 1];
  for (std::size_t j = 0; j < modal_.other_loads().size(); ++j)
    motion.a += modal_.other_loads()[j].in_time->value(times_[knot]) * view.of_loads[static_cast<Index>(j)];
  if (view.of_stops.size() == 0) return motion;
  find_stop_forces(knot);
  motion.a += view.of_stops.dot(stop_forces_.col(k));
  return motion;
}

void ModalKnots::interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
  asked_.clear();
  for (const Index dof : dofs) asked_.push_back(view_of(dof));
  const auto put = [&](std::size_t place, const Motion& motion) {
    if (!out.x.empty()) out.x[place] = motion.x;
    if (!out.v.empty()) out.v[place] = motion.v;
    if (!out.a.empty()) out.a[place] = motion.a;
  };
  std::size_t knot = before(times.front()), laid = times_.size();
  for (std::size_t i = 0, place = 0; i < times.size(); ++i) {
    const double t = times[i];
    while (knot + 2 < times_.size() && times_[knot + 1] <= t) ++knot;
    if (t == times_[knot]) {
      for (const std::size_t view : asked_) put(place++, motion_at(knot, views_[view]));
      continue;
    }
    const double h = times_[knot + 1] - times_[knot], s = (t - times_[knot]) / h;
    if (laid != knot) {
      courses_.clear();
      for (const std::size_t view : asked_)
        courses_.emplace_back(h, motion_at(knot, views_[view]), motion_at(knot + 1, views_[view]));
      laid = knot;
    }
    for (const Quintic& course : courses_) put(place++, {course.value(s), course.slope(s), course.curvature(s)});
  }
}

}  // namespace butee::integrators
