#pragma once

#include <vector>

#include "butee/dynamics/dynamics.hpp"

namespace butee::record {

/// The contacts whose forces act on a nodal DOF, free or fixed, numbered as in Dynamics.
struct ContactsOn {
  struct Stop {
    Index stop;   ///< of Dynamics::stops()
    double sign;  ///< of its force on the DOF
  };
  struct Obstacle {
    Index contact;      ///< of Dynamics::obstacles()
    std::size_t place;  ///< component of ContactForces::force, or kMoment
    double factor;      ///< of that component; the arm of the friction, m, for kMoment

    static constexpr std::size_t kMoment = 2;
    double of(const dynamics::ContactForces& forces) const {
      return factor * (place == kMoment ? -forces.friction : forces.force[static_cast<Index>(place)]);
    }
  };
  std::vector<Stop> stops;
  std::vector<Obstacle> obstacles;
};
ContactsOn contacts_on(const model::Model& model, const model::DofTable& dofs, model::NodalDof dof);

/// The contacts of Dynamics::obstacles() at a node.
std::vector<Index> obstacles_at(const model::Model& model, const model::DofTable& dofs, model::NodeId node);

}  // namespace butee::record
