#include "integrators/exponential/residual_forces.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

using dynamics::ContactPropagator;
using Eigen::ArrayXd;

}  // namespace

ResidualErrors::ResidualErrors(const dynamics::ElasticStops& contact, const StepGoal& goal,
                               const DisplacementBounds& bounds, const ContactScales& scales, const TriedStep& step)
    : goal_(goal), bounds_(bounds), scales_(scales), step_(step) {
  const Index padded = bounds.gaps().gaps().size();
  largest_.setZero(padded);
  bends_.setZero(padded);
  shares_.setOnes(padded);
  is_constant_.setConstant(padded, false);
  for (Index i = 0; i < contact.size(); ++i) {
    forces_.emplace_back(contact, i);
    any_ = any_ || forces_.back().largest() > 0.0;
  }
  for (Index i = 0; i < contact.size() && any_; ++i) {
    largest_[i] = forces_[static_cast<std::size_t>(i)].largest();
    bends_[i] = contact.law_of(i).transition_width();
  }
}

void ResidualErrors::find_shares() {
  scales_.find_shares(step_.to.w, step_.reached.displacement, shares_);
}

void ResidualErrors::find_constant(ContactPropagator& flow, TriedStep& step) {
  const Index m = static_cast<Index>(forces_.size());
  const auto shift = largest_.head(m) * flow.mobilities().abs();
  largest_scaled_shift_ = (shift / shares_.head(m)).maxCoeff();
  // A free mass at rest soon reaches the speed that the residual force causes.
  step.reached.speed = std::max(step.reached.speed, 2.0 * shift.maxCoeff() / step.h);
  const double steps = this->steps(), most = allowed();
  const auto w0 = step.from.w.head(m), w1 = step.to.w.head(m);
  const auto part = bends_.head(m) / (bounds_.gaps().gaps().head(m) - bounds_.all().head(m));
  is_constant_.head(m) = w0 * w1 > 0.0 && w0.abs().min(w1.abs()) > shift &&
                         shift * part.square() * (steps * steps / 3.0) <= most * shares_.head(m);
}

bool ResidualErrors::may_be(ContactPropagator& flow, Index stop) const {
  const double compliance = std::abs(flow.mobilities()[stop]);
  return force(stop).constant_error(step_.from.w[stop], step_.to.w[stop], bounds_.all()[stop], compliance, steps()) <=
         shares_[stop] * allowed();
}

double ResidualErrors::jump_error(ContactPropagator& flow, Index stop, double quartic, double end) const {
  const double off = std::abs(quartic), w = step_.from.w[stop];
  if (off == 0.0) return 0.0;
  // Off w = 0 and before the bend the force changes by less than its part off/(G - |w|).
  const bool jumps = force(stop).jumps() && (w * end <= 0.0 || std::min(std::abs(w), std::abs(end)) <= off);
  const double way = jumps ? std::abs(end - w) : bounds_.gaps().gaps()[stop] - bounds_.all()[stop],
               part = off < way ? off / way : 1.0;
  return 2.0 * part * force(stop).largest() * std::abs(flow.mobilities()[stop]) * steps();
}

bool ResidualErrors::shows_jump(Index stop, double compliance) const {
  if (step_.from.w[stop] * step_.to.w[stop] > 0.0) return false;
  const double jump = 2.0 * force(stop).largest();
  return kJumpImpulse * step_.h * compliance * jump > goal_.outputs * step_.reached.speed;
}

ResidualForces::ResidualForces(const dynamics::ModalSystem& modal, dynamics::ElasticStops& contact)
    : modal_(modal), contact_(contact) {
  forces_.setZero(contact.size());
  next_forces_.setZero(contact.size());
  leaving_.reserve(static_cast<std::size_t>(contact.size()));
  modal_force_.setZero(modal.size());
}

void ResidualForces::begin(const ArrayXd& w) {
  const Index m = modal_.stop_count();
  forces_.setZero();
  modal_force_.setZero();
  leaving_.clear();
  for (Index i = 0; i < m; ++i)
    if (ContactForce::is_leaving(w[i], contact_.play_of(i).gap)) leaving_.push_back(i);
  if (leaving_.empty()) return;
  contact_.force(w.head(m).matrix(), next_forces_);
  for (const Index i : leaving_) forces_[i] = next_forces_[i];
  modal_.stop_shapes().force(leaving_, forces_.data(), modal_force_.data());
}

