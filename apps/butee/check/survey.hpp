#pragma once

#include <string>
#include <vector>

#include <butee/model/model.hpp>

namespace butee::app::check {

/// A stretch of beam between two nodes: four DOFs (u, theta, u, theta) with bending stiffness and mass.
struct Stretch {
  model::NodeId a, b;
  double length;           ///< m
  double bending;          ///< E I, N m2
  double mass_per_length;  ///< kg/m
};

/// A spring on uy or uz, to ground if b < 0.
struct SpringPlace {
  model::NodeId a, b;
  double stiffness;  ///< N/m
  DofKind along = DofKind::uy;
};

/// A lumped mass.
struct MassPlace {
  model::NodeId node;
  double mass;  ///< kg
};

/// The mechanical parts of a model, identified from its element matrices so that elements of modules are
/// included.
struct Survey {
  std::vector<Stretch> stretches;
  std::vector<SpringPlace> springs;
  std::vector<MassPlace> masses;
  double total_mass = 0.0;   ///< kg, along u
  double lumped_mass = 0.0;  ///< kg, the part of total_mass lumped at single nodes
};

Survey survey_of(const model::Model& model);

}  // namespace butee::app::check
