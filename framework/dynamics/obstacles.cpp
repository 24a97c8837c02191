#include "butee/dynamics/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "butee/core/error.hpp"

namespace butee::dynamics {
namespace {

using model::Approach;
using model::ContactShape;
using model::Friction;
using model::ImpactDamping;
using NormalPhase = ContactPhase::Normal;
using SlipPhase = ContactPhase::Slip;

Eigen::Vector2d tangent_to(const Eigen::Vector2d& normal) {
  return {-normal[1], normal[0]};
}

/// The multiple of `period` nearest to 0 that differs from y by whole periods.
double nearest(double y, double period) {
  return period > 0.0 ? std::remainder(y, period) : y;
}

}  // namespace

Obstacles::Obstacles(const model::System& system, linalg::Counters& counters)
    : system_(&system),
      counters_(&counters),
      rotation_(system.model != nullptr ? system.model->rotation.get() : nullptr) {
  for (const model::FreeObstacles& free : system.obstacles)
    for (std::size_t i = 0; i < free.ends.size(); ++i) {
      Contact contact{free.group, &free.ends[i], &free.names[i], {}, 0.0};
      if (free.group->shape != nullptr) {
        contact.form = free.group->shape->form();
        contact.is_silent_apart = free.group->law->is_piecewise_linear() && free.group->law->secant(-1.0) == 0.0;
        contact.rest_energy = free.group->law->energy(free.group->shape->at({0.0, 0.0}).penetration);
      }
      contacts_.push_back(contact);
      has_rigid_friction_ = has_rigid_friction_ || free.group->friction.rule == Friction::Rule::rigid;
      for (const auto& ends : {free.ends[i].a, free.ends[i].b})
        for (const Index dof : ends)
          if (dof >= 0) dofs_.push_back(dof);
    }
  std::sort(dofs_.begin(), dofs_.end());
  dofs_.erase(std::unique(dofs_.begin(), dofs_.end()), dofs_.end());
  phases_.resize(contacts_.size());
}

bool Obstacles::touches_node(Index i, const model::DofTable& dofs, model::NodeId node) const {
  for (const auto& side : {ends_of(i).a, ends_of(i).b})
    for (const Index dof : side)
      if (dof >= 0 && dofs.free()[static_cast<std::size_t>(dof)].node == node) return true;
  return false;
}

void Obstacles::follow(ConstVectorRef phases) {
  is_live_ = false;
  require(phases.size() == kStateSize * size(), "the phases of every contact");
  for (Index i = 0; i < size(); ++i) {
    const auto entry = phases.segment(kStateSize * i, kStateSize);
    used(i) = {static_cast<NormalPhase>(static_cast<int>(entry[0])), static_cast<SlipPhase>(static_cast<int>(entry[1])),
               entry[2]};
  }
}

void Obstacles::write_phases(VectorRef phases) const {
  for (Index i = 0; i < size(); ++i) {
    const ContactPhase& phase = phases_[static_cast<std::size_t>(i)];
    phases.segment(kStateSize * i, kStateSize) << static_cast<double>(phase.normal), static_cast<double>(phase.slip),
        phase.anchor;
  }
}

Eigen::Vector2d Obstacles::gather(Index i, ConstVectorRef y) const {
  const model::FreeObstacles::Ends& ends = *at(i).ends;
  Eigen::Vector2d value(0.0, 0.0);
  for (std::size_t k = 0; k < 2; ++k) {
    if (ends.a[k] >= 0) value[static_cast<Index>(k)] += y[ends.a[k]];
    if (ends.b[k] >= 0) value[static_cast<Index>(k)] -= y[ends.b[k]];
  }
  return value;
}

void Obstacles::scatter(Index i, const Eigen::Vector2d& value, VectorRef force) const {
  const model::FreeObstacles::Ends& ends = *at(i).ends;
  for (std::size_t k = 0; k < 2; ++k) {
    if (ends.a[k] >= 0) force[ends.a[k]] += value[static_cast<Index>(k)];
    if (ends.b[k] >= 0) force[ends.b[k]] -= value[static_cast<Index>(k)];
  }
}

Obstacles::Motion Obstacles::motion(Index i, ConstVectorRef x, ConstVectorRef v) const {
  return {gather(i, x), gather(i, v)};
}

Obstacles::Kinematics Obstacles::kinematics(Index i, double t, ConstVectorRef x, ConstVectorRef v) const {
  const Contact& contact = at(i);
  const model::ObstacleGroup& group = *contact.group;
  Kinematics now{motion(i, x, v), {0.0, {0.0, 1.0}, 0.0}, {1.0, 0.0}, 0.0, 0.0, 0.0};
  if (group.shape != nullptr) {
    now.approach = group.shape->at(now.motion.d);
    now.tangent = tangent_to(now.approach.normal);
    now.rate = now.approach.normal.dot(now.motion.v);
  }
  if (group.friction.rule == Friction::Rule::none) return now;
  now.surface = -group.friction.surface_speed;
  if (group.radius != 0.0 && rotation_ != nullptr) now.surface += group.radius * rotation_->speed(t);
  now.slip = now.tangent.dot(now.motion.v) + now.surface;
  return now;
}

Obstacles::Normal Obstacles::normal(const Contact& contact, NormalPhase phase, double g, double rate) const {
  const model::ObstacleGroup& group = *contact.group;
  if (group.shape == nullptr) return {group.normal_force, group.normal_force, 0.0, 0.0};
  const model::ContactLaw& law = *group.law;
  const bool touches = phase == NormalPhase::pressed || phase == NormalPhase::receding;
  ++counters_->law_evaluations;
  // A kinked law is continued beyond the end of its phase by the branch that holds within it.
  double secant, tangent;
  if (law.is_piecewise_linear()) {
    secant = tangent = touches || phase == NormalPhase::released ? law.closed_stiffness() : 0.0;
  } else {
    secant = law.secant(g);
    tangent = law.tangent(g);
  }
  Normal result{secant * g, secant * g, tangent, 0.0};
  if (phase == NormalPhase::released) return {0.0, 0.0, 0.0, 0.0};
  if (phase != NormalPhase::pressed) return result;
  const ImpactDamping& damping = group.damping;
  switch (damping.kind) {
    case ImpactDamping::Kind::none:
      break;
    case ImpactDamping::Kind::kelvin_voigt:
      result.force += damping.coefficient * rate;
      result.by_rate = damping.coefficient;
      break;
    case ImpactDamping::Kind::hunt_crossley:
      result.by_rate = damping.coefficient * result.elastic;
      result.by_penetration = tangent * (1.0 + damping.coefficient * rate);
      result.force += result.by_rate * rate;
      break;
    case ImpactDamping::Kind::jankowski: {
      result.by_rate = 2.0 * damping.coefficient * std::sqrt(std::max(secant, 0.0) * damping.mass);
      result.force += result.by_rate * rate;
      if (g > 0.0 && secant > 0.0)
        result.by_penetration += 0.5 * result.by_rate * (tangent - secant) / (g * secant) * rate;
      break;
    }
  }
  return result;
}

ContactPhase Obstacles::live_phase(const Contact& contact, const Kinematics& now) const {
  const model::ObstacleGroup& group = *contact.group;
  ContactPhase phase;
  if (group.shape == nullptr) {
    phase.normal = NormalPhase::pressed;
  } else if (now.approach.penetration > 0.0) {
    phase.normal = NormalPhase::pressed;
    if (group.damping.kind == ImpactDamping::Kind::jankowski && now.rate < 0.0) phase.normal = NormalPhase::receding;
    if (group.damping.kind != ImpactDamping::Kind::none && !group.damping.pulls &&
        normal(contact, phase.normal, now.approach.penetration, now.rate).force < 0.0)
      phase.normal = NormalPhase::released;
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
    default:
      break;
  }
  return phase;
}

ContactPhase Obstacles::phase_at(Index i, double t, ConstVectorRef x, ConstVectorRef v) const {
  const Kinematics now = kinematics(i, t, x, v);
  ContactPhase phase = live_phase(at(i), now);
  const Friction& friction = at(i).group->friction;
  if (friction.rule == Friction::Rule::spring) {
    phase.anchor = path(i, t, now);
    // Where slip begins with contact the force is still 0: whether the spring or the limit grows faster decides.
    const double limit =
        at(i).group->shape == nullptr
            ? friction.static_coefficient * at(i).group->normal_force
            : friction.static_coefficient * normal(at(i), phase.normal, now.approach.penetration, now.rate).force;
    if (limit > 0.0) {
      if (friction.stick_damping * std::abs(now.slip) <= limit) phase.slip = SlipPhase::stick;
    } else if (phase.touches() && now.rate > 0.0) {
      const double growth = friction.static_coefficient * at(i).group->law->closed_stiffness() * now.rate;
      if (friction.stick_damping == 0.0 && friction.stick_stiffness * std::abs(now.slip) <= growth)
        phase.slip = SlipPhase::stick;
    }
  }
  return phase;
}

Obstacles::Slide Obstacles::slide(const Friction& friction, SlipPhase phase, double w) {
  if (phase == SlipPhase::forward) return {1.0, 0.0};
  if (phase == SlipPhase::backward) return {-1.0, 0.0};
  const double scale = friction.slip_speed;
  switch (friction.rule) {
    case Friction::Rule::sqrt: {
      const double root = std::hypot(w, scale);
      return {w / root, scale * scale / (root * root * root)};
    }
    case Friction::Rule::tanh: {
      const double share = std::tanh(w / scale);
      return {share, (1.0 - share) * (1.0 + share) / scale};
    }
    case Friction::Rule::clip:
      return {w / scale, 1.0 / scale};
    default:
      return {0.0, 0.0};
  }
}

double Obstacles::path(Index i, double t, const Kinematics& now) const {
  const Contact& contact = at(i);
  const model::ObstacleGroup& group = *contact.group;
  double path = -group.friction.surface_speed * t;
  if (group.radius != 0.0 && rotation_ != nullptr) path += group.radius * rotation_->angle(t);
  if (contact.form.kind == ContactShape::Form::Kind::circle) {
    const Eigen::Vector2d arm = now.motion.d - contact.form.place;
    return path + contact.form.sense * contact.form.distance * std::atan2(arm[1], arm[0]);
  }
  return path + now.tangent.dot(now.motion.d);
}

double Obstacles::stretch(Index i, double t, const Kinematics& now, double anchor) const {
  const double stretch = path(i, t, now) - anchor;
  const Contact& contact = at(i);
  if (contact.form.kind != ContactShape::Form::Kind::circle) return stretch;
  return nearest(stretch, 2.0 * std::numbers::pi * contact.form.distance);
}

double Obstacles::friction_force(Index i, double t, const Kinematics& now, const ContactPhase& phase,
                                 double normal) const {
  const model::ObstacleGroup& group = *at(i).group;
  const Friction& friction = group.friction;
  if (friction.rule == Friction::Rule::none || (group.shape != nullptr && !phase.touches())) return 0.0;
  const double limit = friction.coefficient * (group.damping.pulls ? std::max(normal, 0.0) : normal);
  if (friction.has_memory() && phase.slip == SlipPhase::stick) {
    if (friction.rule == Friction::Rule::rigid) return 0.0;
    return friction.stick_stiffness * stretch(i, t, now, phase.anchor) + friction.stick_damping * now.slip;
  }
  return limit * slide(friction, phase.slip, now.slip).share;
}

ContactForces Obstacles::forces(Index i, double t, ConstVectorRef x, ConstVectorRef v) const {
  const Contact& contact = at(i);
  const model::ObstacleGroup& group = *contact.group;
  const Kinematics now = kinematics(i, t, x, v);
  ContactPhase phase = phases_[static_cast<std::size_t>(i)];
  if (is_live_) phase = live_phase(contact, now);
  ContactForces result;
  result.penetration = now.approach.penetration;
  result.rate = now.rate;
  result.slip_speed = now.slip;
  result.surface = now.surface;
  const Normal normal = this->normal(contact, phase.normal, now.approach.penetration, now.rate);
  result.normal = normal.force;
  result.friction = friction_force(i, t, now, phase, normal.force);
  result.force = -result.friction * now.tangent;
  if (group.shape != nullptr) {
    result.force -= result.normal * now.approach.normal;
    result.stored = group.law->energy(now.approach.penetration) - contact.rest_energy;
    if (phase.normal == NormalPhase::released) result.stored = 0.0;
  }
  if (group.friction.rule == Friction::Rule::spring) {
    const double stretched = phase.slip == SlipPhase::stick ? stretch(i, t, now, phase.anchor)
                                                            : result.friction / group.friction.stick_stiffness;
    if (phase.touches()) result.stored += 0.5 * group.friction.stick_stiffness * stretched * stretched;
  }
  return result;
}

void Obstacles::add_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef force) {
  ++counters_->contact_evaluations;
  for (Index i = 0; i < size(); ++i) {
    if (is_idle(i)) continue;
    const ContactForces now = forces(i, t, x, v);
    if (now.normal != 0.0 || now.friction != 0.0) scatter(i, now.force, force);
  }
}

