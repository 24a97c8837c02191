#include "integrators/exponential/motion_in_step.hpp"

#include <algorithm>
#include <cmath>

#include "integrators/exponential/error_indicators.hpp"

namespace butee::integrators {
namespace {

/// The largest number of numbers kept: 8 MB.
constexpr Index kMostNumbers = Index{1} << 20;

}  // namespace

MotionInStep::MotionInStep(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal,
                           std::vector<ContactForce>& contacts, const Breakpoints& breakpoints)
    : dynamics_(dynamics),
      modal_(modal),
      contacts_(contacts),
      breakpoints_(breakpoints),
      motion_(modal),
      most_kept_(static_cast<std::size_t>(std::max<Index>(1, kMostNumbers / (2 * motion_.padded(modal.size()))))) {
  phases_.resize(modal.harmonics().size());
  forces_.setZero(modal.stop_count());
  if (modal.stop_count() > 0) compliances_ = modal.stop_shapes().matrix().colwise().squaredNorm();
}

void MotionInStep::find_contacts(std::size_t from) {
  // Other components may be slower than the stop.
  constexpr double kOfOthers = 0.001;
  closed_.clear();
  changing_.clear();
  const StepForces& forces = breakpoints_.forces(from);
  const double h = breakpoints_.time(from + 1) - breakpoints_.time(from);
  for (const Index i : forces.touched) {
    const auto at = [&](Index column) { return forces.paths(i, column); };
    ContactForce& stop = contacts_[static_cast<std::size_t>(i)];
    const double hv0 = at(StepForces::kStartSpeed), hv1 = at(StepForces::kEndSpeed);
    const Contact contact = {i,
                             {breakpoints_.w(from)[i], hv0, breakpoints_.w(from + 1)[i], hv1, at(StepForces::kQuartic)},
                             {at(StepForces::kMoments), at(StepForces::kMoments + 1), at(StepForces::kMoments + 2)}};
    const double allowed = at(StepForces::kAllowedSpeed);
    const double by_slope =
        kSlopeImpulse * stop.stiffness_along(contact.path) * h * std::max(std::abs(hv0), std::abs(hv1));
    const auto [cubic, quartic] = stop.missed(contact.path);
    const double by_rest = kJumpImpulse * h * (std::abs(cubic) + std::abs(quartic));
    const bool is_seen =
        compliances_[i] * by_rest > kOfOthers * allowed ||
        (compliances_[i] * by_slope > allowed && stop.status(contact.path) == ContactStatus::changing) ||
        (compliances_[i] * kJumpImpulse * h * std::max(stop.jump(contact.path), stop.bend(contact.path)) > allowed);
    (is_seen ? changing_ : closed_).push_back(contact);
  }
}

void MotionInStep::find(std::size_t from, double t) {
  const double begin = breakpoints_.time(from), h = breakpoints_.time(from + 1) - begin, part = (t - begin) / h;
  const StepForces& forces = breakpoints_.forces(from);
  if (begun_ != from) find_contacts(from);
  if (begun_ != from || !changing_.empty()) {
    const std::array<const double*, 3> moments = {forces.moments[0].data(), forces.moments[1].data(),
                                                  forces.moments[2].data()};
    motion_.begin(begin, h, breakpoints_.q(from), breakpoints_.v(from), forces.is_free ? nullptr : moments.data());
  }
  begun_ = from;
  for (const Contact& contact : changing_) {
    ContactForce& stop = contacts_[static_cast<std::size_t>(contact.stop)];
    const ContactPath path = contact.path.until(part);
    const ForceMoments along = stop.project(path, stop.status(path)).force,
                       projected = moments_within(contact.moments, 0.0, part);
    motion_.add_force(modal_.stop_shapes().of(contact.stop),
                      {along[0] - projected[0], along[1] - projected[1], along[2] - projected[2]}, part);
  }
  motion_.find(part);
  q_ = motion_.q();
  v_ = motion_.v();
}

void MotionInStep::find_and_keep(std::size_t from, double t) {
  const auto room = static_cast<std::size_t>(dynamics::ModalMotion::padded(modal_.size()));
  if (const auto known = kept_.find(t); known != kept_.end()) {
    q_ = kept_motion_.data() + known->second;
    v_ = q_ + room;
    return;
  }
  find(from, t);
  if (kept_.size() == most_kept_) kept_.clear();
  const std::size_t place = 2 * room * kept_.size();
  if (kept_motion_.size() < place + 2 * room) kept_motion_.resize(std::max(place + 2 * room, 2 * place));
  std::copy_n(q_, room, kept_motion_.begin() + static_cast<std::ptrdiff_t>(place));
  std::copy_n(v_, room, kept_motion_.begin() + static_cast<std::ptrdiff_t>(place + room));
  kept_.emplace(t, place);
}

std::span<const Phase> MotionInStep::find_phases(double t) {
  for (std::size_t j = 0; j < phases_.size(); ++j) {
    const double angle = modal_.harmonics()[j].angular_frequency * t;
    phases_[j] = {std::cos(angle), std::sin(angle)};
  }
  return phases_;
}

const Vector* MotionInStep::find_forces(std::size_t from, double t) {
  const StepForces& forces = breakpoints_.forces(from);
  if (forces.is_free) return nullptr;
  forces_ = forces.constant;
  const double s = (t - breakpoints_.time(from)) / (breakpoints_.time(from + 1) - breakpoints_.time(from));
  for (const Contact& contact : closed_) {
    const auto [f0, f1, f2] = contact.moments;
    forces_[contact.stop] = f0 + (2.0 * s - 1.0) * f1 + (6.0 * s * s - 6.0 * s + 1.0) * f2;
  }
  const Eigen::Map<const Vector> q(q_, modal_.size());
  for (const Contact& contact : changing_)
    forces_[contact.stop] = dynamics_.stops().force_of(contact.stop, modal_.stop_shapes().of(contact.stop).dot(q));
  return &forces_;
}

}  // namespace butee::integrators
