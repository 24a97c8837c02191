#pragma once

#include <optional>
#include <string>
#include <vector>

#include "butee/dynamics/modes.hpp"

namespace butee::dynamics {

/// Properties of one natural mode.
struct Mode {
  double omega = 0.0;             ///< rad/s
  double frequency = 0.0;         ///< Hz
  std::optional<double> damping;  ///< 1 = critical; none for rigid motion
  double effective_mass = 0.0;    ///< kg, for a uniform transverse acceleration of all nodes
  double effective_part = 0.0;    ///< fraction of the total mass
  double residual = 0.0, rounding = 0.0;
  bool rigid = false;
};

/// The modes of a scene with all stops open or some of them closed.
struct ModeAnalysis {
  std::string title;
  Index dofs = 0, stops = 0, closed = 0;
  double total_mass = 0.0;  ///< kg
  bool dense = false;
  std::vector<Mode> modes;
  Eigen::MatrixXd shapes;  ///< dofs x modes, Phi^T M Phi = 1
};

/// The stops that a selector (`--closed`) names: "all", or those that act on the selected nodes.
/// Throws InputError.
BUTEE_EXPORT std::vector<ClosedStop> closed_stops(const model::Model& model, const std::vector<std::string>& selectors);

/// Computes `count` modes. Throws InputError if the scene has fewer, RunError if they could not be
/// computed.
BUTEE_EXPORT ModeAnalysis analyse_modes(const model::Model& model, const model::System& system,
                                        const std::vector<ClosedStop>& closed, Index count);

}  // namespace butee::dynamics
