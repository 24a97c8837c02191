#pragma once

#include <array>
#include <span>
#include <vector>

#include "butee/solve/contact.hpp"

namespace butee::integrators {

/// The displacement of a stop over a step as a polynomial of degree 4 in the place s in [0, 1].
class StopPath {
 public:
  /// Through the displacements and speeds (times h) at both ends; `bulge` is added in the middle: 16 s^2 (1-s)^2 bulge.
  StopPath(double w0, double hv0, double w1, double hv1, double bulge);

  double value(double s) const { return (((c_[4] * s + c_[3]) * s + c_[2]) * s + c_[1]) * s + c_[0]; }
  const std::array<double, 5>& coefficients() const { return c_; }
  /// Bounds of the path, by its Bernstein coefficients.
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }

 private:
  std::array<double, 5> c_;
  double lowest_, highest_;
};

/// The coefficients of a stop's force over a step in the Legendre polynomials P_0, P_1, P_2 of [0, 1].
using ForceMoments = std::array<double, 3>;

/// The projection of a stop's force along a given path onto P_0, P_1 and P_2:
///
///     f_k = (2 k + 1) int_0^1 P_k(s) F(w(s)) ds
///
/// With a piecewise linear law exact, however often the stop opens or closes on the way. With a smooth law by Gauss's
/// rule of four points where the stop stays away from g = 0, and by panels graded towards the instants at which g = 0
/// or w = 0 where it does not, since F is small where g is. Checked against adaptive quadrature in
/// tests/unit/stop_path_test.cpp.
class StopForce {
 public:
  /// `contact` must outlive it.
  StopForce(solve::Contact& contact, Index stop);

  /// How a path lies to the stop.
  enum class Course {
    open,    ///< without force
    closed,  ///< a spring throughout
    far,     ///< a smooth law, far from its bend
    changing
  };
  Course course(const StopPath& path) const;
  ForceMoments moments(const StopPath& path, Course course);

 private:
  ForceMoments of_spring(const StopPath& path, double begin, double end, double side) const;
  ForceMoments by_gauss(const StopPath& path, double begin, double end);
  ForceMoments of_pieces(const StopPath& path);
  ForceMoments by_graded_panels(const StopPath& path);
  /// Fills places_ with 0, the places where the path crosses a border of the law, and 1.
  void find_places(const StopPath& path);
  void add_crossings(const StopPath& path, double border);

  solve::Contact& contact_;
  Index stop_;
  double gap_, stiffness_;
  bool is_linear_, on_upper_, on_lower_;
  std::vector<double> places_;
};

}  // namespace butee::integrators
