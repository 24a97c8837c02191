#pragma once

#include <span>

#include "butee/model/system.hpp"

namespace butee::model {

/// The part of a system that is left where all free DOFs but these, ascending, are held at zero. Its stops and loads
/// are those that act on the part; a stop against a DOF that is held is one against the ground. Not for modal damping,
/// whose modes are those of the whole. The Model must outlive it, `whole` need not.
BUTEE_EXPORT System part_of(const System& whole, std::span<const Index> dofs);

/// How many places of the common pattern of M, K and D lie between each free DOF and the nearest of `from`; -1 where no
/// way leads there.
BUTEE_EXPORT std::vector<Index> distances(const System& system, std::span<const Index> from);

}  // namespace butee::model
