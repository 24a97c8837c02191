#pragma once

#include <Eigen/Dense>

#include "butee/model/section.hpp"

namespace butee::elements {

enum class BeamTheory {
  euler,      ///< Euler-Bernoulli
  rayleigh,   ///< with rotary inertia of the section
  timoshenko  ///< with rotary inertia and shear
};

/// The properties of one beam element for bending in one plane.
struct BendingProperties {
  double length;          ///< l, m
  double stiffness;       ///< E I, N m2
  double mass;            ///< rho A, kg/m
  double rotary_inertia;  ///< rho I, kg m; 0: none
  double shear_ratio;     ///< Phi = 12 E I / (kappa G A l^2), 0: stiff in shear
  double tension;         ///< P, N, the initial axial force
};

/// The matrices of an element in one plane of bending with DOFs (u1, theta1, u2, theta2), theta = du/dx without shear:
/// exact static shape functions with the shear ratio Phi, consistent masses. With f = 1/(1 + Phi)
///
///     K   = E I f / l^3 [12 6l -12 6l; . (4 + Phi) l^2 -6l (2 - Phi) l^2; . . 12 -6l; sym (4 + Phi) l^2]
///           + P f^2 / (30 l) [36 + 60 Phi + 30 Phi^2, 3l, ...]
///     M   = rho A l f^2 / 840 [312 + 588 Phi + 280 Phi^2, (44 + 77 Phi + 35 Phi^2) l, ...] + M_r
///     M_r = rho I f^2 / (30 l) [36, (3 - 15 Phi) l, ...]
///
/// Source: M. I. Friswell, J. E. T. Penny, S. D. Garvey, A. W. Lees, Dynamics of Rotating Machines, 2010, section 5.4;
/// J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968. Checked in tests/unit/beam_test.cpp.
struct BendingMatrices {
  explicit BendingMatrices(const BendingProperties& of);

  Eigen::Matrix4d stiffness, mass;
  Eigen::Matrix4d rotary;  ///< M_r, included in `mass`; the gyroscopic matrix of a turning round shaft is 2 M_r
};

}  // namespace butee::elements
