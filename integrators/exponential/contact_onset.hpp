#pragma once

#include <vector>

#include "butee/dynamics/dynamics.hpp"

namespace butee::integrators {

/// The error of Lobatto's rule for the forces of contacts that begin or end with a step and whose law is not smooth
/// there, as the power 3/2 of Hertz.
///
/// Such an error falls with a fixed power of the step, so that it does not show in the decay of the force's Legendre
/// coefficients. It is found on the straight path with the velocity at the onset, where the exact integral is known: by
/// Gauss' rule in u, s = u^4, in which all powers of the penetration that are multiples of 1/4 are smooth. Derivation:
/// plugins/exponential/COLLOCATION.md, section 3; checked in tests/unit/contact_onset_test.cpp.
class ContactOnset {
 public:
  /// `dynamics` must outlive it.
  explicit ContactOnset(dynamics::Dynamics& dynamics);

  /// False if no contact has such a law.
  bool any() const { return !stops_.empty() || !obstacles_.empty(); }
  /// The motion at one end of a step. `h` is its length, negative at the end.
  struct End {
    double t, h;
    const Vector& x;
    const Vector& v;
  };
  /// Adds the magnitudes of the errors of the mean force on every DOF, N, for the contacts that begin or end at `end`.
  void add_errors(const End& end, Vector& errors);

  /// The error within the step of the integral of the force, relative to that of the whole integral, at most: 2.2 for
  /// the power 3/2.
  static constexpr double kInner = 2.2;

 private:
  /// Adds the error of force(x, v), which adds the forces of one contact on its DOFs to its last argument.
  template <class Force>
  void add(const End& end, const std::vector<Index>& dofs, const Force& force, Vector& errors);

  dynamics::Dynamics& dynamics_;
  std::vector<Index> stops_, obstacles_;
  std::vector<Index> dofs_;
  Vector x_, force_, sum_;
};

}  // namespace butee::integrators
