#include "integrators/exponential/breakpoints.hpp"

#include <algorithm>
#include <cmath>

#include "butee/dynamics/modal_motion.hpp"

namespace butee::integrators {

void StepForces::divide(double place, ConstVectorRef w0, ConstVectorRef w1, StepForces& second) {
  second.is_free = is_free;
  second.touched = touched;
  if (is_free) return;
  second.constant = constant;
  second.moments = moments_within<Vector>(moments, place, 1.0);
  moments = moments_within<Vector>(moments, 0.0, place);
  for (const Index i : touched) {
    const ContactPath path(w0[i], paths(i, kStartSpeed), w1[i], paths(i, kEndSpeed), paths(i, kQuartic));
    const ForceMoments force = {paths(i, kMoments), paths(i, kMoments + 1), paths(i, kMoments + 2)};
    second.set(i, path.after(place), moments_within(force, place, 1.0), paths(i, kAllowedSpeed));
    set(i, path.until(place), moments_within(force, 0.0, place), paths(i, kAllowedSpeed));
  }
}

void StepForces::set(Index stop, const ContactPath& path, const ForceMoments& force, double allowed_speed) {
  paths(stop, kStartSpeed) = path.slope(0.0);
  paths(stop, kEndSpeed) = path.slope(1.0);
  paths(stop, kQuartic) = path.quartic();
  paths(stop, kAllowedSpeed) = allowed_speed;
  for (std::size_t k = 0; k < kForceMoments; ++k) paths(stop, kMoments + static_cast<Index>(k)) = force[k];
}

Breakpoints::Breakpoints(const dynamics::ModalSystem& modal, std::size_t most) : modal_(modal) {
  times_.reserve(most + 1);
  const auto columns = static_cast<Index>(most) + 1;
  const Index room = dynamics::ModalMotion::padded(modal.size());
  for (Eigen::MatrixXd* matrix : {&q_, &v_}) matrix->setZero(room, columns);
  w_.setZero(modal.stop_count(), columns);
  has_phases_.assign(most + 1, false);
  phases_.resize((most + 1) * modal.harmonics().size());
  forces_.resize(most + 1);
}

void Breakpoints::make_room(StepForces& forces) const {
  forces.constant.setZero(modal_.stop_count());
  forces.touched.reserve(static_cast<std::size_t>(modal_.stop_count()));
  forces.paths.setZero(dynamics::ContactPropagator::padded(modal_.stop_count()), StepForces::kColumns);
  for (Vector& moment : forces.moments) moment.setZero(dynamics::ModalMotion::padded(modal_.size()));
}

std::size_t Breakpoints::add(double t, const double* q, const double* v, const double* w) {
  const std::size_t added = times_.size();
  const auto k = static_cast<Index>(added);
  times_.push_back(t);
  q_.col(k).head(modal_.size()) = Eigen::Map<const Vector>(q, modal_.size());
  v_.col(k).head(modal_.size()) = Eigen::Map<const Vector>(v, modal_.size());
  w_.col(k) = Eigen::Map<const Vector>(w, w_.rows());
  has_phases_[added] = false;
  return added;
}

std::span<const double> Breakpoints::inner() const {
  if (times_.size() < 3) return {};
  return {times_.data() + 1, times_.size() - 2};
}

std::span<const Phase> Breakpoints::phases(std::size_t k) {
  const auto& harmonics = modal_.harmonics();
  Phase* phases = phases_.data() + k * harmonics.size();
  if (!has_phases_[k])
    for (std::size_t j = 0; j < harmonics.size(); ++j) {
      const double angle = harmonics[j].angular_frequency * times_[k];
      phases[j] = {std::cos(angle), std::sin(angle)};
    }
  has_phases_[k] = true;
  return {phases, harmonics.size()};
}

std::size_t Breakpoints::before(double t) const {
  return static_cast<std::size_t>(std::upper_bound(times_.begin() + 1, times_.end() - 1, t) - times_.begin()) - 1;
}

}  // namespace butee::integrators
