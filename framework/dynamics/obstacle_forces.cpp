#include <algorithm>
#include <cmath>
#include <numbers>

#include "butee/dynamics/obstacles.hpp"

namespace butee::dynamics {
namespace {

using model::ContactShape;
using model::Friction;
using model::ImpactDamping;
using NormalPhase = ContactPhase::Normal;
using SlipPhase = ContactPhase::Slip;

/// A negligible penetration that does not become subnormal after a few roots and powers.
constexpr double kBarelyClosed = 1e-100;

}  // namespace

Obstacles::Normal Obstacles::normal(const Contact& contact, NormalPhase phase, double g, double rate) const {
  const model::ObstacleGroup& group = *contact.group;
  if (group.shape == nullptr) return {group.normal_force, group.normal_force, 0.0, 0.0};
  const model::ContactLaw& law = *group.law;
  const bool touches = phase == NormalPhase::pressed || phase == NormalPhase::receding || phase == NormalPhase::pulling;
  ++counters_->law_evaluations;
  if (group.damping.kind == ImpactDamping::Kind::law) {
    if (!touches) return {0.0, 0.0, 0.0, 0.0};
    // Beyond the end of its phase the force is continued linearly.
    const double closed = std::max(g, 0.0);
    const auto at = law.rated_force(closed, rate, phase == NormalPhase::receding);
    return {at.force + at.by_penetration * (g - closed), law.secant(closed) * closed, at.by_penetration, at.by_rate};
  }
  // A law with a slope discontinuity is continued beyond the end of its phase by the branch that is
  // valid within it.
  double secant, tangent;
  if (law.is_piecewise_linear()) {
    secant = tangent = touches || phase == NormalPhase::released ? law.closed_stiffness() : 0.0;
  } else {
    secant = law.secant(g);
    tangent = law.tangent(g);
  }
  Normal result{secant * g, secant * g, tangent, 0.0};
  if (phase == NormalPhase::released) return {0.0, 0.0, 0.0, 0.0};
  if (phase != NormalPhase::pressed && phase != NormalPhase::pulling) return result;
  const ImpactDamping& damping = group.damping;
  switch (damping.kind) {
    case ImpactDamping::Kind::none:
    case ImpactDamping::Kind::law:
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

double Obstacles::pressing_share(const Contact& contact, NormalPhase phase, double g, double rate) const {
  const double closed = std::max(g, kBarelyClosed);
  const Normal now = normal(contact, phase, closed, rate);
  const double parts = std::abs(now.elastic) + std::abs(now.force - now.elastic);
  return parts > 0.0 ? now.force / parts : 1.0;
}

Obstacles::Slide Obstacles::slide(const Friction& friction, SlipPhase phase, double w) {
  if (phase == SlipPhase::forward) return {1.0, 0.0};
  if (phase == SlipPhase::backward) return {-1.0, 0.0};
  const double scale = friction.slip_speed;
  switch (friction.rule) {
    case Friction::Rule::sqrt: {
      const double root = std::sqrt(w * w + scale * scale);
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

double Obstacles::angle_of(Index i, const Kinematics& now) const {
  const ContactShape::Form& form = at(i).form;
  if (form.kind != ContactShape::Form::Kind::circle) return 0.0;
  const Eigen::Vector2d arm = now.motion.d - form.place;
  return std::atan2(arm[1], arm[0]);
}

double Obstacles::path(Index i, double t, const Kinematics& now, double angle) const {
  const Contact& contact = at(i);
  double path = now.motion.rolled - contact.group->friction.surface_speed * t;
  if (rotation_ != nullptr) path += contact.group->turning * rotation_->angle(t);
  if (contact.form.kind != ContactShape::Form::Kind::circle) return path + now.tangent.dot(now.motion.d);
  const double turned = std::remainder(angle_of(i, now) - angle, 2.0 * std::numbers::pi);
  return path + contact.form.sense * contact.form.distance * turned;
}

double Obstacles::friction_force(Index i, double t, const Kinematics& now, const ContactPhase& phase,
                                 double normal) const {
  const model::ObstacleGroup& group = *at(i).group;
  const Friction& friction = group.friction;
  if (!rubs_ || friction.rule == Friction::Rule::none || (group.shape != nullptr && !phase.touches())) return 0.0;
  // Without memory a stick spring is unstressed.
  if (is_live_ && friction.rule == Friction::Rule::spring && phase.slip == SlipPhase::stick) return 0.0;
  const double limit = friction.coefficient * normal;
  if (friction.has_memory() && phase.slip == SlipPhase::stick) {
    if (friction.rule == Friction::Rule::rigid) return 0.0;
    return friction.stick_stiffness * (path(i, t, now, phase.angle) - phase.anchor) + friction.stick_damping * now.slip;
  }
  return limit * slide(friction, phase.slip, now.slip).share;
}

const std::vector<Obstacles::Tangent>& Obstacles::tangents(double t, ConstVectorRef x, ConstVectorRef v) {
  tangents_.clear();
  for (Index i = 0; i < size(); ++i) {
    if (is_idle(i, x)) continue;
    const Contact& contact = at(i);
    const model::ObstacleGroup& group = *contact.group;
    const Friction& friction = group.friction;
    const Kinematics now = kinematics(i, t, x, v);
    ContactPhase phase = phases_[static_cast<std::size_t>(i)];
    if (is_live_) phase = live_phase(contact, now);
    const Normal normal = this->normal(contact, phase.normal, now.approach.penetration, now.rate);
    const Eigen::Vector2d &n = now.approach.normal, &u = now.tangent;
    const double bend = now.approach.curvature, along = u.dot(now.motion.v), lever = now.lever;
    Eigen::RowVector2d normal_by_d =
        normal.by_penetration * n.transpose() + normal.by_rate * bend * along * u.transpose();
    Eigen::RowVector2d normal_by_v = normal.by_rate * n.transpose();
    if (group.shape == nullptr) normal_by_d = normal_by_v = Eigen::RowVector2d::Zero();
    Eigen::RowVector2d friction_by_d(0.0, 0.0), friction_by_v(0.0, 0.0);
    double friction_by_rolled = 0.0, friction_by_rolling = 0.0;
    double force = 0.0, friction_rate = 0.0;
    const double surface_acceleration = this->surface_acceleration(i, t);
    const bool is_unstressed = is_live_ && friction.rule == Friction::Rule::spring && phase.slip == SlipPhase::stick;
    if (rubs_ && friction.rule != Friction::Rule::none && (group.shape == nullptr || phase.touches()) &&
        !is_unstressed) {
      force = friction_force(i, t, now, phase, normal.force);
      Eigen::RowVector2d slip_by_d = -lever * bend * now.rate * u.transpose();
      if (contact.has_round_spring) slip_by_d -= lever * bend * along * n.transpose();
      if (friction.rule == Friction::Rule::spring && phase.slip == SlipPhase::stick) {
        friction_by_d = friction.stick_stiffness * lever * u.transpose() + friction.stick_damping * slip_by_d;
        friction_by_v = friction.stick_damping * lever * u.transpose();
        friction_by_rolled = friction.stick_stiffness;
        friction_by_rolling = friction.stick_damping;
        friction_rate = friction.stick_stiffness * now.surface + friction.stick_damping * surface_acceleration;
      } else if (!(friction.rule == Friction::Rule::rigid && phase.slip == SlipPhase::stick)) {
        const Slide slide = this->slide(friction, phase.slip, now.slip);
        const double mu = friction.coefficient;
        friction_by_d = mu * slide.share * normal_by_d + mu * normal.force * slide.slope * slip_by_d;
        friction_by_v = mu * slide.share * normal_by_v + mu * normal.force * slide.slope * lever * u.transpose();
        friction_by_rolling = mu * normal.force * slide.slope;
        friction_rate = mu * normal.force * slide.slope * surface_acceleration;
      }
    }
    Eigen::Matrix2d stiffness = n * normal_by_d + lever * u * friction_by_d;
    if (group.shape != nullptr)
      stiffness += normal.force * bend * u * u.transpose() - force * lever * bend * n * u.transpose();
    if (contact.has_round_spring) stiffness -= force * lever * bend * u * n.transpose();
    const auto whole = [&](const Eigen::Matrix2d& plane, const Eigen::RowVector2d& friction_by, double by_rolling) {
      Block block;
      block << plane, by_rolling * lever * u, friction_by, by_rolling;
      if (group.directions.size() == 1) {
        block.row(1).setZero();
        block.col(1).setZero();
      }
      return block;
    };
    Tangent tangent{i, whole(stiffness, friction_by_d, friction_by_rolled),
                    whole(n * normal_by_v + lever * u * friction_by_v, friction_by_v, friction_by_rolling),
                    -friction_rate * Coordinates(lever * u[0], group.directions.size() == 1 ? 0.0 : lever * u[1], 1.0)};
    if (!tangent.stiffness.isZero(0.0) || !tangent.damping.isZero(0.0)) tangents_.push_back(tangent);
  }
  return tangents_;
}

}  // namespace butee::dynamics
