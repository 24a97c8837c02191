#pragma once

#include <string>
#include <vector>

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::model {

/// All quantities that can be recorded. stop_state, for fields only: +1 if a stop on the node is
/// closed on the side of u > 0, -1 on the other side, 0 if all are open. From shear_force on: for
/// probes only, see ElementForces.
enum class Quantity {
  u,
  v,
  a,
  theta,
  theta_v,
  theta_a,
  contact_force,
  stop_state,
  shear_force,
  bending_moment,
  bending_stress,
  von_mises,
  spring_force,
  spring_moment,
  reaction,
  reaction_moment,
  // Displacements along and rotations about x, y and z, their velocities and accelerations: for
  // probes only.
  ux,
  ux_v,
  ux_a,
  uy,
  uy_v,
  uy_a,
  uz,
  uz_v,
  uz_a,
  w,
  w_v,
  w_a,
  rx,
  rx_v,
  rx_a,
  ry,
  ry_v,
  ry_a,
  rz,
  rz_v,
  rz_a,
  // In space, if the base moves.
  u_abs,
  v_abs,
  a_abs,
  ux_abs,
  ux_v_abs,
  ux_a_abs,
  uz_abs,
  uz_v_abs,
  uz_a_abs,
  // Forces of beams in space, springs and supports.
  normal_force,
  shear_y,
  shear_z,
  torque,
  moment_y,
  moment_z,
  spring_ux,
  spring_uy,
  spring_uz,
  spring_rx,
  spring_ry,
  spring_rz,
  reaction_ux,
  reaction_uy,
  reaction_uz,
  reaction_rx,
  reaction_ry,
  reaction_rz,
  // Contacts in the plane, with dissipation or friction, at a node: for probes only.
  contact_normal,
  contact_friction,
  contact_slip,
  contact_wear,
  // Forces of all contacts on one DOF of a node: for probes only.
  contact_ux,
  contact_uy,
  contact_uz,
  contact_rx,
  contact_ry,
  contact_rz
};

/// "u", "M" ...
BUTEE_EXPORT const char* name_of(Quantity quantity);
/// "m", "N", "1" ...
BUTEE_EXPORT const char* unit_of(Quantity quantity);
/// A one-line description.
BUTEE_EXPORT const char* summary_of(Quantity quantity);

/// The quantity of a name in field_quantities() or probe_quantities(); throws InputError for other names.
BUTEE_EXPORT Quantity quantity_of(const std::string& name);
/// Names of quantities that fields can hold.
BUTEE_EXPORT std::vector<std::string> field_quantities();
/// Names of quantities that a probe can record.
BUTEE_EXPORT std::vector<std::string> probe_quantities();

/// The source of the value of a quantity.
enum class Source { motion, stops, section, springs, support, contacts };

BUTEE_EXPORT Source source_of(Quantity quantity);

/// True if the quantity requires the forces of single elements.
inline bool is_element_force(Quantity quantity) {
  return source_of(quantity) != Source::motion && source_of(quantity) != Source::stops;
}

/// True for contact_force and contact_ux to contact_rz.
inline bool is_contact_force(Quantity quantity) {
  return source_of(quantity) == Source::stops && quantity != Quantity::stop_state;
}

/// True for displacements, velocities and accelerations in space.
BUTEE_EXPORT bool is_absolute(Quantity quantity);

/// The DOF of the node that a quantity belongs to; for contact_force see contact_kind().
BUTEE_EXPORT DofKind kind_of(Quantity quantity);
/// For Source::motion 0, 1 or 2: displacement, velocity or acceleration; 0 for all others.
BUTEE_EXPORT int order_of(Quantity quantity);

}  // namespace butee::model
