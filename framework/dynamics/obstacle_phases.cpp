#include <cmath>

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
    // A contact that has just closed may be at a penetration of 0 or below, by rounding or by the
    // uncertainty of the located instant.
    const ContactPhase& set = phases_[static_cast<std::size_t>(i)];
    const bool has_closed = set.touches() && !phase.touches() && now.rate > 0.0;
    const NormalPhase normal_phase = has_closed ? set.normal : phase.normal;
    const double depth = has_closed ? 0.0 : now.approach.penetration;
    const double limit = at(i).group->shape == nullptr
                             ? friction.static_coefficient * at(i).group->normal_force
                             : friction.static_coefficient * normal(at(i), normal_phase, depth, now.rate).force;
    if (limit > 0.0) {
      if (friction.stick_damping * std::abs(now.slip) <= limit) phase.slip = SlipPhase::stick;
    } else if ((has_closed || phase.touches()) && now.rate > 0.0) {
      const double growth = friction.static_coefficient * at(i).group->law->closed_stiffness() * now.rate;
      if (friction.stick_damping == 0.0 && friction.stick_stiffness * std::abs(now.slip) <= growth)
        phase.slip = SlipPhase::stick;
    }
  }
  return phase;
}

bool Obstacles::switches_by_acceleration(Index i) const {
  const model::ObstacleGroup& group = *at(i).group;
  return group.friction.rule == Friction::Rule::spring &&
         (group.friction.stick_damping > 0.0 || group.damping.kind != ImpactDamping::Kind::none);
}

double Obstacles::excess_of_slip(Index i, double t, const Kinematics& now, const Normal& pressing, double sense,
                                 ConstVectorRef a) const {
  const Friction& friction = at(i).group->friction;
  double tension = friction.stick_stiffness * now.slip, normal = pressing.by_penetration * now.rate;
  if (switches_by_acceleration(i)) {
    const Coordinates acceleration = gather(i, a);
    const double bend = now.approach.curvature, along = now.tangent.dot(now.motion.v);
    normal += pressing.by_rate * (now.approach.normal.dot(acceleration.head<2>()) + bend * along * along);
    double slip = now.lever * (now.tangent.dot(acceleration.head<2>()) - bend * now.rate * along);
    if (at(i).has_round_spring) slip -= now.lever * bend * along * now.rate;
    slip += at(i).arm * acceleration[2] + surface_acceleration(i, t);
    tension += friction.stick_damping * slip;
  }
  return (sense * tension - friction.coefficient * normal) / friction.stick_stiffness;
}

