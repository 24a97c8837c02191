#pragma once

#include <optional>
#include <vector>

#include "butee/config/parameters.hpp"
#include "butee/model/model.hpp"

namespace butee::scene {

/// The ends of the contacts of one [[contact]]: the directions in which they act, the nodes, and those of the other
/// body, none with contacts to ground.
struct ContactEnds {
  const std::vector<DofKind>& directions;
  const std::vector<model::NodeId>&a, &b;
};

/// The parts of rubbing contacts that turn with [rotation]. Friction acts on them at an arm. Private to the framework.
struct TurningParts {
  bool is_mirrored = false;  ///< the slip direction is opposite to a rotation about x: along (uz, uy)
  double radius = 0.0;       ///< m, of the body that turns
  bool a_turns = false, b_turns = false;

  /// Sets the arms of a group with a shape of this form.
  void set_arms(const model::ContactShape::Form& form, model::ObstacleGroup& group) const;
};

/// Reads `radius` and finds the parts that turn. Nothing, after a message, where a radius is missing or has no
/// meaning, and where only some of the nodes turn.
std::optional<TurningParts> read_turning_parts(const config::Parameters& contact, const model::Model& model,
                                               const model::DofTable& dofs, const ContactEnds& ends,
                                               config::Diagnostics& diagnostics);

}  // namespace butee::scene