bool ResidualForces::update(ContactPropagator& flow, const ResidualErrors& errors, TriedStep& step) {
  const Index m = modal_.stop_count();
  const double steps = errors.steps(), most = errors.allowed();
  // The bound holds even if the forces of all stops changed their signs.
  if (2.0 * errors.largest_scaled_shift() * steps * steps <= most) return false;
  w_middle_ = 0.5 * (step.from.w + step.to.w);
  contact_.force(w_middle_.head(m).matrix(), next_forces_);
  for (const Index i : step.iterated) next_forces_[i] = 0.0;
  const auto moves = (next_forces_ - forces_).array().abs() * flow.mobilities().abs() / errors.shares().head(m);
  if (moves.maxCoeff() * steps * steps <= most) return false;
  forces_.swap(next_forces_);
  old_modal_force_ = modal_force_;
  modal_.stop_shapes().force(step.constant, forces_.data(), modal_force_.data());
  step.to.q += (modal_force_ - old_modal_force_) * flow.whole.force_q(0);
  step.to.v += (modal_force_ - old_modal_force_) * flow.whole.force_v(0);
  step.to.find_stops(modal_.stop_shapes());
  return true;
}

ResidualJumps::ResidualJumps(const dynamics::ModalSystem& modal, std::vector<ContactForce>& contacts)
    : modal_(modal), contacts_(contacts) {
  for (ArrayXd& force : by_stop_) force.setZero(ContactPropagator::padded(static_cast<Index>(contacts.size())));
  for (ArrayXd& sum : sums_) sum.setZero(modal.size());
  stops_.reserve(contacts.size());
  moments_.reserve(contacts.size());
}

bool ResidualJumps::find(ContactPropagator& flow, const ResidualErrors& errors, const TriedStep& step) {
  const double h = step.h, steps = errors.steps(), most = errors.allowed();
  stops_.clear();
  if (errors.largest_scaled_shift() * steps <= most) return false;
  for (const Index i : step.constant) {
    const double w0 = step.from.w[i], w1 = step.to.w[i], wv0 = step.from.wv[i], wv1 = step.to.wv[i];
    const double aside = kBump * h * (std::abs(wv0) + std::abs(wv1));
    if (std::min(w0, w1) > aside || std::max(w0, w1) < -aside) continue;
    if (errors.force(i).largest() * std::abs(flow.mobilities()[i]) * steps <= most * errors.shares()[i]) continue;
    stops_.push_back(i);
  }
  return !stops_.empty();
}

bool ResidualJumps::find_moved(ContactPropagator& flow, const ResidualErrors& errors, const Vector& constants,
                               const ContactPaths& paths, TriedStep& step) const {
  const double steps = errors.steps(), most = errors.allowed();
  const std::size_t before = step.crossing.size();
  for (const Index i : step.constant) {
    const double allowed = most * errors.shares()[i], compliance = std::abs(flow.mobilities()[i]) * steps;
    if (errors.force(i).largest() * compliance <= allowed) continue;
    const auto place = std::find(stops_.begin(), stops_.end(), i);
    const ContactPath path = paths.of(i);
    const bool is_jump = place != stops_.end();
    if (!is_jump && (path.lowest() > 0.0 || path.highest() < 0.0)) continue;
    const ForceMoments now = contacts_[static_cast<std::size_t>(i)].residual_moments(path);
    const ForceMoments taken =
        is_jump ? moments_[static_cast<std::size_t>(place - stops_.begin())] : ForceMoments{constants[i], 0.0, 0.0};
    double off = 0.0;
    for (std::size_t k = 0; k < kForceMoments; ++k) off += std::abs(now[k] - taken[k]);
    if (off * compliance > allowed) step.crossing.push_back(i);
  }
  return step.crossing.size() > before;
}

void ResidualJumps::add(ContactPropagator& flow, const Vector& constants, TriedStep& step) {
  moments_.clear();
  quartics_.clear();
  for (ArrayXd& force : by_stop_) force.setZero();
  for (const Index i : stops_) {
    const double w0 = step.from.w[i], w1 = step.to.w[i], hv0 = step.h * step.from.wv[i], hv1 = step.h * step.to.wv[i],
                 middle = modal_.stop_shapes().of(i).dot(step.middle.q.matrix()),
                 quartic = middle - (0.5 * (w0 + w1) + 0.125 * (hv0 - hv1));
    const ForceMoments moments = contacts_[static_cast<std::size_t>(i)].residual_moments({w0, hv0, w1, hv1, quartic});
    for (std::size_t k = 0; k < 3; ++k) by_stop_[k][i] = moments[k] - (k == 0 ? constants[i] : 0.0);
    moments_.push_back(moments);
    quartics_.push_back(quartic);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    modal_.stop_shapes().force(stops_, by_stop_[k].data(), sums_[k].data());
    step.add_to_end(flow.whole, static_cast<int>(k), sums_[k]);
    if (!step.iterated.empty() || step.breakpoint > 0.0) step.add_to_middle(flow.half, k, sums_[k]);
  }
  step.to.find_stops(modal_.stop_shapes());
}

}  // namespace butee::integrators
