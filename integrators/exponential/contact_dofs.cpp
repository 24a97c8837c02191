#include "integrators/exponential/contact_dofs.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"

namespace butee::integrators {
namespace {

[[noreturn]] void refuse_law() {
  throw InputError(
      "integrator.type: the law of a contact acts while the contact is apart, which exponential cannot treat in the "
      "plane");
}

void sort_once(std::vector<Index>& dofs) {
  std::sort(dofs.begin(), dofs.end());
  dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
}

}  // namespace

ContactDofs::ContactDofs(dynamics::Dynamics& dynamics, const dynamics::DampedModes& modes,
                         const std::vector<Index>& others)
    : inverse_mass_(Vector::Zero(dynamics.size())), stiffness_(Vector::Zero(dynamics.size())) {
  if (const dynamics::Obstacles* obstacles = dynamics.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i) {
      const model::ObstacleGroup& group = obstacles->group_of(i);
      if (group.law != nullptr && !group.law->is_silent_while_open()) refuse_law();
      for (const auto& side : {obstacles->ends_of(i).a, obstacles->ends_of(i).b})
        for (const Index dof : side) take(dof, obstacles->closed_stiffness(i), modes);
      const bool is_simple =
          group.shape != nullptr && group.shape->form().kind != model::ContactShape::Form::Kind::other;
      const double directions = static_cast<double>(group.directions.size()), nodes = group.b.empty() ? 1.0 : 2.0;
      limit_clearance(group.law.get(), is_simple ? -group.shape->at({0.0, 0.0}).penetration : 0.0,
                      nodes * std::sqrt(directions));
      need_velocity_ = need_velocity_ || group.damping.kind != model::ImpactDamping::Kind::none ||
                       group.friction.rule != model::Friction::Rule::none;
    }
  const dynamics::ElasticStops& contact = dynamics.stops();
  const Vector closed = contact.closed_stiffness();
  for (Index i = 0; i < contact.size(); ++i) {
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)}) take(dof, closed[i], modes);
    limit_clearance(&contact.law_of(i), contact.play_of(i).gap, contact.dof_b(i) >= 0 ? 2.0 : 1.0);
  }
  for (const Index dof : others) find_inverse_mass(dof, modes);
  sort_once(dofs_);
  const Index p = modes.count();
  reach_ = Eigen::ArrayXd::Zero(p);
  for (const Index dof : dofs_) {
    const auto shape = modes.displacement().col(dof).array();
    reach_ = reach_.max((shape.head(p).square() + shape.tail(p).square()).sqrt());
  }
}

void ContactDofs::take(Index dof, double stiffness, const dynamics::DampedModes& modes) {
  if (dof < 0) return;
  dofs_.push_back(dof);
  find_inverse_mass(dof, modes);
  stiffness_[dof] += stiffness;
  highest_frequency_ = std::max(highest_frequency_, std::sqrt(stiffness * inverse_mass_[dof]));
}

void ContactDofs::limit_clearance(const model::ContactLaw* law, double distance, double most) {
  const bool is_silent = law != nullptr && law->is_silent_while_open();
  acts_apart_ = acts_apart_ || !is_silent;
  clearance_ = std::min(clearance_, is_silent ? std::max(0.0, distance) / most : 0.0);
}

void ContactDofs::find_inverse_mass(Index dof, const dynamics::DampedModes& modes) {
  // The velocity of the DOF after an impulse of 1 N s on it, summed over all modes.
  inverse_mass_[dof] = std::max(0.0, modes.velocity().col(dof).dot(modes.input().col(dof)));
}

bool ActiveDofs::find(dynamics::Dynamics& dynamics, const std::vector<Index>& others) {
  std::vector<Index> found = others;
  const auto take = [&](Index dof) {
    if (dof >= 0) found.push_back(dof);
  };
  if (const dynamics::Obstacles* obstacles = dynamics.obstacles())
    for (Index i = 0; i < obstacles->size(); ++i) {
      const bool is_apart = obstacles->group_of(i).shape != nullptr &&
                            obstacles->phase(i).normal == dynamics::ContactPhase::Normal::apart;
      if (is_apart) continue;
      for (const auto& side : {obstacles->ends_of(i).a, obstacles->ends_of(i).b})
        for (const Index dof : side) take(dof);
    }
  const dynamics::ElasticStops& contact = dynamics.stops();
  for (Index i = 0; i < contact.size(); ++i)
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)}) take(dof);
  sort_once(found);
  if (found == dofs) return false;
  dofs = std::move(found);
  superposition.choose(dofs);
  return true;
}

Index ActiveDofs::place(Index dof) const {
  return std::lower_bound(dofs.begin(), dofs.end(), dof) - dofs.begin();
}

}  // namespace butee::integrators
