#pragma once

namespace butee::model {

/// A linear elastic, isotropic material.
struct Material {
  double young_modulus;        ///< Pa
  double density;              ///< kg/m3
  double shear_modulus = 0.0;  ///< Pa; 0: not known

  /// Poisson's ratio, if the shear modulus is known.
  double poisson_ratio() const { return 0.5 * young_modulus / shear_modulus - 1.0; }
};

/// The shear factor kappa as a function of Poisson's ratio nu, kappa = (a + b nu) / (c + d nu).
struct ShearFactor {
  double a, b = 0.0, c = 1.0, d = 0.0;

  double at(double nu) const { return (a + b * nu) / (c + d * nu); }
};

/// The cross-section of a beam. Its axes y and z are principal axes; bending in the plane (x, y) is
/// about z.
struct Section {
  double area;                      ///< m2
  double second_moment;             ///< m4, about z: for bending in the plane (x, y), along u
  double outer_fibre = 0.0;         ///< m, from the neutral axis along y; 0: not known
  double second_moment_y = 0.0;     ///< m4, about y: for bending in the plane (x, z); 0: not known
  double outer_fibre_z = 0.0;       ///< m, from the neutral axis along z; 0: not known
  double torsion_constant = 0.0;    ///< m4; 0: not known
  ShearFactor shear_factor_y{0.0};  ///< for shear along y; 0: not known
  ShearFactor shear_factor_z{0.0};  ///< for shear along z; 0: not known
  double torsion_modulus = 0.0;     ///< m3, for round sections: torque over the largest shear stress; 0: not round
};

}  // namespace butee::model
