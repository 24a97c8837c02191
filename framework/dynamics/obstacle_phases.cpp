#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/dynamics/obstacles.hpp"

namespace butee::dynamics {
namespace {

using model::Friction;
using model::ImpactDamping;
using NormalPhase = ContactPhase::Normal;
using SlipPhase = ContactPhase::Slip;

/// True if the contact has friction and a dashpot that may pull: there is no friction while it
/// pulls.
bool stops_rubbing(const model::ObstacleGroup& group) {
  return group.damping.pulls && group.friction.rule != Friction::Rule::none;
}

/// The uncertainty of a sum of few terms relative to the sum of their magnitudes.
constexpr double kRoundingOfTerms = 8.0 * std::numeric_limits<double>::epsilon();

/// The penetration at which the growth of a force is found at its onset, m.
constexpr double kAtOnset = 1e-100;

/// A contact by Hunt and Crossley is released below this factor of its elastic force, and pressed again above twice
/// that factor.
constexpr double kNoFactor = 1e-9;

/// The magnitudes of the terms of a penetration, summed, m.
double terms_of_penetration(const model::ContactShape::Form& form, const Eigen::Vector2d& d) {
  const Eigen::Vector2d sizes = d.cwiseAbs(), place = form.place.cwiseAbs();
  return std::abs(form.distance) +
         (form.kind == model::ContactShape::Form::Kind::line ? place.dot(sizes) : sizes.sum() + place.sum());
}

/// The slip speed at which regularised friction becomes steep, m/s.
double steep_border(const Friction& friction) {
  const bool is_tanh = friction.rule == Friction::Rule::tanh;
  return (is_tanh ? ContactPhase::kSteepOfTanh : ContactPhase::kSteep) * friction.slip_speed;
}

/// True if approach and rebound are separate phases.
bool tells_rebound(const model::ObstacleGroup& group) {
  return group.damping.kind == ImpactDamping::Kind::jankowski ||
         (group.damping.kind == ImpactDamping::Kind::law &&
          group.law->rate_dependence() == model::ContactLaw::RateDependence::by_sense);
}

}  // namespace

/// The switching functions of a phase; one within its uncertainty counts as 0.
class Obstacles::SwitchList {
 public:
  SwitchList(const ContactPhase& phase, std::array<Switch, kMostSwitches>& out) : phase_(phase), out_(out) {}
  std::size_t size() const { return count_; }
  void add(double value, double uncertainty, NormalPhase normal, SlipPhase slip, double anchor) {
    out_[count_++] = {std::abs(value) <= uncertainty ? 0.0 : value, {normal, slip, anchor, phase_.angle}};
  }
  /// A change of the normal phase.
  void add(double value, double uncertainty, NormalPhase normal) {
    add(value, uncertainty, normal, phase_.slip, phase_.anchor);
  }

