#pragma once

#include <optional>
#include <string>

#include "butee/model/model.hpp"
#include "butee/model/quantity.hpp"

namespace butee::model {

/// The end of a beam's part whose section forces a probe records, or the reason why there is none.
struct CutChoice {
  const Element* beam = nullptr;
  Index part = 0;
  bool at_end = true;
  std::string problem;
};

/// The part that ends at the node; at the first node of a beam the part that begins there.
/// `element` is "" or names a beam ("string") or one of its parts ("string:17", between the nodes
/// 17 and 18). If it is "", the beam is the one whose name the node has, or the only one that the
/// node belongs to.
BUTEE_EXPORT CutChoice choose_cut(const Model& model, NodeId node, const std::string& element);

/// The row of SectionCut::resultants for a section force or bending_stress; empty for other
/// quantities.
BUTEE_EXPORT std::optional<Index> resultant_row(Quantity quantity);

/// The reason why `quantity` cannot be recorded at the node, or "". `dofs` are those of the model.
BUTEE_EXPORT std::string why_not(Quantity quantity, const Model& model, const DofTable& dofs, NodeId node,
                                 const std::string& element);

/// The DOF along which contact_force of a node is recorded: uy if a contact of the node acts along it,
/// else the first one along which its contacts act. kind_of() for all other quantities.
BUTEE_EXPORT DofKind contact_kind(const Model& model, NodeId node, Quantity quantity);

/// The unit of a quantity at the node: contact_force is a moment where all contacts of the node act on rotations.
BUTEE_EXPORT const char* unit_at(const Model& model, NodeId node, Quantity quantity);

/// The name of an element; "" if it has none.
BUTEE_EXPORT const std::string& element_name(const Model& model, std::size_t element);

/// True for a spring that acts on the DOF and has that name; "" matches any name.
BUTEE_EXPORT bool is_spring_on(const Model& model, std::size_t element, NodalDof dof, const std::string& name);

}  // namespace butee::model