std::size_t Obstacles::switches(Index i, double t, ConstVectorRef x, ConstVectorRef v, ConstVectorRef a, double held,
                                std::array<Switch, kMostSwitches>& out) const {
  const Contact& contact = at(i);
  const model::ObstacleGroup& group = *contact.group;
  const ContactPhase phase = phases_[static_cast<std::size_t>(i)];
  std::size_t count = 0;
  const auto add = [&](double value, NormalPhase normal, SlipPhase slip, double anchor) {
    out[count++] = {value, {normal, slip, anchor, phase.angle}};
  };
  if (group.shape != nullptr && phase.normal == NormalPhase::apart) {
    add(-penetration(contact, gather(i, x).head<2>()), NormalPhase::pressed, phase.slip, phase.anchor);
    return count;
  }
  const Kinematics now = kinematics(i, t, x, v);
  const double g = now.approach.penetration;
  const bool is_of_law = group.damping.kind == ImpactDamping::Kind::law;
  const bool dissipates = group.damping.kind != ImpactDamping::Kind::none;
  if (group.shape != nullptr) {
    switch (phase.normal) {
      case NormalPhase::apart:
        break;
      case NormalPhase::released: {
        add(g, NormalPhase::apart, phase.slip, phase.anchor);
        if (is_of_law) {
          const auto branch = tells_rebound(group) && now.rate < 0.0 ? NormalPhase::receding : NormalPhase::pressed;
          add(-pressing_share(contact, branch, g, now.rate), branch, phase.slip, phase.anchor);
          return count;
        }
        const double pull = group.damping.kind == ImpactDamping::Kind::hunt_crossley
                                ? 1.0 + group.damping.coefficient * now.rate
                                : normal(contact, NormalPhase::pressed, g, now.rate).force;
        add(-pull, NormalPhase::pressed, phase.slip, phase.anchor);
        return count;
      }
      case NormalPhase::pressed:
        add(g, NormalPhase::apart, phase.slip, phase.anchor);
        if (tells_rebound(group))
          add(now.rate, NormalPhase::receding, phase.slip, phase.anchor);
        else if (group.damping.kind == ImpactDamping::Kind::hunt_crossley)
          add(1.0 + group.damping.coefficient * now.rate, NormalPhase::released, phase.slip, phase.anchor);
        else if (is_of_law)
          add(pressing_share(contact, phase.normal, g, now.rate), NormalPhase::released, phase.slip, phase.anchor);
        else if (dissipates && !group.damping.pulls)
          add(normal(contact, phase.normal, g, now.rate).force, NormalPhase::released, phase.slip, phase.anchor);
        else if (stops_rubbing(group))
          add(normal(contact, phase.normal, g, now.rate).force, NormalPhase::pulling, phase.slip, phase.anchor);
        break;
      case NormalPhase::pulling:
        add(g, NormalPhase::apart, phase.slip, phase.anchor);
        add(-normal(contact, phase.normal, g, now.rate).force, NormalPhase::pressed, phase.slip, phase.anchor);
        return count;
      case NormalPhase::receding:
        add(g, NormalPhase::apart, phase.slip, phase.anchor);
        add(-now.rate, NormalPhase::pressed, phase.slip, phase.anchor);
        if (is_of_law)
          add(pressing_share(contact, phase.normal, g, now.rate), NormalPhase::released, phase.slip, phase.anchor);
        break;
    }
  }
  const Friction& friction = group.friction;
  if (friction.rule == Friction::Rule::clip) {
    if (phase.slip != SlipPhase::backward)
      add((phase.slip == SlipPhase::forward ? 1.0 : -1.0) * (now.slip - friction.slip_speed), phase.normal,
          phase.slip == SlipPhase::forward ? SlipPhase::stick : SlipPhase::forward, 0.0);
    if (phase.slip != SlipPhase::forward)
      add((phase.slip == SlipPhase::backward ? -1.0 : 1.0) * (now.slip + friction.slip_speed), phase.normal,
          phase.slip == SlipPhase::backward ? SlipPhase::stick : SlipPhase::backward, 0.0);
  }
  if (friction.rule == Friction::Rule::sqrt || friction.rule == Friction::Rule::tanh) {
    const double border = steep_border(friction);
    if (phase.slip == SlipPhase::ahead) {
      add(now.slip - border, phase.normal, SlipPhase::smooth, 0.0);
    } else if (phase.slip == SlipPhase::behind) {
      add(-border - now.slip, phase.normal, SlipPhase::smooth, 0.0);
    } else {
      add(border - now.slip, phase.normal, SlipPhase::ahead, 0.0);
      add(border + now.slip, phase.normal, SlipPhase::behind, 0.0);
    }
  }
  if (!friction.has_memory()) return count;
  const Normal pressing = normal(contact, phase.normal, g, now.rate);
  const double force = pressing.force;
  if (phase.slip == SlipPhase::stick) {
    const double tension = friction.rule == Friction::Rule::rigid ? held : friction_force(i, t, now, phase, force);
    add(friction.static_coefficient * force - tension, phase.normal, SlipPhase::forward, 0.0);
    add(friction.static_coefficient * force + tension, phase.normal, SlipPhase::backward, 0.0);
  } else {
    const double sense = phase.slip == SlipPhase::forward ? 1.0 : -1.0;
    double anchor = 0.0, excess = sense * now.slip;
    if (friction.rule == Friction::Rule::spring) {
      const double tension = sense * friction.coefficient * force - friction.stick_damping * now.slip;
      anchor = path(i, t, now, phase.angle) - tension / friction.stick_stiffness;
      // If the limit falls faster than the spring relaxes, slip goes on although the body moves back.
      excess = excess_of_slip(i, t, now, pressing, sense, a);
    }
    add(excess, phase.normal, SlipPhase::stick, anchor);
  }
  return count;
}

}  // namespace butee::dynamics
