#include "integrators/modal_knots.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);
/// The largest |int_0^s (F - P F) ds| of a force F that rises by 1 a step from somewhere within it on, with its
/// projection P F onto P_0, P_1 and P_2.
constexpr double kKink = 4.73e-3;

}  // namespace

void StepForces::divide(double place, StepForces& second) {
  second.touched.clear();
  second.is_free = is_free;
  if (is_free) return;
  second.standing = standing;
  second.moments = moments_within<Vector>(moments, place, 1.0);
  moments = moments_within<Vector>(moments, 0.0, place);
}

ModalKnots::ModalKnots(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, std::vector<StopForce>& stops,
                       std::size_t most)
    : dynamics_(dynamics), modal_(modal), stops_(stops), motion_(modal), single_decay_(modal.decay()[0]) {
  if ((modal.decay() != single_decay_).any()) single_decay_ = -1.0;
  times_.reserve(most + 1);
  const auto columns = static_cast<Index>(most) + 1;
  const Index room = dynamics::ModalMotion::padded(modal.size());
  for (Eigen::MatrixXd* matrix : {&q_, &v_}) matrix->setZero(room, columns);
  for (Eigen::MatrixXd* matrix : {&w_, &stop_forces_}) matrix->setZero(dynamics.stop_count(), columns);
  has_forces_.assign(most + 1, false);
  has_phases_.assign(most + 1, false);
  phases_.resize((most + 1) * modal.harmonics().size());
  phases_within_.resize(modal.harmonics().size());
  forces_.resize(most + 1);
  stop_forces_within_.setZero(dynamics.stop_count());
  if (dynamics.stop_count() > 0) compliances_ = modal.stop_shapes().matrix().colwise().squaredNorm();
  for (StepForces& forces : forces_) {
    forces.standing.setZero(dynamics.stop_count());
    forces.paths.setZero(dynamics::StepFlow::padded(dynamics.stop_count()), StepForces::kColumns);
    for (Vector& moment : forces.moments) moment.setZero(room);
  }
}

void ModalKnots::begin(double t, const double* q, const double* v, const double* w) {
  times_.clear();
  begun_ = kNone;
  add(t, q, v, w);
}

