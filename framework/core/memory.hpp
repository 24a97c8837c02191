#pragma once

#include <string>

#include <butee/export.hpp>

namespace butee {

/// The memory available to this process, in bytes: the minimum of the machine's memory, the limits
/// of the process, and those of its control group.
BUTEE_EXPORT double memory_limit();

/// An error message if `bytes` exceeds the available memory, else "": "needs about 120 GB of
/// memory, more than the 16 GB ...".
BUTEE_EXPORT std::string memory_complaint(double bytes);

}  // namespace butee
