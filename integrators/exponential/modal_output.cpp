#include "integrators/exponential/modal_output.hpp"

namespace butee::integrators {

ModalOutput::ModalOutput(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, Breakpoints& breakpoints,
                         MotionInStep& motion)
    : dynamics_(dynamics), modal_(modal), breakpoints_(breakpoints), motion_(motion), single_decay_(modal.decay()[0]) {
  if ((modal.decay() != single_decay_).any()) single_decay_ = -1.0;
  stop_forces_.setZero(modal.stop_count(), static_cast<Index>(breakpoints.capacity()));
  has_forces_.assign(breakpoints.capacity(), false);
}

void ModalOutput::forget(std::size_t breakpoint) {
  has_forces_[breakpoint] = false;
  for (View& view : views_) view.is_known[breakpoint] = false;
}

std::size_t ModalOutput::view_of(Index dof) {
  for (std::size_t i = 0; i < views_.size(); ++i)
    if (views_[i].dof == dof) return i;
  View& view = views_.emplace_back();
  view.dof = dof;
  const auto shape = modal_.shape_rows().col(dof);
  const Index room = dynamics::ModalMotion::padded(modal_.size());
  view.shape.setZero(room);
  view.of_q.setZero(room);
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

Motion ModalOutput::motion_of(const View& view, double t, const std::array<double, 3>& products, const double* v,
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

const Motion& ModalOutput::motion_at(std::size_t breakpoint, View& view) {
  Motion& motion = view.motions[breakpoint];
  if (view.is_known[breakpoint]) return motion;
  view.is_known[breakpoint] = true;
  const bool has_stops = view.of_stops.size() > 0;
  if (has_stops) {
    const auto k = static_cast<Index>(breakpoint);
    if (!has_forces_[breakpoint]) dynamics_.stops().force(breakpoints_.w(breakpoint), stop_forces_.col(k));
    has_forces_[breakpoint] = true;
    forces_at_ = stop_forces_.col(k);
  }
  const double *q = breakpoints_.q(breakpoint), *v = breakpoints_.v(breakpoint);
  return motion = motion_of(view, breakpoints_.time(breakpoint),
                            dynamics::ModalMotion::products(view.shape, view.of_q, q, v), v,
                            breakpoints_.phases(breakpoint), has_stops ? &forces_at_ : nullptr);
}

void ModalOutput::interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
  asked_.clear();
  for (const Index dof : dofs) asked_.push_back(view_of(dof));
  std::size_t place = 0;
  const auto put = [&](const Motion& motion) {
    if (!out.x.empty()) out.x[place] = motion.x;
    if (!out.v.empty()) out.v[place] = motion.v;
    if (!out.a.empty()) out.a[place] = motion.a;
    ++place;
  };
  std::size_t from = breakpoints_.before(times.front());
  for (const double t : times) {
    while (from + 1 < breakpoints_.steps() && breakpoints_.time(from + 1) <= t) ++from;
    if (t == breakpoints_.time(from)) {
      for (const std::size_t view : asked_) put(motion_at(from, views_[view]));
      continue;
    }
    if (times.size() == 1)
      motion_.find_and_keep(from, t);
    else
      motion_.find(from, t);
    const bool has_a = !out.a.empty();
    const std::span<const Phase> phases = has_a ? motion_.find_phases(t) : std::span<const Phase>();
    const Vector* forces = has_a ? motion_.find_forces(from, t) : nullptr;
    for (const std::size_t i : asked_) {
      const View& view = views_[i];
      const std::array<double, 3> products = motion_.products(view.shape, view.of_q);
      put(has_a ? motion_of(view, t, products, motion_.v(), phases, forces) : Motion{products[0], products[1], 0.0});
    }
  }
}

}  // namespace butee::integrators
