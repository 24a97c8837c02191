#include "integrators/exponential/contact_iteration.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {

using dynamics::ContactPropagator;
using Eigen::ArrayXd;

ContactIteration::ContactIteration(const dynamics::ModalSystem& modal, const StepGoal& goal,
                                   std::vector<ContactForce>& contacts, const ContactGaps& gaps,
                                   const ContactScales& scales, const TriedStep& step)
    : modal_(modal),
      goal_(goal),
      contacts_(contacts),
      gaps_(gaps),
      scales_(scales),
      step_(step),
      influence_(modal, contacts),
      paths_(step, gaps) {
  for (ArrayXd* array : {&noted_.end, &noted_.speed, &noted_.middle, &moments_[0], &moments_[1], &moments_[2]})
    array->setZero(gaps.gaps().size());
  for (ArrayXd& sum : sums_) sum.setZero(modal.size());
  allowed_.setZero(gaps.gaps().size());
  touched_.reserve(contacts.size());
  is_touched_.assign(contacts.size(), 0);
  is_spring_noted_.assign(contacts.size(), 0);
}

std::optional<double> ContactIteration::solve(ContactPropagator& flow) {
  begin();
  guess(flow);
  unfinished_ = unfinished_change(goal_, flow.h());
  double last = 0.0;
  const auto displacement = [&] {
    return std::max(scales_.largest().displacement, paths_.motion().end.abs().maxCoeff());
  };
  for (int i = 0; i < kMostSweeps; ++i) {
    const double change = sweep(flow, displacement(), i > 0);
    if (!std::isfinite(change)) return std::nullopt;
    const double next = i > 0 ? change * std::min(1.0, change / last) : change;
    last = change;
    if (next > unfinished_) continue;
    paths_.find_bounds();
    return displacement();
  }
  return std::nullopt;
}

void ContactIteration::begin() {
  paths_.begin(modal_.stop_shapes());
  for (ArrayXd& moment : moments_) moment.setZero();
  for (const Index i : touched_) is_touched_[static_cast<std::size_t>(i)] = 0;
  touched_.clear();
  choose_registers();
}

void ContactIteration::choose_registers() {
  near_registers_.clear();
  far_registers_.clear();
  auto next = step_.iterated.begin();
  for (Index begin = 0, end = 0; begin < gaps_.gaps().size(); begin = end) {
    end = ContactPropagator::next_register(begin);
    const auto first = next;
    while (next != step_.iterated.end() && *next < end) ++next;
    (next != first ? near_registers_ : far_registers_).push_back(begin);
  }
}

void ContactIteration::guess(ContactPropagator& flow) {
  for (const Index i : step_.iterated) {
    const double w = step_.from.w[i], side = gaps_.closed_side(i, w);
    if (side == 0.0) {
      if (!ContactForce::is_leaving(w, gaps_.gaps()[i])) continue;
      moments_[0][i] = contacts_[static_cast<std::size_t>(i)].force_at(w);
      touch(i);
      continue;
    }
    const double stiffness = contacts_[static_cast<std::size_t>(i)].stiffness();
    const double at_start = stiffness * (side * gaps_.gaps()[i] - w),
                 half_rise = -0.5 * stiffness * paths_.start_speed()[i];
    moments_[0][i] = at_start + half_rise;
    moments_[1][i] = half_rise;
    touch(i);
  }
  flow.add_forces(touched_, moments_, near_registers_, paths_.motion());
}

double ContactIteration::sweep(ContactPropagator& flow, double displacement, bool may_skip) {
  double change = 0.0;
  for (const Index i : step_.iterated) {
    ContactForce& contact = contacts_[static_cast<std::size_t>(i)];
    if (may_skip && is_touched(i) && keeps_force(flow, i)) continue;
    const ContactPath path = paths_.of(i);
    const ContactStatus status = contact.status(path);
    if (status == ContactStatus::open && contact.is_linear() && !is_touched(i)) continue;
    const ForceMoments old = {moments_[0][i], moments_[1][i], moments_[2][i]};
    const ContactInfluence::Known& known = influence_.of(flow, i);
    const ContactNewton& newton = influence_.newton(i);
    const bool was_spring = contact.is_spring(path, status);
    note_path(i, false);
    ForceMoments projected, more;
    if (was_spring) {
      projected = contact.of_spring(path);
      more = newton.correction(known.inverse, projected, old);
    } else {
      const Projection projection = contact.project(path, status);
      projected = projection.force;
      more = newton.correction(
          status == ContactStatus::closed ? known.inverse : newton.inverse(projection.closed, known.coupling),
          projected, old);
    }
    const bool stays = more[0] == 0.0 && more[1] == 0.0 && more[2] == 0.0;
    const double moved = stays ? 0.0 : add_force(flow, i, more);
    if (!std::isfinite(moved)) return moved;
    // For a spring the linear equations already hold on the path with the new force.
    if (was_spring && is_spring(i)) note_path(i, true);
    // At a start from rest the scale is the displacement due to the force itself.
    const double allowed = allow(flow, i, std::max(displacement, std::abs(paths_.motion().end[i])));
    if (moved > 0.0) change = std::max(change, moved / allowed);
  }
  return change;
}

