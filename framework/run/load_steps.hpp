#pragma once

#include <string>

#include "butee/model/system.hpp"

namespace butee::run {

/// Advice if two discontinuities of a load, such as the ends of a pulse or the corners of a table, are closer together
/// than the fixed `time_step`, s, in a run until `end_time`, s; otherwise empty.
BUTEE_EXPORT std::string complaint_of_loads(const model::System& system, double time_step, double end_time);

}  // namespace butee::run
