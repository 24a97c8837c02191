#pragma once

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee {

/// A vector of zeros. A long vector requests large pages from the system, which reduces the cost of
/// address translation: systems of a million DOFs gain a quarter of their time.
BUTEE_EXPORT Vector zeros(Index size);

/// Allocates a vector in the same way with undefined entries; does nothing if the vector has that
/// size.
BUTEE_EXPORT void make_room(Vector& vector, Index size);

}  // namespace butee