double ContactIteration::allow(ContactPropagator& flow, Index stop, double displacement) {
  const ContactScale scale = scales_.of(stop, paths_.reached(stop), displacement);
  const bool is_bounded = contacts_[static_cast<std::size_t>(stop)].is_bounded();
  const double change =
      (is_bounded ? allowed_change : allowed_next_change)(goal_.middle, stiff(flow, stop), flow.h(), scale);
  allowed_[stop] = std::max(change, kRoundingChange / unfinished_ * displacement);
  return allowed_[stop];
}

bool ContactIteration::is_spring(Index stop) const {
  const ContactForce& contact = contacts_[static_cast<std::size_t>(stop)];
  const ContactPath path = paths_.of(stop);
  return contact.is_spring(path, contact.status(path));
}

void ContactIteration::note_path(Index stop, bool is_spring) {
  is_spring_noted_[static_cast<std::size_t>(stop)] = is_spring ? 1 : 0;
  const dynamics::StopMotion& now = paths_.motion();
  noted_.end[stop] = now.end[stop];
  noted_.speed[stop] = now.speed[stop];
  noted_.middle[stop] = now.middle[stop];
}

bool ContactIteration::keeps_force(ContactPropagator& flow, Index stop) const {
  const dynamics::StopMotion& now = paths_.motion();
  const double end = std::abs(now.end[stop] - noted_.end[stop]), speed = std::abs(now.speed[stop] - noted_.speed[stop]),
               middle = std::abs(now.middle[stop] - noted_.middle[stop]), path = end + kBump * speed + middle;
  const double stiff = std::abs(this->stiff(flow, stop)), allowed = allowed_[stop];
  const auto i = static_cast<std::size_t>(stop);
  if (contacts_[i].is_linear() || (is_spring_noted_[i] != 0 && is_spring(stop))) {
    const double missing = stiff * (kMissingByEnd * end + kMissingBySpeed * speed + kMissingByMiddle * middle);
    return missing <= unfinished_ * allowed && path <= kOfForce * allowed;
  }
  return path * (1.0 + stiff) <= kContraction * unfinished_ * allowed;
}

void ContactIteration::touch(Index stop) {
  if (!is_touched(stop)) touched_.push_back(stop);
  is_touched_[static_cast<std::size_t>(stop)] = 1;
}

double ContactIteration::add_force(ContactPropagator& flow, Index stop, const ForceMoments& more) {
  touch(stop);
  for (std::size_t k = 0; k < 3; ++k) moments_[k][stop] += more[k];
  return flow.add_force(stop, more, kBump, near_registers_, paths_.motion());
}

void ContactIteration::complete_paths(ContactPropagator& flow) {
  flow.add_forces(touched_, moments_, far_registers_, paths_.motion());
}

void ContactIteration::apply(ContactPropagator& flow, TriedStep& step) {
  step.to.w = paths_.motion().end;
  step.to.wv = paths_.motion().speed * (1.0 / flow.h());
  if (touched_.empty()) return;
  for (std::size_t k = 0; k < kForceMoments; ++k)
    modal_.stop_shapes().force(touched_, moments_[k].data(), sums_[k].data());
  const dynamics::ModalPropagator& whole = flow.whole;
  step.to.q += sums_[0] * whole.force_q(0) + sums_[1] * whole.force_q(1) + sums_[2] * whole.force_q(2);
  step.to.v += sums_[0] * whole.force_v(0) + sums_[1] * whole.force_v(1) + sums_[2] * whole.force_v(2);
  if (step.breakpoint == 0.0) return;
  for (std::size_t k = 0; k < kForceMoments; ++k) step.add_to_middle(flow.half, k, sums_[k]);
}

}  // namespace butee::integrators
