#include "butee/record/contact_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "butee/core/quadrature.hpp"
#include "butee/record/bisection.hpp"
#include "butee/record/csv_writer.hpp"

namespace butee::record {
namespace {

/// A force below this fraction of the peak is not adjacent to a larger maximum, with twelve
/// instants in a step.
constexpr double kNear = 0.9;
/// Forces whose relative differences are below this are constant: the maximum between them differs by less.
constexpr double kFlat = 1e-12;
/// The distance from an end of a step, as a part of it, at which a larger force shows that the maximum lies within. The
/// maximum is missed by its square at most.
constexpr double kBeside = 1e-5;
/// The instant of a reversal, as a part of the interval or of the speed. The slip of both directions changes by its
/// square.
constexpr double kNearReversal = 1e-5;
/// A slip below this part of that so far, or of the displacements of the structure, is rounding.
constexpr double kNoSlip = 1e-13;

/// The DOFs of these contacts.
void find_dofs(const dynamics::Obstacles& obstacles, const std::vector<std::size_t>& contacts,
               std::vector<Index>& dofs) {
  dofs.clear();
  for (const std::size_t i : contacts)
    for (const auto& side : {obstacles.ends_of(static_cast<Index>(i)).a, obstacles.ends_of(static_cast<Index>(i)).b})
      for (const Index dof : side)
        if (dof >= 0) dofs.push_back(dof);
  // One DOF may belong to several contacts.
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
}

/// A contact with a dashpot that must not pull ends where its force vanishes, before the bodies separate. Its stored
/// energy is dissipated from there on, as the penetration decreases without a force.
bool is_in_contact(const dynamics::ContactForces& forces) {
  return forces.penetration > 0.0 && !forces.is_released;
}

/// The energy that an impact stores, J. What a law with a force at open contacts stores there belongs to no impact.
double stored_by_impact(const dynamics::ContactForces& forces) {
  return forces.penetration > 0.0 ? forces.stored : 0.0;
}

}  // namespace

ContactRecorder::ContactRecorder(dynamics::Dynamics& dynamics) : dynamics_(dynamics) {
  const dynamics::Obstacles& obstacles = *dynamics.obstacles();
  dofs_ = obstacles.dofs();
  if (obstacles.has_rigid_friction()) {
    dofs_.resize(static_cast<std::size_t>(dynamics.size()));
    std::iota(dofs_.begin(), dofs_.end(), Index{0});
  }
  x_values_.resize(dofs_.size());
  v_values_ = x_values_;
  x_ = v_ = Vector::Zero(dynamics.size());
  for (Index i = 0; i < obstacles.size(); ++i) {
    Watch watch;
    watch.is_support = obstacles.group_of(i).shape == nullptr;
    watch.is_stop = !watch.is_support && obstacles.group_of(i).directions.size() == 1;
    watch.current.contact = static_cast<std::size_t>(i);
    watch.current.node = obstacles.name_of(i);
    if (watch.is_stop) {
      const auto& ends = obstacles.ends_of(i);
      const std::string name = dynamics.dof_name(std::max(ends.a[0], ends.b[0]));  // "uz of rotor"
      watch.current.dof = name.substr(0, name.find(' '));
    }
    watches_.push_back(std::move(watch));
    ContactWear wear;
    wear.node = obstacles.name_of(i);
    wear.kind = obstacles.group_of(i).kind;
    wear_.push_back(std::move(wear));
  }
}

void ContactRecorder::start(const time::State& state) {
  ended_.clear();
  duration_ = 0.0;
  dynamics_.contact_forces(state.t, state.x, state.v, forces_);
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    Watch& watch = watches_[i];
    watch.touches = watch.is_support || is_in_contact(forces_[i]);
    watch.stored = watch.is_support ? forces_[i].stored : stored_by_impact(forces_[i]);
    watch.current.t_in = state.t;
    watch.current.impact_speed = std::max(0.0, forces_[i].rate);
    watch.current.peak_force = watch.touches ? forces_[i].normal : 0.0;
    watch.current.impulse = watch.current.tangential_impulse = watch.current.slip = watch.current.dissipated = 0.0;
    const ContactWear& named = wear_[i];
    wear_[i] = {named.node, named.kind};
    wear_[i].peak_force = watch.current.peak_force;
  }
}

