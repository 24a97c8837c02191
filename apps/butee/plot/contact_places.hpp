#pragma once

#include <butee/model/model.hpp>

#include "result.hpp"

namespace butee::app::plot {

/// The displacements at which a node touches stops to ground, m; ascending.
std::vector<double> gaps_of(const model::Model& model, model::NodeId node, DofKind kind);

/// Rings and planes to ground that a node can touch in the plane (uy, uz).
std::vector<Wall> walls_of(const model::Model& model, model::NodeId node);

/// Sets Result::contact_places.
void find_contact_places(const model::Model& model, Result& result);

}  // namespace butee::app::plot
