#pragma once

#include <string>
#include <vector>

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::record {

/// What can be recorded of a node. stop_state, of fields alone: +1 where a stop on it is closed on the side of u > 0,
/// -1 on the other side, 0 where all are open.
enum class Quantity { u, v, a, theta, theta_v, theta_a, contact_force, stop_state };

BUTEE_EXPORT const char* name_of(Quantity quantity);
/// "m", "N", "1" ...
BUTEE_EXPORT const char* unit_of(Quantity quantity);

/// The quantity of a name that all_quantities() holds.
BUTEE_EXPORT Quantity quantity_of(const std::string& name);
BUTEE_EXPORT std::vector<std::string> all_quantities();
/// Those that a probe can record.
BUTEE_EXPORT std::vector<std::string> probe_quantities();

/// u, v, a and contact_force belong to the displacement of a node, the rest to its rotation.
constexpr DofKind kind_of(Quantity quantity) {
  const bool turns = quantity == Quantity::theta || quantity == Quantity::theta_v || quantity == Quantity::theta_a;
  return turns ? DofKind::theta : DofKind::u;
}

}  // namespace butee::record