const ContactRecorder::Forces& ContactRecorder::at(const time::AcceptedStep& step, double t) {
  const dynamics::Obstacles& obstacles = *dynamics_.obstacles();
  const auto evaluate = [&](const Vector& x, const Vector& v) {
    if (obstacles.has_rigid_friction()) return dynamics_.contact_forces(t, x, v, forces_);
    for (const std::size_t i : active_) forces_[i] = obstacles.forces(static_cast<Index>(i), t, x, v);
  };
  if (t >= step.to.t) {
    evaluate(step.to.x, step.to.v);
    return forces_;
  }
  step.motion.trace(t, dofs_, {x_values_, v_values_, {}});
  for (std::size_t k = 0; k < dofs_.size(); ++k) {
    x_[dofs_[k]] = x_values_[k];
    v_[dofs_[k]] = v_values_[k];
  }
  evaluate(x_, v_);
  return forces_;
}

void ContactRecorder::find_active(const time::AcceptedStep& step) {
  const dynamics::Obstacles& obstacles = *dynamics_.obstacles();
  const time::State &from = step.from, &to = step.to;
  // A step of several parts may go anywhere between slow ends.
  const bool may_touch_any = obstacles.is_live() && step.motion.trace_parts() > 1;
  active_.clear();
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    const auto contact = static_cast<Index>(i);
    const bool can_touch =
        may_touch_any ||
        (obstacles.is_live() ? obstacles.may_touch(contact, obstacles.motion(contact, from.x, from.v),
                                                   obstacles.motion(contact, to.x, to.v), to.t - from.t)
                             : obstacles.phase(contact).normal != dynamics::ContactPhase::Normal::apart);
    if (can_touch || watches_[i].is_support || watches_[i].touches) active_.push_back(i);
  }
  if (!obstacles.has_rigid_friction()) find_dofs(obstacles, active_, dofs_);
}

void ContactRecorder::step(const time::AcceptedStep& step) {
  ended_.reach(step.to.t);
  const double h = step.to.t - step.from.t;
  duration_ += h;
  find_active(step);
  if (active_.empty()) return;
  take(at(step, step.from.t), now_);
  for (const std::size_t i : active_) {
    const Sampled begin{step.from.t, now_[i].normal};
    watches_[i].last = {begin, begin};
    watches_[i].slip_speed = now_[i].slip_speed;
  }
  take_beside(step, step.from.t, 1.0, now_);
  // Steps of methods that follow phases end at changes of phase; with other methods contacts may
  // touch and separate between breakpoints.
  double begin = step.from.t;
  if (dynamics_.obstacles()->is_live()) {
    const auto breakpoints = step.motion.breakpoints();
    for (const double breakpoint : std::vector<double>(breakpoints.begin(), breakpoints.end())) {
      in_parts(step, begin, breakpoint);
      begin = breakpoint;
    }
  }
  in_parts(step, begin, step.to.t);
}

void ContactRecorder::in_parts(const time::AcceptedStep& step, double begin, double end) {
  const double length = (end - begin) / kParts;
  for (int part = 1; part <= kParts; ++part) {
    const double from = begin + length * (part - 1);
    integrate(step, from, part == kParts ? end : from + length);
  }
}

void ContactRecorder::take(const Forces& forces, Forces& to) const {
  to.resize(forces.size());
  for (const std::size_t i : active_) to[i] = forces[i];
}

void ContactRecorder::integrate(const time::AcceptedStep& step, double begin, double end) {
  // Each contact reverses once at most.
  for (const std::size_t i : active_) watches_[i].has_reversed = false;
  while (true) {
    std::size_t contact = 0;
    const double reversal = find_reversal(step, begin, end, contact);
    if (!(reversal < end)) return integrate_part(step, begin, end);
    take(at(step, reversal), ends_);
    integrate_part(step, begin, reversal);
    watches_[contact].has_reversed = true;
    begin = reversal;
  }
}

