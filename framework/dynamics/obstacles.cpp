#include "butee/dynamics/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/core/error.hpp"

namespace butee::dynamics {
namespace {

using model::Friction;
using NormalPhase = ContactPhase::Normal;
using SlipPhase = ContactPhase::Slip;

Eigen::Vector2d tangent_to(const Eigen::Vector2d& normal) {
  return {-normal[1], normal[0]};
}

/// A distance that is within the contact's gap despite rounding.
double reach_of(const model::ContactShape::Form& form) {
  constexpr double kRounding = 1e-12;
  switch (form.kind) {
    case model::ContactShape::Form::Kind::line:
      return form.distance - kRounding * std::abs(form.distance);
    case model::ContactShape::Form::Kind::circle:
      return form.distance * (1.0 - form.sense * kRounding);
    default:
      return -std::numeric_limits<double>::infinity();
  }
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
        contact.reach = reach_of(contact.form);
        contact.is_silent_apart = free.group->law->is_silent_while_open();
        contact.rest_energy = free.group->law->energy(free.group->shape->at({0.0, 0.0}).penetration);
        contact.has_round_spring = free.group->friction.rule == Friction::Rule::spring &&
                                   contact.form.kind == model::ContactShape::Form::Kind::circle;
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

void Obstacles::follow(ConstVectorRef phases) {
  is_live_ = false;
  rubs_ = true;
  require(phases.size() == kStateSize * size(), "the phases of every contact");
  for (Index i = 0; i < size(); ++i) {
    const auto entry = phases.segment(kStateSize * i, kStateSize);
    used(i) = {static_cast<NormalPhase>(static_cast<int>(entry[0])), static_cast<SlipPhase>(static_cast<int>(entry[1])),
               entry[2], entry[3]};
  }
}

Obstacles::Coordinates Obstacles::gather(Index i, ConstVectorRef y) const {
  const model::FreeObstacles::Ends& ends = *at(i).ends;
  Coordinates value = Coordinates::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    if (ends.a[k] >= 0) value[static_cast<Index>(k)] += weight(i, k) * y[ends.a[k]];
    if (ends.b[k] >= 0) value[static_cast<Index>(k)] += weight(i, 3 + k) * y[ends.b[k]];
  }
  return value;
}

void Obstacles::scatter(Index i, const Coordinates& value, VectorRef force) const {
  const model::FreeObstacles::Ends& ends = *at(i).ends;
  for (std::size_t k = 0; k < 3; ++k) {
    if (ends.a[k] >= 0) force[ends.a[k]] += weight(i, k) * value[static_cast<Index>(k)];
    if (ends.b[k] >= 0) force[ends.b[k]] += weight(i, 3 + k) * value[static_cast<Index>(k)];
  }
}

bool Obstacles::is_apart(const Contact& contact, const Eigen::Vector2d& d) {
  switch (contact.form.kind) {
    case model::ContactShape::Form::Kind::line:
      return contact.form.place.dot(d) < contact.reach;
    case model::ContactShape::Form::Kind::circle: {
      const double square = (d - contact.form.place).squaredNorm(), border = contact.reach * contact.reach;
      return contact.form.sense > 0.0 ? square < border : square > border;
    }
    default:
      return false;
  }
}

double Obstacles::penetration(const Contact& contact, const Eigen::Vector2d& d) {
  switch (contact.form.kind) {
    case model::ContactShape::Form::Kind::line:
      return contact.form.place.dot(d) - contact.form.distance;
    case model::ContactShape::Form::Kind::circle:
      return contact.form.sense * ((d - contact.form.place).norm() - contact.form.distance);
    default:
      return contact.group->shape->at(d).penetration;
  }
}

bool Obstacles::may_touch(Index i, const Motion& from, const Motion& to, double h) const {
  const Contact& contact = at(i);
  if (contact.group->shape == nullptr) return true;
  const double way = h * (from.v.lpNorm<1>() + to.v.lpNorm<1>()) + (to.d - from.d).lpNorm<1>();
  return !(penetration(contact, from.d) < -way && penetration(contact, to.d) < -way);
}

Obstacles::Motion Obstacles::motion(Index i, ConstVectorRef x, ConstVectorRef v) const {
  const Coordinates d = gather(i, x), speed = gather(i, v);
  return {d.head<2>(), speed.head<2>(), d[2], speed[2]};
}

Obstacles::Kinematics Obstacles::kinematics(Index i, double t, ConstVectorRef x, ConstVectorRef v) const {
  const Contact& contact = at(i);
  const model::ObstacleGroup& group = *contact.group;
  Kinematics now{motion(i, x, v), {0.0, {0.0, 1.0}, 0.0}, {1.0, 0.0}, 0.0, 0.0, 0.0, 1.0};
  if (group.shape != nullptr) {
    now.approach = group.shape->at(now.motion.d);
    now.tangent = tangent_to(now.approach.normal);
    now.rate = now.approach.normal.dot(now.motion.v);
  }
  if (group.friction.rule == Friction::Rule::none) return now;
  now.surface = -group.friction.surface_speed;
  if (rotation_ != nullptr) now.surface += group.turning * rotation_->speed(t);
  now.lever = std::min(kMostLever, lever_of(contact, now.motion.d));
  now.slip = now.lever * now.tangent.dot(now.motion.v) + now.motion.rolling + now.surface;
  return now;
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
  result.force = -result.friction * now.lever * now.tangent;
  if (group.shape != nullptr) {
    result.force -= result.normal * now.approach.normal;
    result.stored = group.law->energy(now.approach.penetration);
    result.is_released = phase.normal == NormalPhase::released;
  }
  if (group.friction.rule == Friction::Rule::spring) {
    const Friction& friction = group.friction;
    const double limit = std::abs(result.friction), speed = phase.slip == SlipPhase::forward ? now.slip : -now.slip,
                 of_spring = phase.slip == SlipPhase::stick
                                 ? friction.stick_stiffness * (path(i, t, now, phase.angle) - phase.anchor)
                                 : limit - std::clamp(friction.stick_damping * speed, 0.0, limit);
    if (phase.touches()) result.stored += 0.5 * of_spring * of_spring / friction.stick_stiffness;
  }
  return result;
}

void Obstacles::add_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef force) {
  ++counters_->contact_evaluations;
  for (Index i = 0; i < size(); ++i) {
    if (is_idle(i, x)) continue;
    const ContactForces now = forces(i, t, x, v);
    if (now.normal != 0.0 || now.friction != 0.0) scatter(i, now.along_all(), force);
  }
}

double Obstacles::energy(double t, ConstVectorRef x, ConstVectorRef v) const {
  double sum = 0.0;
  for (Index i = 0; i < size(); ++i)
    if (!is_idle(i, x)) sum += forces(i, t, x, v).stored - at(i).rest_energy;
  return sum;
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

Obstacles::Coordinates Obstacles::tangent_of(Index i) const {
  const Contact& contact = at(i);
  const Eigen::Vector2d along =
      contact.group->shape == nullptr ? Eigen::Vector2d(1.0, 0.0) : tangent_to(contact.form.place);
  return {along[0], along[1], 1.0};
}

double Obstacles::surface_acceleration(Index i, double t) const {
  return rotation_ != nullptr ? group_of(i).turning * rotation_->acceleration(t) : 0.0;
}

double Obstacles::closed_stiffness(Index i) const {
  const model::ObstacleGroup& group = *at(i).group;
  return std::max(group.law != nullptr ? group.law->closed_stiffness() : 0.0, group.friction.stick_stiffness);
}

}  // namespace butee::dynamics
