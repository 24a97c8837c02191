#include "integrators/exponential/contact_error.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

double lowest_frequency(const dynamics::ModalSystem& modal) {
  return modal.size() > 0 ? modal.frequencies().minCoeff() : 0.0;
}

}  // namespace

ContactError::ContactError(const model::System& system, const dynamics::ModalSystem& modal, const StepGoal& goal,
                           std::vector<ContactForce>& contacts, const DisplacementBounds& bounds,
                           const ContactScales& scales, const ContactIteration& iteration,
                           const ResidualErrors& residual)
    : modal_(modal),
      goal_(goal),
      bounds_(bounds),
      scales_(scales),
      iteration_(iteration),
      residual_(residual),
      accounts_(account_goal(goal, lowest_frequency(modal)), static_cast<Index>(contacts.size())),
      speeds_(system, modal),
      modes_(modal, contacts, bounds.gaps(), speeds_, account_goal(goal, lowest_frequency(modal))),
      missed_(modal, contacts, speeds_),
      rounding_(Eigen::ArrayXd::Zero(modal.stop_count())) {}

void ContactError::start(double t, const double* q, const double* w, double* memory) const {
  accounts_.start(t, memory);
  memory += accounts_.memory_size();
  bool is_closed = false;
  for (Index j = 0; j < modal_.stop_count(); ++j) is_closed = is_closed || bounds_.gaps().closed_side(j, w[j]) != 0.0;
  speeds_.start(q, is_closed ? scales_.rounding_rate() : 0.0, memory);
  modes_.start(t, w, memory + speeds_.memory_size());
}

void ContactError::load(double t, const double* memory, const ModalState& state) {
  accounts_.load(memory);
  memory += accounts_.memory_size();
  speeds_.load(memory);
  speeds_.raise(state.v);
  for (Index i = 0; i < rounding_.size(); ++i)
    rounding_[i] = kRoundingOfPaths * modal_.stop_shapes().of(i).array().abs().matrix().dot(state.q.abs().matrix());
  missed_.begin();
  modes_.begin(t, memory + speeds_.memory_size(), state);
}

void ContactError::save(double* memory) const {
  accounts_.save(memory);
  memory += accounts_.memory_size();
  speeds_.save(memory);
  modes_.save(memory + speeds_.memory_size());
}

void ContactError::charge(const TriedStep& step) {
  for (const auto& [stop, error] : changes_) accounts_.charge(stop, error);
  if (step.is_near) modes_.charge(step.h);
  modes_.keep();
}

double ContactError::of_step(dynamics::ContactPropagator& flow, const TriedStep& step, double displacement) {
  const ContactPaths& paths = iteration_.paths();
  double largest = 0.0;
  for (const Index i : step.iterated) {
    const double quartic = paths.quartic()[i], beyond = std::max(0.0, std::abs(quartic) - rounding_[i]);
    const bool is_near = bounds_.is_near(i);
    double error = is_near ? beyond : residual_.jump_error(flow, i, quartic, paths.motion().end[i]);
    if (is_near && iteration_.is_touched(i)) {
      error = of_touched(flow, i, step.t_end, beyond, displacement);
    } else if (const double depth = paths.excess()[i] + kPathError * std::abs(quartic); is_near && depth > 0.0) {
      const double impulse = iteration_.stiff(flow, i) * depth;
      const ContactScale scale = scales_.of(i, paths.reached(i), displacement);
      error = std::max(error, missed_contact_error(goal_, impulse, step.h, scale.speed) * displacement);
    }
    if (residual_.any() && step.crosses_middle(i, paths.motion().end[i]))
      error = std::max(
          error, of_jump(flow, i, scales_.of(i, paths.reached(i), displacement).speed) * goal_.middle * displacement);
    largest = std::max(largest, error);
  }
  return iteration_.touched().empty()
             ? largest
             : std::max(largest, of_missed(flow, step, displacement) * goal_.middle * displacement);
}