 private:
  const ContactPhase& phase_;
  std::array<Switch, kMostSwitches>& out_;
  std::size_t count_ = 0;
};

ContactPhase Obstacles::live_phase(const Contact& contact, const Kinematics& now) const {
  const model::ObstacleGroup& group = *contact.group;
  ContactPhase phase;
  if (group.shape == nullptr) {
    phase.normal = NormalPhase::pressed;
  } else if (now.approach.penetration > 0.0) {
    phase.normal = NormalPhase::pressed;
    if (tells_rebound(group) && now.rate < 0.0) phase.normal = NormalPhase::receding;
    if (group.damping.kind != ImpactDamping::Kind::none && !group.damping.pulls &&
        normal(contact, phase.normal, now.approach.penetration, now.rate).force < 0.0)
      phase.normal = NormalPhase::released;
    if (stops_rubbing(group) && normal(contact, phase.normal, now.approach.penetration, now.rate).force < 0.0)
      phase.normal = NormalPhase::pulling;
  }
  switch (group.friction.rule) {
    case Friction::Rule::clip:
      phase.slip = SlipPhase::stick;
      if (std::abs(now.slip) > group.friction.slip_speed)
        phase.slip = now.slip > 0.0 ? SlipPhase::forward : SlipPhase::backward;
      break;
    case Friction::Rule::spring:
    case Friction::Rule::rigid:
      phase.slip = now.slip == 0.0 ? SlipPhase::stick : now.slip > 0.0 ? SlipPhase::forward : SlipPhase::backward;
      break;
    case Friction::Rule::sqrt:
    case Friction::Rule::tanh:
      if (std::abs(now.slip) > steep_border(group.friction))
        phase.slip = now.slip > 0.0 ? SlipPhase::ahead : SlipPhase::behind;
      break;
    case Friction::Rule::none:
      break;
  }
  return phase;
}

ContactPhase Obstacles::phase_at(Index i, double t, ConstVectorRef x, ConstVectorRef v) const {
  const Kinematics now = kinematics(i, t, x, v);
  ContactPhase phase = live_phase(at(i), now);
  const Friction& friction = at(i).group->friction;
  if (friction.rule == Friction::Rule::spring) {
    phase.angle = angle_of(i, now);
    phase.anchor = path(i, t, now, phase.angle);
    // If slip begins with contact the force is still 0: the phase depends on whether the spring
    // force or the limit grows faster.
    // Where a contact has just closed, its phase is already set to closed. The penetration is 0 there, up to rounding
    // and the uncertainty of the located instant, which must not decide.
    const ContactPhase& set = phases_[static_cast<std::size_t>(i)];
    const bool has_closed = set.touches() && now.rate > 0.0;
    const NormalPhase normal_phase = has_closed ? set.normal : phase.normal;
    const double depth = has_closed ? 0.0 : now.approach.penetration;
    const Normal pressing = normal(at(i), normal_phase, depth, now.rate);
    const double limit = friction.static_coefficient * pressing.force;
    if (limit > 0.0) {
      if (friction.stick_damping * std::abs(now.slip) <= limit) phase.slip = SlipPhase::stick;
    } else if ((has_closed || phase.touches()) && now.rate > 0.0) {
      // Dissipation by a power of the penetration below 1 makes the limit grow infinitely fast.
      const double growth =
          friction.static_coefficient * now.rate / kAtOnset * normal(at(i), normal_phase, kAtOnset, now.rate).force;
      if (friction.stick_damping == 0.0 && friction.stick_stiffness * std::abs(now.slip) <= growth)
        phase.slip = SlipPhase::stick;
    }
  }
  return phase;
}

bool Obstacles::switches_by_acceleration(Index i) const {
  const model::ObstacleGroup& group = *at(i).group;
  // At a constant normal force slip ends at w = 0, where w' cannot be in its sense.
  return group.friction.rule == Friction::Rule::spring && group.shape != nullptr &&
         (group.friction.stick_damping > 0.0 || group.damping.kind != ImpactDamping::Kind::none);
}

double Obstacles::excess_of_slip(Index i, double t, const Kinematics& now, const Normal& pressing, double sense,
                                 ConstVectorRef a) const {
  const Friction& friction = at(i).group->friction;
  double tension = sense * friction.stick_stiffness * now.slip, normal = pressing.by_penetration * now.rate;
  if (switches_by_acceleration(i)) {
    const Coordinates acceleration = gather(i, a);
    const double bend = now.approach.curvature, along = now.tangent.dot(now.motion.v);
    normal += pressing.by_rate * (now.approach.normal.dot(acceleration.head<2>()) + bend * along * along);
    double slip = now.lever * (now.tangent.dot(acceleration.head<2>()) - bend * now.rate * along);
    if (at(i).has_round_spring) slip -= now.lever * bend * along * now.rate;
    slip += acceleration[2] + surface_acceleration(i, t);
    tension += friction.stick_damping * std::max(0.0, sense * slip);
  }
  const double excess = (tension - friction.coefficient * normal) / friction.stick_stiffness;
  if (friction.stick_damping == 0.0) return excess;
  return std::max(excess, sense * now.slip - friction.coefficient * pressing.force / friction.stick_damping);
}

std::size_t Obstacles::switches(Index i, double t, ConstVectorRef x, ConstVectorRef v, ConstVectorRef a, double held,
                                const Rounding& rounding, std::array<Switch, kMostSwitches>& out) const {
  const Contact& contact = at(i);
  const ContactPhase phase = phases_[static_cast<std::size_t>(i)];
  SwitchList list(phase, out);
  if (contact.group->shape != nullptr && phase.normal == NormalPhase::apart) {
    const Eigen::Vector2d d = gather(i, x).head<2>();
    list.add(-penetration(contact, d), rounding.displacement + kRoundingOfTerms * terms_of_penetration(contact.form, d),
             NormalPhase::pressed);
    return list.size();
  }
  const Kinematics now = kinematics(i, t, x, v);
  const Rounding uncertainty{
      rounding.displacement + kRoundingOfTerms * terms_of_penetration(contact.form, now.motion.d),
      rounding.velocity + kRoundingOfTerms * now.motion.v.lpNorm<1>(), rounding.of_speed};
  if (contact.group->shape != nullptr) add_normal_switches(contact, phase, now, uncertainty, list);
  if (phase.normal == NormalPhase::released || phase.normal == NormalPhase::pulling) return list.size();
  add_slip_switches(i, phase, t, now, a, held, uncertainty, list);
  return list.size();
}

void Obstacles::add_normal_switches(const Contact& contact, const ContactPhase& phase, const Kinematics& now,
                                    const Rounding& uncertainty, SwitchList& list) const {
  const model::ObstacleGroup& group = *contact.group;
  const double g = now.approach.penetration, rate = now.rate;
  const bool is_of_law = group.damping.kind == ImpactDamping::Kind::law;
  const auto add_force = [&](double sign, NormalPhase in, NormalPhase to) {
    const Normal at = normal(contact, in, g, rate);
    const double terms = std::abs(at.elastic) + std::abs(at.force - at.elastic);
    list.add(sign * at.force,
             std::abs(at.by_penetration) * uncertainty.displacement + std::abs(at.by_rate) * uncertainty.velocity +
                 kRoundingOfTerms * terms,
             to);
  };
  const auto add_share = [&](double sign, NormalPhase in, NormalPhase to) {
    list.add(sign * pressing_share(contact, in, g, rate), kRoundingOfTerms, to);
  };
  // The factor of the elastic force by Hunt and Crossley. Where it tends to 0 during a rebound, errors of the motion
  // change its sign.
  const auto add_factor = [&](double sign, NormalPhase to) {
    const double change = group.damping.coefficient * rate;
    list.add(sign * (1.0 + change) + (sign > 0.0 ? -kNoFactor : 2.0 * kNoFactor),
             group.damping.coefficient * uncertainty.velocity + kRoundingOfTerms * (1.0 + std::abs(change)), to);
  };
  // In a steady whirl the rate stays near 0, and errors of the motion change its sign again and again. The force of the
  // dashpot is continuous there.
  const double of_rate = std::max(uncertainty.velocity, uncertainty.of_speed * now.motion.v.norm());
  if (phase.normal != NormalPhase::apart) list.add(g, uncertainty.displacement, NormalPhase::apart);
  switch (phase.normal) {
    case NormalPhase::apart:
      break;
    case NormalPhase::released:
      if (is_of_law) {
        const auto branch = tells_rebound(group) && rate < 0.0 ? NormalPhase::receding : NormalPhase::pressed;
        add_share(-1.0, branch, branch);
      } else if (group.damping.kind == ImpactDamping::Kind::hunt_crossley) {
        add_factor(-1.0, NormalPhase::pressed);
      } else {
        add_force(-1.0, NormalPhase::pressed, NormalPhase::pressed);
      }
      break;
    case NormalPhase::pressed:
      if (tells_rebound(group))
        list.add(rate, of_rate, NormalPhase::receding);
      else if (group.damping.kind == ImpactDamping::Kind::hunt_crossley)
        add_factor(1.0, NormalPhase::released);
      else if (is_of_law)
        add_share(1.0, phase.normal, NormalPhase::released);
      else if (group.damping.kind != ImpactDamping::Kind::none && !group.damping.pulls)
        add_force(1.0, phase.normal, NormalPhase::released);
      else if (stops_rubbing(group))
        add_force(1.0, phase.normal, NormalPhase::pulling);
      break;
    case NormalPhase::pulling:
      add_force(-1.0, phase.normal, NormalPhase::pressed);
      break;
    case NormalPhase::receding:
      list.add(-rate, of_rate, NormalPhase::pressed);
      if (is_of_law) add_share(1.0, phase.normal, NormalPhase::released);
      break;
  }
}

void Obstacles::add_slip_switches(Index i, const ContactPhase& phase, double t, const Kinematics& now, ConstVectorRef a,
                                  double held, const Rounding& uncertainty, SwitchList& list) const {
  const Contact& contact = at(i);
  const Friction& friction = contact.group->friction;
  const double of_slip =
      now.lever * uncertainty.velocity + kRoundingOfTerms * (std::abs(now.motion.rolling) + std::abs(now.surface));
  const auto add_slip = [&](double sign, double border, SlipPhase to) {
    list.add(sign * (now.slip - border), of_slip + kRoundingOfTerms * std::abs(border), phase.normal, to, 0.0);
  };
  if (friction.rule == Friction::Rule::clip) {
    if (phase.slip != SlipPhase::backward)
      add_slip(phase.slip == SlipPhase::forward ? 1.0 : -1.0, friction.slip_speed,
               phase.slip == SlipPhase::forward ? SlipPhase::stick : SlipPhase::forward);
    if (phase.slip != SlipPhase::forward)
      add_slip(phase.slip == SlipPhase::backward ? -1.0 : 1.0, -friction.slip_speed,
               phase.slip == SlipPhase::backward ? SlipPhase::stick : SlipPhase::backward);
  }
  if (friction.rule == Friction::Rule::sqrt || friction.rule == Friction::Rule::tanh) {
    const double border = steep_border(friction);
    if (phase.slip == SlipPhase::ahead) {
      add_slip(1.0, border, SlipPhase::smooth);
    } else if (phase.slip == SlipPhase::behind) {
      add_slip(-1.0, -border, SlipPhase::smooth);
    } else {
      add_slip(-1.0, border, SlipPhase::ahead);
      add_slip(1.0, -border, SlipPhase::behind);
    }
  }
  if (!friction.has_memory()) return;
  const Normal pressing = normal(contact, phase.normal, now.approach.penetration, now.rate);
  const double force = pressing.force;
  if (phase.slip == SlipPhase::stick) {
    const double tension = friction.rule == Friction::Rule::rigid ? held : friction_force(i, t, now, phase, force);
    const double limit = friction.static_coefficient * force;
    double of_force = kRoundingOfTerms * (std::abs(limit) + std::abs(tension));
    if (friction.rule == Friction::Rule::spring) {
      const double of_path = now.lever * uncertainty.displacement +
                             kRoundingOfTerms * (std::abs(path(i, t, now, phase.angle)) + std::abs(phase.anchor));
      of_force += friction.stick_stiffness * of_path + friction.stick_damping * of_slip;
    }
    list.add(limit - tension, of_force, phase.normal, SlipPhase::forward, 0.0);
    list.add(limit + tension, of_force, phase.normal, SlipPhase::backward, 0.0);
    return;
  }
  const double sense = phase.slip == SlipPhase::forward ? 1.0 : -1.0;
  if (friction.rule == Friction::Rule::spring) {
    const double tension = sense * friction.coefficient * force - friction.stick_damping * now.slip;
    // If the limit falls faster than the spring relaxes, slip goes on although the body moves back.
    list.add(excess_of_slip(i, t, now, pressing, sense, a), 0.0, phase.normal, SlipPhase::stick,
             path(i, t, now, phase.angle) - tension / friction.stick_stiffness);
  } else {
    list.add(sense * now.slip, of_slip, phase.normal, SlipPhase::stick, 0.0);
  }
}

}  // namespace butee::dynamics
