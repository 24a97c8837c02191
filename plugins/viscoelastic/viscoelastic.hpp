#pragma once

#include <cmath>

#include "butee/model/contact_law.hpp"

namespace butee::plugins {

/// Contact of viscoelastic spheres after Kuwabara and Kono.
///
///     F = k (g^(3/2) + 3/2 A sqrt(g) g') for g > 0, until F = 0;   V = 2/5 k g^(5/2)
///
/// k in N/m^(3/2); A in s is the relaxation time of the material. The dissipation is that of
/// Hertz's deformation field in a material with linear viscosity. Unlike with a dashpot, the
/// coefficient of restitution therefore decreases with the impact speed. Sources: N. V. Brilliantov
/// et al., Phys. Rev. E 53 (1996) 5382, doi 10.1103/PhysRevE.53.5382; restitution: T. Schwager and
/// T. Poeschel, Phys. Rev. E 78 (2008) 051304, doi 10.1103/PhysRevE.78.051304. Checked in
/// tests/plugins/viscoelastic_law_test.cpp.
class Viscoelastic final : public model::BatchedLaw<Viscoelastic> {
 public:
  /// `stiffness` k > 0 in N/m^(3/2), `relaxation` A >= 0 in s, `reference` > 0: the penetration in m at which
  /// closed_stiffness() is taken.
  Viscoelastic(double stiffness, double relaxation, double reference)
      : stiffness_(stiffness), relaxation_(relaxation), reference_(reference) {}

  double secant(double g) const override { return g > 0.0 ? stiffness_ * std::sqrt(g) : 0.0; }
  double tangent(double g) const override { return g > 0.0 ? 1.5 * stiffness_ * std::sqrt(g) : 0.0; }
  double energy(double g) const override { return g > 0.0 ? 0.4 * stiffness_ * g * g * std::sqrt(g) : 0.0; }
  double closed_stiffness() const override { return tangent(reference_); }

  RateDependence rate_dependence() const override { return RateDependence::smooth; }
  RatedForce rated_force(double g, double rate, bool) const override {
    if (g <= 0.0) return {0.0, 0.0, 0.0};
    const double root = std::sqrt(g), viscous = 1.5 * stiffness_ * relaxation_;
    return {stiffness_ * g * root + viscous * root * rate, 1.5 * stiffness_ * root + 0.5 * viscous / root * rate,
            viscous * root};
  }

 private:
  double stiffness_, relaxation_, reference_;
};

}  // namespace butee::plugins