double ContactError::of_modes(const TriedStep& step) {
  if (!modes_.any() || !step.is_near) return 0.0;
  modes_.look(step.t_end, step.to);
  return modes_.error(step.h) / modes_.allowed(step.t_end);
}

double ContactError::of_touched(dynamics::ContactPropagator& flow, Index stop, double t_end, double quartic,
                                double displacement) {
  const ContactPaths& paths = iteration_.paths();
  const double h = flow.h(), stiffness = iteration_.stiffness(stop);
  const ContactInfluence::Known& known = iteration_.influence().of(flow, stop);
  const ContactScale scale = scales_.of(stop, paths.reached(stop), displacement);
  const bool stays_closed = paths.stays_closed(stop);
  double error = path_error(quartic, stiffness * known.coupling[1][0], h, scale, stays_closed);
  if (stays_closed) {
    const double closed = closed_error(quartic, stiffness * known.coupling[1][0], h, scale);
    changes_.emplace_back(stop, closed);
    error = std::max(error, closed / accounts_.allowed_closed(stop, t_end) * goal_.middle * scale.displacement);
    if (paths.passes_inner_border(stop)) {
      const double change = change_error(stiffness * known.coupling[1][0], paths.largest_speed(stop), h, scale);
      changes_.emplace_back(stop, change);
      error = std::max(error, change / accounts_.allowed(stop, t_end) * goal_.middle * scale.displacement);
    }
  } else {
    error =
        std::max(error, slope_error(goal_, h * h * stiffness * known.unresolved, paths.largest_speed(stop), h, scale));
    if (paths.changes(stop)) {
      const double change = change_error(stiffness * known.coupling[1][0], paths.largest_speed(stop), h, scale);
      changes_.emplace_back(stop, change);
      error = std::max(error, change / accounts_.allowed(stop, t_end) * goal_.middle * scale.displacement);
    }
  }
  return error * (displacement / scale.displacement);
}

double ContactError::of_missed(dynamics::ContactPropagator& flow, const TriedStep& step, double displacement) {
  constexpr double kMissed = 5.0;
  missed_.attempt();
  for (const Index j : iteration_.touched())
    if (bounds_.is_near(j))
      missed_.add(j, iteration_.paths().of(j), scales_.of(j, {}, displacement).speed,
                  speed_error(flow, j) / modal_.stop_shapes().of(j).squaredNorm());
  const double allowed = kMissed * goal_.tolerance;
  return missed_.error(step.h, step.from.v, allowed) / allowed;
}

double ContactError::speed_error(dynamics::ContactPropagator& flow, Index stop) const {
  const ContactPaths& paths = iteration_.paths();
  if (paths.stays_closed(stop)) return 0.0;
  const double stiff = iteration_.stiffness(stop) * iteration_.influence().of(flow, stop).coupling[1][0],
               quartic = paths.quartic()[stop],
               largest = std::max(kOfSpeed * std::abs(quartic), kOfChange * paths.largest_speed(stop));
  return std::copysign(stiff * stiff * largest / flow.h(), quartic);
}

// The phases of the modes are assumed independent. A stop at rest has the speed that the jump itself causes; only
// beyond that the scales of other components mean anything. Constants: plugins/exponential/THEORY.md, section 8.1.
double ContactError::of_jump(const dynamics::ContactPropagator& flow, Index stop, double speed) {
  constexpr double kMoving = 0.25, kElsewhere = 0.1;
  const auto shape = modal_.stop_shapes().of(stop).array();
  const double jump = 2.0 * residual_.force(stop).largest();
  iteration_.influence().hidden_by_jump(flow, stop, hidden_);
  hidden_ *= jump;
  double error = (shape * hidden_).matrix().norm() / speed;
  if (jump * flow.h() * shape.matrix().squaredNorm() < kMoving * speed)
    error = std::max(error, kElsewhere * speeds_.relative(hidden_));
  return error / (kUnresolved * goal_.outputs);
}

}  // namespace butee::integrators