void ModalKnots::add(double t, const double* q, const double* v, const double* w) {
  const std::size_t knot = times_.size();
  const auto k = static_cast<Index>(knot);
  times_.push_back(t);
  q_.col(k).head(modal_.size()) = Eigen::Map<const Vector>(q, modal_.size());
  v_.col(k).head(modal_.size()) = Eigen::Map<const Vector>(v, modal_.size());
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
  view.shape.setZero(q_.rows());
  view.of_q.setZero(q_.rows());
  view.shape.head(modal_.size()) = shape;
  view.of_q.head(modal_.size()) = -modal_.frequencies().square() * shape.array();
  if (single_decay_ < 0.0) view.of_v = -2.0 * modal_.decay() * shape.array();
  view.of_harmonics.resize(2 * static_cast<Index>(modal_.harmonics().size()));
  for (std::size_t j = 0; j < modal_.harmonics().size(); ++j) {
    view.of_harmonics[2 * static_cast<Index>(j)] = shape.dot(modal_.harmonics()[j].cosine.matrix());
    view.of_harmonics[2 * static_cast<Index>(j) + 1] = shape.dot(modal_.harmonics()[j].sine.matrix());
  }
  view.of_loads.resize(static_cast<Index>(modal_.other_loads().size()));
  for (std::size_t j = 0; j < modal_.other_loads().size(); ++j)
    view.of_loads[static_cast<Index>(j)] = shape.dot(modal_.other_loads()[j].shape.matrix());
  if (modal_.stop_count() > 0) view.of_stops = modal_.stop_shapes().matrix().transpose() * shape;
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

Motion ModalKnots::motion_of(const View& view, double t, const std::array<double, 3>& products, const double* v,
                             std::span<const Phase> phases, const Vector* stop_forces) const {
  Motion motion = {products[0], products[1], products[2]};
  motion.a += single_decay_ < 0.0 ? view.of_v.dot(Eigen::Map<const Vector>(v, view.of_v.size()))
                                  : -2.0 * single_decay_ * motion.v;
  for (std::size_t j = 0; j < phases.size(); ++j)
    motion.a += phases[j].cosine * view.of_harmonics[2 * static_cast<Index>(j)] +
                phases[j].sine * view.of_harmonics[2 * static_cast<Index>(j) + 1];
  for (std::size_t j = 0; j < modal_.other_loads().size(); ++j)
    motion.a += modal_.other_loads()[j].in_time->value(t) * view.of_loads[static_cast<Index>(j)];
  if (stop_forces != nullptr) motion.a += view.of_stops.dot(*stop_forces);
  return motion;
}

const Motion& ModalKnots::motion_at(std::size_t knot, View& view) {
  Motion& motion = view.motions[knot];
  if (view.is_known[knot]) return motion;
  view.is_known[knot] = true;
  const bool has_stops = view.of_stops.size() > 0;
  if (has_stops) {
    find_stop_forces(knot);
    stop_forces_within_ = stop_forces_.col(static_cast<Index>(knot));
  }
  return motion =
             motion_of(view, times_[knot], dynamics::ModalMotion::products(view.shape, view.of_q, q(knot), v(knot)),
                       v(knot), phases(knot), has_stops ? &stop_forces_within_ : nullptr);
}

void ModalKnots::find_contacts(std::size_t knot) {
  using Course = StopForce::Course;
  closed_.clear();
  changing_.clear();
  const StepForces& forces = forces_[knot];
  const auto k = static_cast<Index>(knot);
  const double h = times_[knot + 1] - times_[knot];
  for (const Index i : forces.touched) {
    const auto at = [&](Index column) { return forces.paths(i, column); };
    const StopForce& stop = stops_[static_cast<std::size_t>(i)];
    const double hv0 = at(StepForces::kStartSpeed), hv1 = at(StepForces::kEndSpeed);
    const Contact contact = {i,
                             {w_(i, k), hv0, w_(i, k + 1), hv1, at(StepForces::kBulge)},
                             {at(StepForces::kMoments), at(StepForces::kMoments + 1), at(StepForces::kMoments + 2)}};
    const double felt = at(StepForces::kFeltSpeed);
    const double kink = kKink * stop.stiffness() * h * std::max(std::abs(hv0), std::abs(hv1));
    const bool is_felt = (compliances_[i] * kink > felt && stop.course(contact.path) == Course::changing) ||
                         (compliances_[i] * kJump * h * stop.jump(contact.path) > felt);
    (is_felt ? changing_ : closed_).push_back(contact);
  }
}

void ModalKnots::find_within(std::size_t knot, double t) {
  const double begin = times_[knot], h = times_[knot + 1] - begin, part = (t - begin) / h;
  const StepForces& forces = forces_[knot];
  if (begun_ != knot) find_contacts(knot);
  if (begun_ != knot || !changing_.empty()) {
    const std::array<const double*, 3> moments = {forces.moments[0].data(), forces.moments[1].data(),
                                                  forces.moments[2].data()};
    motion_.begin(begin, h, q(knot), v(knot), forces.is_free ? nullptr : moments.data());
  }
  begun_ = knot;
  for (const Contact& contact : changing_) {
    StopForce& stop = stops_[static_cast<std::size_t>(contact.stop)];
    const StopPath path = contact.path.until(part);
    const ForceMoments along = stop.project(path, stop.course(path)).force,
                       projected = moments_within(contact.moments, 0.0, part);
    motion_.add_force(modal_.stop_shapes().of(contact.stop),
                      {along[0] - projected[0], along[1] - projected[1], along[2] - projected[2]}, part);
  }
  motion_.find(part);
}

ModalKnots::Modes ModalKnots::middle_of(std::size_t knot) {
  const double t = 0.5 * (times_[knot] + times_[knot + 1]);
  find_within(knot, t);
  find_phases_within(t);
  return {t, motion_.q(), motion_.v(), phases_within_};
}

void ModalKnots::find_phases_within(double t) {
  for (std::size_t j = 0; j < phases_within_.size(); ++j) {
    const double angle = modal_.harmonics()[j].angular_frequency * t;
    phases_within_[j] = {std::cos(angle), std::sin(angle)};
  }
}

void ModalKnots::find_forces_within(std::size_t knot, double t) {
  find_phases_within(t);
  const StepForces& forces = forces_[knot];
  if (forces.is_free) return;
  stop_forces_within_ = forces.standing;
  const double s = (t - times_[knot]) / (times_[knot + 1] - times_[knot]);
  for (const Contact& contact : closed_) {
    const auto [f0, f1, f2] = contact.moments;
    stop_forces_within_[contact.stop] = f0 + (2.0 * s - 1.0) * f1 + (6.0 * s * s - 6.0 * s + 1.0) * f2;
  }
  const Eigen::Map<const Vector> q(motion_.q(), modal_.size());
  for (const Contact& contact : changing_)
    stop_forces_within_[contact.stop] =
        dynamics_.contact().force_of(contact.stop, modal_.stop_shapes().of(contact.stop).dot(q));
}

void ModalKnots::interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
  asked_.clear();
  for (const Index dof : dofs) asked_.push_back(view_of(dof));
  std::size_t place = 0;
  const auto put = [&](const Motion& motion) {
    if (!out.x.empty()) out.x[place] = motion.x;
    if (!out.v.empty()) out.v[place] = motion.v;
    if (!out.a.empty()) out.a[place] = motion.a;
    ++place;
  };
  std::size_t knot = before(times.front());
  for (const double t : times) {
    while (knot + 2 < times_.size() && times_[knot + 1] <= t) ++knot;
    if (t == times_[knot]) {
      for (const std::size_t view : asked_) put(motion_at(knot, views_[view]));
      continue;
    }
    find_within(knot, t);
    if (!out.a.empty()) find_forces_within(knot, t);
    for (const std::size_t i : asked_) {
      const View& view = views_[i];
      const std::array<double, 3> products = motion_.products(view.shape, view.of_q);
      if (out.a.empty())
        put({products[0], products[1], 0.0});
      else
        put(motion_of(view, t, products, motion_.v(), phases_within_,
                      forces_[knot].is_free ? nullptr : &stop_forces_within_));
    }
  }
}

}  // namespace butee::integrators