double ContactRecorder::find_reversal(const time::AcceptedStep& step, double begin, double end, std::size_t& contact) {
  double first = end;
  take(at(step, end), ends_);
  const double place = step.to.x.lpNorm<Eigen::Infinity>();
  for (const std::size_t i : active_) {
    const Watch& watch = watches_[i];
    if (watch.has_reversed) continue;
    const double from = watch.slip_speed, to = ends_[i].slip_speed;
    const bool counts = (std::abs(from) + std::abs(to)) * (end - begin) > kNoSlip * std::max(wear_[i].slip, place);
    if (!(from * to < 0.0) || !counts || !(watch.is_support || watch.touches || is_in_contact(ends_[i]))) continue;
    const double t =
        root_between(begin, from, end, to, kNearReversal, [&](double at_t) { return at(step, at_t)[i].slip_speed; });
    if (!(t > begin && t < first)) continue;
    first = t;
    contact = i;
  }
  return first;
}

void ContactRecorder::integrate_part(const time::AcceptedStep& step, double begin, double end) {
  for (const auto& [t, weight] : gauss_points(begin, end)) {
    take(at(step, t), now_);
    for (const std::size_t i : active_)
      if (watches_[i].is_support || is_in_contact(now_[i])) take_force(step, i, t, now_[i].normal);
    for (const std::size_t i : active_) {
      const dynamics::ContactForces& now = now_[i];
      Watch& watch = watches_[i];
      if (!watch.is_support && !is_in_contact(now)) continue;
      ContactWear& wear = wear_[i];
      // Bodies that a dashpot pulls together do not rub.
      const double slip = now.normal >= 0.0 ? std::abs(now.slip_speed) : 0.0;
      wear.work += weight * now.normal * slip;
      wear.touching += weight;
      wear.slip += weight * slip;
      wear.square += weight * now.normal * now.normal;
      const double taken = weight * (now.normal * now.rate + now.friction * now.slip_speed);
      wear.dissipated += taken;
      Impact& impact = watch.current;
      if (watch.is_stop && now.normal != 0.0) impact.side = now.force[0] * now.normal > 0.0 ? -1 : 1;
      impact.impulse += weight * now.normal;
      impact.tangential_impulse += weight * now.friction;
      impact.slip += weight * slip;
      impact.dissipated += taken;
    }
  }
  now_.swap(ends_);
  if (end == step.to.t) take_beside(step, end, -1.0, now_);
  std::vector<std::size_t> changed;
  for (const std::size_t i : active_) {
    const dynamics::ContactForces now = now_[i];
    Watch& watch = watches_[i];
    watch.slip_speed = now.slip_speed;
    if (watch.is_support) {
      wear_[i].dissipated -= now.stored - watch.stored;
      watch.stored = now.stored;
      continue;
    }
    const bool touches = is_in_contact(now);
    if (touches || watch.touches) take_force(step, i, end, now.normal);
    const double stored = stored_by_impact(now), gained = stored - watch.stored;
    wear_[i].dissipated -= gained;
    if (touches || watch.touches)
      watch.current.dissipated -= gained;
    else if (gained != 0.0)
      ended_.add_dissipated(i, -gained);
    watch.stored = stored;
    if (touches != watch.touches) changed.push_back(i);
  }
  for (const std::size_t i : changed) change(step, i, begin, end);
}

void ContactRecorder::take_force(const time::AcceptedStep& step, std::size_t contact, double t, double force) {
  Watch& watch = watches_[contact];
  const Sampled now{t, force};
  auto& [before, last] = watch.last;
  double largest = std::max(last.value, force);
  const bool is_top = before.t < last.t && last.value >= before.value && last.value >= force &&
                      last.value - std::min(before.value, force) > kFlat * last.value;
  if (is_top && last.value > kNear * watch.current.peak_force)
    largest = std::max(largest, local_maximum(before, last, now, [&](double instant) {
                                  return at(step, instant)[contact].normal;
                                }).value);
  watch.current.peak_force = std::max(watch.current.peak_force, largest);
  wear_[contact].peak_force = std::max(wear_[contact].peak_force, largest);
  before = last;
  last = now;
}

