#pragma once

#include <span>

#include "butee/model/system.hpp"

namespace butee::model {

/// The part of a system that remains if all free DOFs except `dofs` (ascending) are held at zero.
/// Its stops and loads are those that act on the part; a stop against a held DOF becomes a stop
/// against ground. Not for modal damping, whose modes are those of the whole system. The Model must
/// outlive the part, `whole` need not.
BUTEE_EXPORT System part_of(const System& whole, std::span<const Index> dofs);

/// The graph distance, in the common pattern of M, K and D, of each free DOF from the nearest of
/// `from`; -1 if it is not connected.
BUTEE_EXPORT std::vector<Index> distances(const System& system, std::span<const Index> from);

}  // namespace butee::model
