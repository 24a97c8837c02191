#pragma once

#include <optional>

#include "butee/config/parameters.hpp"
#include "butee/study/plan.hpp"

namespace butee::study {

/// Private to this folder: the axis of an entry of [[vary]], or nothing after an error.
/// `parameters` are those of vary_parameters() in `table`, which also contains `values`.
std::optional<Axis> read_axis(const config::Parameters& parameters, const config::Value& table, PlanKind kind,
                              config::Diagnostics& diagnostics);

}  // namespace butee::study