double Obstacles::energy(double t, ConstVectorRef x, ConstVectorRef v) const {
  double sum = 0.0;
  for (Index i = 0; i < size(); ++i)
    if (!is_idle(i)) sum += forces(i, t, x, v).stored;
  return sum;
}

std::size_t Obstacles::switches(Index i, double t, ConstVectorRef x, ConstVectorRef v, double held,
                                std::array<Switch, kMostSwitches>& out) const {
  const Contact& contact = at(i);
  const model::ObstacleGroup& group = *contact.group;
  const ContactPhase phase = phases_[static_cast<std::size_t>(i)];
  const Kinematics now = kinematics(i, t, x, v);
  const double g = now.approach.penetration;
  std::size_t count = 0;
  const auto add = [&](double value, NormalPhase normal, SlipPhase slip, double anchor) {
    out[count++] = {value, {normal, slip, anchor}};
  };
  const bool dissipates = group.damping.kind != ImpactDamping::Kind::none;
  if (group.shape != nullptr) {
    switch (phase.normal) {
      case NormalPhase::apart:
        add(-g, NormalPhase::pressed, phase.slip, phase.anchor);
        return count;
      case NormalPhase::released: {
        add(g, NormalPhase::apart, phase.slip, phase.anchor);
        const double pull = group.damping.kind == ImpactDamping::Kind::hunt_crossley
                                ? 1.0 + group.damping.coefficient * now.rate
                                : normal(contact, NormalPhase::pressed, g, now.rate).force;
        add(-pull, NormalPhase::pressed, phase.slip, phase.anchor);
        return count;
      }
      case NormalPhase::pressed:
        add(g, NormalPhase::apart, phase.slip, phase.anchor);
        if (group.damping.kind == ImpactDamping::Kind::jankowski)
          add(now.rate, NormalPhase::receding, phase.slip, phase.anchor);
        else if (group.damping.kind == ImpactDamping::Kind::hunt_crossley)
          add(1.0 + group.damping.coefficient * now.rate, NormalPhase::released, phase.slip, phase.anchor);
        else if (dissipates && !group.damping.pulls)
          add(normal(contact, phase.normal, g, now.rate).force, NormalPhase::released, phase.slip, phase.anchor);
        break;
      case NormalPhase::receding:
        add(g, NormalPhase::apart, phase.slip, phase.anchor);
        add(-now.rate, NormalPhase::pressed, phase.slip, phase.anchor);
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
  if (!friction.has_memory()) return count;
  const double force = normal(contact, phase.normal, g, now.rate).force;
  if (phase.slip == SlipPhase::stick) {
    const double tension = friction.rule == Friction::Rule::rigid ? held : friction_force(i, t, now, phase, force);
    add(friction.static_coefficient * force - tension, phase.normal, SlipPhase::forward, 0.0);
    add(friction.static_coefficient * force + tension, phase.normal, SlipPhase::backward, 0.0);
  } else {
    const double sense = phase.slip == SlipPhase::forward ? 1.0 : -1.0;
    double anchor = 0.0;
    if (friction.rule == Friction::Rule::spring) {
      const double tension = sense * friction.coefficient * force - friction.stick_damping * now.slip;
      anchor = path(i, t, now) - tension / friction.stick_stiffness;
    }
    add(sense * now.slip, phase.normal, SlipPhase::stick, anchor);
  }
  return count;
}

const std::vector<Obstacles::Tangent>& Obstacles::tangents(double t, ConstVectorRef x, ConstVectorRef v) {
  tangents_.clear();
  for (Index i = 0; i < size(); ++i) {
    if (is_idle(i)) continue;
    const Contact& contact = at(i);
    const model::ObstacleGroup& group = *contact.group;
    const Friction& friction = group.friction;
    const Kinematics now = kinematics(i, t, x, v);
    ContactPhase phase = phases_[static_cast<std::size_t>(i)];
    if (is_live_) phase = live_phase(contact, now);
    const Normal normal = this->normal(contact, phase.normal, now.approach.penetration, now.rate);
    const Eigen::Vector2d &n = now.approach.normal, &u = now.tangent;
    const double bend = now.approach.curvature, along = u.dot(now.motion.v);
    Eigen::RowVector2d normal_by_d =
        normal.by_penetration * n.transpose() + normal.by_rate * bend * along * u.transpose();
    Eigen::RowVector2d normal_by_v = normal.by_rate * n.transpose();
    if (group.shape == nullptr) normal_by_d = normal_by_v = Eigen::RowVector2d::Zero();
    Eigen::RowVector2d friction_by_d(0.0, 0.0), friction_by_v(0.0, 0.0);
    double force = 0.0, friction_rate = 0.0;
    const double surface_acceleration = this->surface_acceleration(i, t);
    if (friction.rule != Friction::Rule::none && (group.shape == nullptr || phase.touches())) {
      force = friction_force(i, t, now, phase, normal.force);
      const Eigen::RowVector2d slip_by_d = -bend * now.rate * u.transpose();
      if (friction.rule == Friction::Rule::spring && phase.slip == SlipPhase::stick) {
        const bool round = contact.form.kind == ContactShape::Form::Kind::circle;
        friction_by_d = friction.stick_stiffness * (round ? contact.form.sense * contact.form.distance * bend : 1.0) *
                            u.transpose() +
                        friction.stick_damping * slip_by_d;
        friction_by_v = friction.stick_damping * u.transpose();
        friction_rate = friction.stick_stiffness * now.surface + friction.stick_damping * surface_acceleration;
      } else if (!(friction.rule == Friction::Rule::rigid && phase.slip == SlipPhase::stick)) {
        const Slide slide = this->slide(friction, phase.slip, now.slip);
        const bool presses = !group.damping.pulls || normal.force > 0.0;
        const double mu = presses ? friction.coefficient : 0.0;
        friction_by_d = mu * slide.share * normal_by_d + mu * normal.force * slide.slope * slip_by_d;
        friction_by_v = mu * slide.share * normal_by_v + mu * normal.force * slide.slope * u.transpose();
        friction_rate = mu * normal.force * slide.slope * surface_acceleration;
      }
    }
    Tangent tangent{i, n * normal_by_d + u * friction_by_d, n * normal_by_v + u * friction_by_v, -friction_rate * u};
    if (group.shape != nullptr)
      tangent.stiffness += normal.force * bend * u * u.transpose() - force * bend * n * u.transpose();
    if (group.directions.size() == 1) {
      tangent.stiffness(0, 1) = tangent.stiffness(1, 0) = tangent.stiffness(1, 1) = 0.0;
      tangent.damping(0, 1) = tangent.damping(1, 0) = tangent.damping(1, 1) = 0.0;
      tangent.rate[1] = 0.0;
    }
    if (!tangent.stiffness.isZero(0.0) || !tangent.damping.isZero(0.0)) tangents_.push_back(tangent);
  }
  return tangents_;
}

std::vector<Index> Obstacles::rigid_sticks() const {
  std::vector<Index> all;
  if (!has_rigid_friction_ || is_live_) return all;
  for (Index i = 0; i < size(); ++i) {
    const ContactPhase& phase = phases_[static_cast<std::size_t>(i)];
    if (at(i).group->friction.rule == Friction::Rule::rigid && phase.slip == SlipPhase::stick && phase.touches())
      all.push_back(i);
  }
  return all;
}

Eigen::Vector2d Obstacles::tangent_of(Index i) const {
  const Contact& contact = at(i);
  return contact.group->shape == nullptr ? Eigen::Vector2d(1.0, 0.0) : tangent_to(contact.form.place);
}

double Obstacles::surface_acceleration(Index i, double t) const {
  const model::ObstacleGroup& group = *at(i).group;
  return group.radius != 0.0 && rotation_ != nullptr ? group.radius * rotation_->acceleration(t) : 0.0;
}

double Obstacles::closed_stiffness(Index i) const {
  const model::ObstacleGroup& group = *at(i).group;
  return std::max(group.law != nullptr ? group.law->closed_stiffness() : 0.0, group.friction.stick_stiffness);
}

}  // namespace butee::dynamics
