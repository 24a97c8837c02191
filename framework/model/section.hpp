#pragma once

namespace butee::model {

/// A linear elastic material.
struct Material {
  double young_modulus;  ///< Pa
  double density;        ///< kg/m3
};

/// The cross-section of a beam in its plane of bending.
struct Section {
  double area;               ///< m2
  double second_moment;      ///< m4
  double outer_fibre = 0.0;  ///< m, from the neutral axis; 0: not known
};

}  // namespace butee::model