void ContactRecorder::take_beside(const time::AcceptedStep& step, double t, double side, const Forces& there) {
  const auto is_near_peak = [&](std::size_t i) {
    const Watch& watch = watches_[i];
    return !watch.is_support && (watch.touches || is_in_contact(there[i])) &&
           there[i].normal > kNear * watch.current.peak_force;
  };
  if (std::none_of(active_.begin(), active_.end(), is_near_peak)) return;
  const double beside = t + side * kBeside * (step.to.t - step.from.t);
  take(at(step, beside), beside_);
  for (const std::size_t i : active_)
    if (is_near_peak(i) && beside_[i].normal - there[i].normal > kFlat * beside_[i].normal)
      take_force(step, i, beside, beside_[i].normal);
}

void ContactRecorder::change(const time::AcceptedStep& step, std::size_t contact, double begin, double end) {
  Watch& watch = watches_[contact];
  const std::vector<std::size_t> active = std::exchange(active_, {contact});
  const dynamics::Obstacles& obstacles = *dynamics_.obstacles();
  if (!obstacles.has_rigid_friction()) find_dofs(obstacles, active_, dofs_);
  // Steps of methods that follow phases end at changes of phase.
  const double shortly_before = end - step.event_error;
  if (!obstacles.is_live() && end == step.to.t && shortly_before > begin &&
      is_in_contact(at(step, shortly_before)[contact]) == watch.touches)
    begin = end;
  end = bisect(begin, end, [&](double t) { return is_in_contact(at(step, t)[contact]) == watch.touches; });
  watch.touches = !watch.touches;
  Impact& impact = watch.current;
  if (watch.touches) {
    impact.t_in = end;
    impact.t_out.reset();
    // A dashpot may press hardest as the contact closes.
    const dynamics::ContactForces first = at(step, end)[contact];
    impact.impact_speed = first.rate;
    impact.peak_force = std::max(impact.peak_force, first.normal);
    wear_[contact].peak_force = std::max(wear_[contact].peak_force, first.normal);
  }
  active_ = active;
  if (!obstacles.has_rigid_friction()) find_dofs(obstacles, active_, dofs_);
  if (watch.touches) return;
  impact.t_out = end;
  ended_.add(impact);
  impact.peak_force = impact.impulse = impact.tangential_impulse = impact.slip = impact.dissipated = 0.0;
}

std::vector<Impact> ContactRecorder::impacts() const {
  std::vector<Impact> lasting;
  for (const Watch& watch : watches_) {
    if (watch.is_support || !watch.touches) continue;
    lasting.push_back(watch.current);
    lasting.back().t_out.reset();
  }
  std::vector<Impact> all = ended_.with(lasting);
  for (Impact& impact : all) impact.dof = watches_[impact.contact].current.dof;  // those of a checkpoint lack it
  return all;
}

std::vector<std::string> ContactRecorder::wear_columns() {
  return {"node",
          "kind",
          "work",
          "mean_power",
          "contact_share",
          "slip",
          "dissipated",
          "peak_normal_force",
          "rms_normal_force"};
}

std::string ContactRecorder::wear_line(const ContactWear& wear) const {
  const double duration = duration_ > 0.0 ? duration_ : 1.0;
  std::string line = wear.node + "," + wear.kind;
  // The sum of the parts of a run in contact throughout exceeds the run by rounding.
  const double share = std::min(1.0, wear.touching / duration);
  for (const double value : {wear.work, wear.work / duration, share, wear.slip, wear.dissipated, wear.peak_force,
                             std::sqrt(wear.square / duration)}) {
    line += ',';
    append_number(line, value);
  }
  return line;
}

void ContactRecorder::save(ByteWriter& to) const {
  to.put(duration_);
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    to.put(watches_[i].touches);
    to.put(watches_[i].stored);
    put_impact(watches_[i].current, to);
    const ContactWear& wear = wear_[i];
    for (const double number : {wear.work, wear.touching, wear.slip, wear.dissipated, wear.peak_force, wear.square})
      to.put(number);
  }
  ended_.save(to);
}

void ContactRecorder::restore(ByteReader& from) {
  from.take(duration_);
  for (std::size_t i = 0; i < watches_.size(); ++i) {
    from.take(watches_[i].touches);
    from.take(watches_[i].stored);
    take_impact(watches_[i].current, from);
    ContactWear& wear = wear_[i];
    for (double* number : {&wear.work, &wear.touching, &wear.slip, &wear.dissipated, &wear.peak_force, &wear.square})
      from.take(*number);
  }
  ended_.restore(from);
}

}  // namespace butee::record
