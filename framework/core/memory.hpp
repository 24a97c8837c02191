#pragma once

#include <string>

#include <butee/export.hpp>

namespace butee {

/// The memory that this process may come to have, in bytes: the least of the machine's, of the limits of the process,
/// and of its control group.
BUTEE_EXPORT double memory_limit();

/// What is wrong with needing so much, or "" where there is enough: "needs about 120 GB of memory, more than the 16 GB
/// ...".
BUTEE_EXPORT std::string memory_complaint(double bytes);

}  // namespace butee
