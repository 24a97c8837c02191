#include "elements/beam_matrices.hpp"

namespace butee::elements {
namespace {

/// [a b -a b; b c -b d; -a -b a -b; b d -b c]: the form of a stiffness or a rotary inertia matrix.
Eigen::Matrix4d even(double a, double b, double c, double d) {
  Eigen::Matrix4d matrix;
  matrix << a, b, -a, b,  //
      b, c, -b, d,        //
      -a, -b, a, -b,      //
      b, d, -b, c;
  return matrix;
}

}  // namespace

BendingMatrices::BendingMatrices(const BendingProperties& of) {
  const double l = of.length, s = of.shear_ratio, s2 = s * s, f = 1.0 / (1.0 + s);
  stiffness = of.stiffness * f / (l * l * l) * even(12.0, 6.0 * l, (4.0 + s) * l * l, (2.0 - s) * l * l);
  if (of.tension != 0.0)
    stiffness += of.tension * f * f / (30.0 * l) *
                 even(36.0 + 60.0 * s + 30.0 * s2, 3.0 * l, (4.0 + 5.0 * s + 2.5 * s2) * l * l,
                      -(1.0 + 5.0 * s + 2.5 * s2) * l * l);

  const double m1 = 312.0 + 588.0 * s + 280.0 * s2, m2 = (44.0 + 77.0 * s + 35.0 * s2) * l;
  const double m3 = 108.0 + 252.0 * s + 140.0 * s2, m4 = -(26.0 + 63.0 * s + 35.0 * s2) * l;
  const double m5 = (8.0 + 14.0 * s + 7.0 * s2) * l * l, m6 = -(6.0 + 14.0 * s + 7.0 * s2) * l * l;
  mass << m1, m2, m3, m4,  //
      m2, m5, -m4, m6,     //
      m3, -m4, m1, -m2,    //
      m4, m6, -m2, m5;
  mass *= of.mass * l * f * f / 840.0;
  rotary.setZero();
  if (of.rotary_inertia == 0.0) return;
  rotary = of.rotary_inertia * f * f / (30.0 * l) *
           even(36.0, (3.0 - 15.0 * s) * l, (4.0 + 5.0 * s + 10.0 * s2) * l * l, (-1.0 - 5.0 * s + 5.0 * s2) * l * l);
  mass += rotary;
}

}  // namespace butee::elements
