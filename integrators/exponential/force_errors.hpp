#pragma once

#include <vector>

#include "integrators/exponential/contact_dofs.hpp"
#include "integrators/exponential/contact_onset.hpp"
#include "integrators/exponential/step_nodes.hpp"

namespace butee::integrators {

/// The errors of the polynomials through the forces at the nodes of a step: of their integral over the step, which
/// Lobatto's rule gives, and of that up to an instant within the step.
///
/// They follow from the decay of the Legendre coefficients of the force on every DOF and, for forces that begin or end
/// with the step, from ContactOnset. Derivation: plugins/exponential/COLLOCATION.md, section 3.
class ForceErrors {
 public:
  using AtNodes = Eigen::Matrix<double, Eigen::Dynamic, StepNodes::kCount>;

  /// Both must outlive it.
  ForceErrors(dynamics::Dynamics& dynamics, const ContactDofs& dofs);

  /// A step of length h from t: forces, displacements and, where contacts need them, velocities of the active DOFs at
  /// the nodes, the modes, and z at the end.
  struct Step {
    double t, h;
    const ActiveDofs& active;
    const AtNodes &forces, &x, &v;
    const dynamics::DampedModes& modes;
    Eigen::Ref<const Eigen::VectorXd> end;
  };
  void find(const Step& step);

  /// The errors of the impulses on the active DOFs, N s.
  const Vector& of_impulse() const { return impulse_errors_; }
  /// The largest errors of the velocities of the active DOFs within the step, m/s. At its end they are far smaller.
  const Vector& within() const { return inner_errors_; }

 private:
  /// Takes the errors of the friction of supports where they are larger than those of the whole force on their DOFs.
  void add_supports(const Step& step);
  /// Adds the errors of forces that begin or end with the step.
  void add_onsets(const Step& step);

  dynamics::Dynamics& dynamics_;
  const ContactDofs& dofs_;
  ContactOnset onset_;
  std::vector<Index> supports_;  ///< friction supports
  AtNodes support_friction_;     ///< for each of them, N
  Vector impulse_errors_;        ///< N s, of the active DOFs
  Vector inner_errors_;          ///< m/s, of their velocities
  Vector x_, v_, onset_errors_;
};

}  // namespace butee::integrators
