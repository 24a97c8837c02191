#include "integrators/obstacle_series.hpp"

#include <cmath>

#include "butee/core/error.hpp"

namespace butee::integrators {
namespace {

using dynamics::ContactPhase;
using model::ContactShape;
using model::Friction;
using model::ImpactDamping;
using Series = std::vector<double>;

/// Coefficient k of the product a b.
double product(const Series& a, const Series& b, Index k) {
  double sum = 0.0;
  for (Index j = 0; j <= k; ++j) sum += a[static_cast<std::size_t>(j)] * b[static_cast<std::size_t>(k - j)];
  return sum;
}

/// Coefficient k > 0 of p^alpha; y holds the lower coefficients.
double power(const Series& p, double alpha, const Series& y, Index k) {
  double sum = 0.0;
  for (Index j = 1; j <= k; ++j)
    sum += (static_cast<double>(j) * alpha - static_cast<double>(k - j)) * p[static_cast<std::size_t>(j)] *
           y[static_cast<std::size_t>(k - j)];
  return sum / (static_cast<double>(k) * p[0]);
}

}  // namespace

ObstacleSeries::ObstacleSeries(dynamics::Dynamics& dynamics, int order)
    : dynamics_(dynamics), obstacles_(*dynamics.obstacles()), terms_(static_cast<std::size_t>(order) + 1) {
  for (Index i = 0; i < obstacles_.size(); ++i) {
    const model::ObstacleGroup& group = obstacles_.group_of(i);
    if (group.shape == nullptr) continue;
    if (!group.law->is_piecewise_linear() || group.damping.kind == ImpactDamping::Kind::law ||
        group.shape->form().kind == ContactShape::Form::Kind::other)
      throw InputError("integrator.type: exact treats a " + group.kind +
                       " only with law = \"linear\" and a straight or circular border");
  }
}

void ObstacleSeries::begin(double t, ConstVectorRef x, ConstVectorRef v, double length) {
  length_ = length;
  std::size_t used = 0;
  for (Index i = 0; i < obstacles_.size(); ++i) {
    const ContactPhase phase = obstacles_.phase(i);
    const model::ObstacleGroup& group = obstacles_.group_of(i);
    if (group.shape != nullptr && !phase.touches() && phase.normal != ContactPhase::Normal::pulling) continue;
    if (used == contacts_.size()) {
      contacts_.emplace_back();
      Contact& fresh = contacts_.back();
      for (Plane* plane : {&fresh.d, &fresh.v, &fresh.normal, &fresh.tangent})
        for (Series* series : {&plane->y, &plane->z}) series->assign(terms_, 0.0);
      for (Series* series : {&fresh.square, &fresh.radius, &fresh.inverse, &fresh.penetration, &fresh.rate,
                             &fresh.pressing, &fresh.along, &fresh.slip, &fresh.smooth, &fresh.root, &fresh.share,
                             &fresh.path, &fresh.friction, &fresh.turning})
        series->assign(terms_, 0.0);
    }
    Contact& contact = contacts_[used++];
    contact.index = i;
    contact.phase = phase;
    const dynamics::ContactForces now = obstacles_.forces(i, t, x, v);
    contact.surface = now.surface;
    contact.surface_rate = length * obstacles_.surface_acceleration(i, t);
    const Friction& friction = group.friction;
    contact.stretch = friction.rule == Friction::Rule::spring
                          ? (now.friction - friction.stick_damping * now.slip_speed) / friction.stick_stiffness
                          : 0.0;
  }
  contacts_.resize(used);
}

void ObstacleSeries::add(Index k, ConstVectorRef x, ConstVectorRef v, VectorRef force) {
  const auto at = static_cast<std::size_t>(k);
  for (Contact& contact : contacts_) {
    const auto d = obstacles_.gather(contact.index, x), speed = obstacles_.gather(contact.index, v);
    contact.d.y[at] = d[0];
    contact.d.z[at] = d[1];
    contact.v.y[at] = speed[0];
    contact.v.z[at] = speed[1];
    contact.turning[at] = speed[2];
    add(contact, k, force);
  }
}

void ObstacleSeries::place(Contact& contact, Index k) {
  const auto at = static_cast<std::size_t>(k);
  const model::ObstacleGroup& group = obstacles_.group_of(contact.index);
  Plane &n = contact.normal, &t = contact.tangent;
  if (group.shape == nullptr) {
    t.y[at] = k == 0 ? 1.0 : 0.0;
    t.z[at] = n.y[at] = n.z[at] = 0.0;
    return;
  }
  const ContactShape::Form form = group.shape->form();
  if (form.kind == ContactShape::Form::Kind::line) {
    n.y[at] = k == 0 ? form.place[0] : 0.0;
    n.z[at] = k == 0 ? form.place[1] : 0.0;
    contact.penetration[at] = form.place[0] * contact.d.y[at] + form.place[1] * contact.d.z[at];
    if (k == 0) contact.penetration[0] -= form.distance;
  } else {
    Plane& arm = contact.d;
    if (k == 0) {
      arm.y[0] -= form.place[0];
      arm.z[0] -= form.place[1];
    }
    contact.square[at] = product(arm.y, arm.y, k) + product(arm.z, arm.z, k);
    if (k == 0 && contact.square[0] == 0.0)
      throw RunError(obstacles_.name_of(contact.index) +
                     " is in the centre of a ring without a gap, where its normal has no direction and exact has no "
                     "series; take dopri5, extrapolation8 or rodas4");
    contact.radius[at] = k == 0 ? std::sqrt(contact.square[0]) : power(contact.square, 0.5, contact.radius, k);
    contact.inverse[at] = k == 0 ? 1.0 / contact.radius[0] : power(contact.square, -0.5, contact.inverse, k);
    n.y[at] = form.sense * product(arm.y, contact.inverse, k);
    n.z[at] = form.sense * product(arm.z, contact.inverse, k);
    contact.penetration[at] = form.sense * (contact.radius[at] - (k == 0 ? form.distance : 0.0));
  }
  if (group.friction.rule == Friction::Rule::spring && form.kind == ContactShape::Form::Kind::circle) {
    // With the lever of a spring at the radius of the gap, see Obstacles.
    if (k == 0 && form.distance * contact.inverse[0] > dynamics::Obstacles::kMostLever)
      throw RunError(obstacles_.name_of(contact.index) +
                     " is nearer to the centre of a ring than half its gap, where the lever of its stick spring is "
                     "limited and exact has no series; take dopri5, extrapolation8 or rodas4");
    t.y[at] = -form.distance * product(contact.inverse, n.z, k);
    t.z[at] = form.distance * product(contact.inverse, n.y, k);
  } else {
    t.y[at] = -n.z[at];
    t.z[at] = n.y[at];
  }
  contact.rate[at] = product(n.y, contact.v.y, k) + product(n.z, contact.v.z, k);
}

double ObstacleSeries::press(Contact& contact, Index k) {
  const auto at = static_cast<std::size_t>(k);
  const model::ObstacleGroup& group = obstacles_.group_of(contact.index);
  if (group.shape == nullptr) return k == 0 ? group.normal_force : 0.0;
  const double elastic = group.law->closed_stiffness() * contact.penetration[at];
  switch (group.damping.kind) {
    case ImpactDamping::Kind::kelvin_voigt:
      return elastic + group.damping.coefficient * contact.rate[at];
    case ImpactDamping::Kind::hunt_crossley:
      return elastic +
             group.law->closed_stiffness() * group.damping.coefficient * product(contact.penetration, contact.rate, k);
    default:
      return elastic;
  }
}

double ObstacleSeries::rub(Contact& contact, Index k) {
  if (contact.phase.normal == ContactPhase::Normal::pulling) return 0.0;
  const auto at = static_cast<std::size_t>(k);
  const model::ObstacleGroup& group = obstacles_.group_of(contact.index);
  const Friction& friction = group.friction;
  contact.along[at] = product(contact.tangent.y, contact.v.y, k) + product(contact.tangent.z, contact.v.z, k);
  const double surface = k == 0 ? contact.surface : k == 1 ? contact.surface_rate : 0.0;
  contact.slip[at] = contact.along[at] + contact.turning[at] + surface;
  const bool slides =
      contact.phase.slip == ContactPhase::Slip::forward || contact.phase.slip == ContactPhase::Slip::backward;
  if (slides) {
    const double sense = contact.phase.slip == ContactPhase::Slip::forward ? 1.0 : -1.0;
    return sense * friction.coefficient * contact.pressing[at];
  }
  switch (friction.rule) {
    case Friction::Rule::none:
    case Friction::Rule::rigid:
      return 0.0;
    case Friction::Rule::spring: {
      // The rate of the path is the slip speed.
      contact.path[at] = k == 0 ? contact.stretch : length_ / static_cast<double>(k) * contact.slip[at - 1];
      return friction.stick_stiffness * contact.path[at] + friction.stick_damping * contact.slip[at];
    }
    case Friction::Rule::sqrt:
      contact.smooth[at] =
          product(contact.slip, contact.slip, k) + (k == 0 ? friction.slip_speed * friction.slip_speed : 0.0);
      contact.root[at] = k == 0 ? 1.0 / std::sqrt(contact.smooth[0]) : power(contact.smooth, -0.5, contact.root, k);
      contact.share[at] = product(contact.slip, contact.root, k);
      break;
    case Friction::Rule::tanh: {
      double& y = contact.share[at];
      if (k == 0) {
        y = std::tanh(contact.slip[0] / friction.slip_speed);
      } else {
        y = 0.0;
        for (Index j = 1; j <= k; ++j)
          y += static_cast<double>(j) * contact.slip[static_cast<std::size_t>(j)] *
               contact.root[static_cast<std::size_t>(k - j)];
        y /= friction.slip_speed * static_cast<double>(k);
      }
      // 1 - y^2, accurate also if y = 1 to rounding.
      if (k == 0) {
        const double inverse = 1.0 / std::cosh(contact.slip[0] / friction.slip_speed);
        contact.root[0] = inverse * inverse;
      } else {
        contact.root[at] = -product(contact.share, contact.share, k);
      }
      break;
    }
    case Friction::Rule::clip:
      contact.share[at] = contact.slip[at] / friction.slip_speed;
      break;
  }
  return friction.coefficient * product(contact.pressing, contact.share, k);
}

bool ObstacleSeries::is_round_spring(const model::ObstacleGroup& group) {
  if (group.shape == nullptr) return false;
  const ContactShape::Form form = group.shape->form();
  return form.kind == ContactShape::Form::Kind::circle && form.sense > 0.0 && form.distance == 0.0 &&
         group.damping.kind == ImpactDamping::Kind::none && group.friction.rule == Friction::Rule::none;
}

void ObstacleSeries::add(Contact& contact, Index k, VectorRef force) {
  const auto at = static_cast<std::size_t>(k);
  if (const model::ObstacleGroup& group = obstacles_.group_of(contact.index); is_round_spring(group)) {
    Eigen::Vector2d arm(contact.d.y[at], contact.d.z[at]);
    if (k == 0) arm -= group.shape->form().place;
    arm *= -group.law->closed_stiffness();
    return obstacles_.scatter(contact.index, {arm[0], arm[1], 0.0}, force);
  }
  place(contact, k);
  contact.pressing[at] = press(contact, k);
  contact.friction[at] = rub(contact, k);
  const bool has_shape = obstacles_.group_of(contact.index).shape != nullptr;
  dynamics::Obstacles::Coordinates value(-product(contact.friction, contact.tangent.y, k),
                                         -product(contact.friction, contact.tangent.z, k), -contact.friction[at]);
  if (has_shape) {
    value[0] -= product(contact.pressing, contact.normal.y, k);
    value[1] -= product(contact.pressing, contact.normal.z, k);
  }
  obstacles_.scatter(contact.index, value, force);
}

}  // namespace butee::integrators
