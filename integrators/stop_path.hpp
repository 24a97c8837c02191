#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "butee/dynamics/contact.hpp"

namespace butee::integrators {

/// The displacement of a stop over a step as a polynomial of degree 4 in the place s in [0, 1].
class StopPath {
 public:
  /// Through the displacements and speeds (times h) at both ends; `bulge` is added in the middle: 16 s^2 (1-s)^2 bulge.
  StopPath(double w0, double hv0, double w1, double hv1, double bulge) {
    const double rise = w1 - w0, b = 16.0 * bulge;
    c_ = {w0, hv0, 3.0 * rise - 2.0 * hv0 - hv1 + b, hv0 + hv1 - 2.0 * rise - 2.0 * b, b};
    // The cubic's Bernstein coefficients, raised by a degree; the bulge has only the one in the middle.
    const double p1 = w0 + hv0 / 3.0, p2 = w1 - hv1 / 3.0;
    const double b1 = 0.25 * w0 + 0.75 * p1, b2 = 0.5 * (p1 + p2) + b / 6.0, b3 = 0.75 * p2 + 0.25 * w1;
    lowest_ = std::min(std::min(std::min(w0, w1), std::min(b1, b3)), b2);
    highest_ = std::max(std::max(std::max(w0, w1), std::max(b1, b3)), b2);
  }

  double value(double s) const { return (((c_[4] * s + c_[3]) * s + c_[2]) * s + c_[1]) * s + c_[0]; }
  const std::array<double, 5>& coefficients() const { return c_; }
  /// Bounds of the path, by its Bernstein coefficients.
  double lowest() const { return lowest_; }
  double highest() const { return highest_; }
  /// The path over [0, s].
  StopPath until(double s) const {
    const double speed = ((4.0 * c_[4] * s + 3.0 * c_[3]) * s + 2.0 * c_[2]) * s + c_[1];
    const double hv0 = s * c_[1], w1 = value(s), hv1 = s * speed;
    return {c_[0], hv0, w1, hv1, value(0.5 * s) - 0.5 * (c_[0] + w1) - 0.125 * (hv0 - hv1)};
  }
  /// It does not turn, as far as the Bernstein coefficients of its slope tell.
  bool is_monotonic() const;

 private:
  std::array<double, 5> c_;
  double lowest_, highest_;
};

/// The coefficients of a stop's force over a step in the Legendre polynomials P_0, P_1, P_2 of [0, 1].
using ForceMoments = std::array<double, 3>;

/// The moments over [a, b] of what P_0, P_1, P_2 make up over [0, 1]: with L = b - a and c = a + b - 1, P_1 is
/// L P_1 + c and P_2 is L^2 P_2 + 3 L c P_1 + (L^2 + 3 c^2 - 1)/2.
template <class T>
std::array<T, 3> moments_within(const std::array<T, 3>& f, double a, double b) {
  const double length = b - a, c = a + b - 1.0;
  return {T(f[0] + c * f[1] + 0.5 * (length * length + 3.0 * c * c - 1.0) * f[2]),
          T(length * f[1] + 3.0 * length * c * f[2]), T(length * length * f[2])};
}

/// What forces P_0, P_1, P_2 do to the displacement and the speed (times h) at the end and to the displacement in the
/// middle.
using PathCoupling = std::array<std::array<double, 3>, 3>;

/// Force moments along a path, and the integrals of 1, s, ... s^6 over the places where the stop is a spring, by which
/// they follow the path.
struct Projection {
  ForceMoments force{};
  std::array<double, 7> closed{};
};

/// Newton's method for f = projection(path moved by what f does to it) of one stop, the stop a spring over the places
/// where it is closed.
class OwnForce {
 public:
  using Matrix = std::array<double, 9>;

  /// Of the force the first `orders` entries count; where there are three, the path takes the displacement in the
  /// middle.
  OwnForce(double stiffness, std::size_t orders) : stiffness_(stiffness), orders_(orders) {}

  /// (1 - d projection / d f)^-1, by rows.
  Matrix inverse(const std::array<double, 7>& closed, const PathCoupling& coupling) const;
  /// Of a stop that is closed throughout.
  Matrix closed_inverse(const PathCoupling& coupling) const;
  /// The change of f from `old`.
  ForceMoments correction(const Matrix& inverse, const ForceMoments& projected, const ForceMoments& old) const {
    ForceMoments r{};
    for (std::size_t k = 0; k < orders_; ++k) r[k] = projected[k] - old[k];
    return {inverse[0] * r[0] + inverse[1] * r[1] + inverse[2] * r[2],
            inverse[3] * r[0] + inverse[4] * r[1] + inverse[5] * r[2],
            inverse[6] * r[0] + inverse[7] * r[1] + inverse[8] * r[2]};
  }

 private:
  double stiffness_;
  std::size_t orders_;
};

/// The projection of a stop's force along a given path onto P_0, P_1 and P_2:
///
///     f_k = (2 k + 1) int_0^1 P_k(s) F(w(s)) ds
///
/// The part of a linear stop is integrated exactly, however often the stop opens or closes on the way. What a smooth
/// law adds to it is integrated by Gauss's rule of four points between the instants at which g = 0 or w = 0, by panels
/// graded towards those where the law bends over a part of the step that counts; where that bend is too narrow to
/// count, it is the law's constant pull. Checked against Simpson's rule in
/// tests/unit/stop_path_test.cpp.
class StopForce {
 public:
  /// `contact` must outlive it.
  StopForce(dynamics::Contact& contact, Index stop);

  /// How a path lies to the stop.
  enum class Course {
    open,    ///< no linear part
    closed,  ///< a spring throughout
    changing
  };
  Course course(const StopPath& path) const {
    const double low = path.lowest(), high = path.highest();
    if ((!on_upper_ || high <= gap_) && (!on_lower_ || low >= -gap_)) return Course::open;
    if ((on_upper_ && low >= gap_) || (on_lower_ && high <= -gap_)) return Course::closed;
    return Course::changing;
  }
  Projection project(const StopPath& path, Course course);
  /// The error of the force that may last a whole run and one that may last for the motion's own time, N. Where the
  /// shortcuts for narrow and far bends exceed it, they are not taken, and integrals near bends take as many panels as
  /// it asks for. The first counts for stops on one side, which err in the same sense all run long.
  void allow(double for_run, double for_own_time) {
    const double error = on_upper_ != on_lower_ ? for_run : for_own_time;
    is_precise_ = kShortcuts * far_force_ > error;
    is_finest_ = kPreciseError * far_force_ > error;
  }
  /// Whether the force is that of a spring and a constant throughout.
  bool is_spring(const StopPath& path, Course course) const {
    return course == Course::closed && (is_linear_ || is_constant_beside_bends(path));
  }
  /// What project() gives where that is so, but for the places, which are all.
  ForceMoments of_spring(const StopPath& path) {
    const double side = on_upper_ && path.lowest() >= gap_ ? 1.0 : -1.0;
    const std::array<double, 5>& c = path.coefficients();
    // (2 k + 1) int_0^1 P_k(s) s^j ds: j! j! (2 k + 1) / ((j - k)! (j + k + 1)!)
    const double f0 = c[0] - side * gap_ + c[1] / 2.0 + c[2] / 3.0 + c[3] / 4.0 + c[4] / 5.0,
                 f1 = (c[1] + c[2]) / 2.0 + 0.45 * c[3] + 0.4 * c[4],
                 f2 = c[2] / 6.0 + 0.25 * c[3] + (2.0 / 7.0) * c[4];
    const double rest = is_linear_ ? 0.0 : constant_rest(path.value(0.5), side);
    return {rest - stiffness_ * f0, -stiffness_ * f1, -stiffness_ * f2};
  }
  /// Along a path without contact, the pull of a regularised law: a constant but for where it jumps.
  ForceMoments far_force(const StopPath& path);
  /// By how much the pull of a regularised law jumps where a path crosses the middle of the gap, N.
  double jump(const StopPath& path) const {
    return on_upper_ && on_lower_ && path.lowest() < 0.0 && path.highest() > 0.0 ? 2.0 * far_force_ : 0.0;
  }
  double stiffness() const { return stiffness_; }
  /// Without pull or smooth bend: nothing but a spring while closed.
  bool is_linear() const { return is_linear_; }

 private:
  void add_spring(const StopPath& path, double begin, double end, double side, Projection& to) const;
  /// What the law adds to a spring on `side` (0: to nothing), N.
  double rest_at(double w, double side);
  /// The same far from its bends, where it is a constant on either side of each.
  double constant_rest(double w, double side);
  /// Its moments over a piece.
  ForceMoments of_rest(const StopPath& path, double begin, double end, double side);
  /// The same where it does not change over the piece, but for a bend too narrow to count.
  ForceMoments of_constant_rest(const StopPath& path, double begin, double end, double side);
  /// The same by panels that shrink towards `graded`.
  ForceMoments of_graded_rest(const StopPath& path, double graded, double other, double side);
  /// +1, -1: the side on which a spring acts; 0: none.
  double side_at(double w) const { return on_upper_ && w > gap_ ? 1.0 : on_lower_ && w < -gap_ ? -1.0 : 0.0; }
  /// Whether the path is nowhere near a bend, so that what the law adds to a spring does not change but for its sign.
  bool is_off_bends(const StopPath& path) const;
  /// Whether what the law adds to a spring is constant between bends, as far as it counts.
  bool is_constant_beside_bends(const StopPath& path) const;
  /// Whether that keeps its sign between bends.
  bool stays_on_a_side(const StopPath& path) const;
  Projection of_pieces(const StopPath& path);
  /// Where both are so and the path crosses one border once; false where it does not.
  bool of_one_crossing(const StopPath& path, Projection& to);
  /// Fills places_ with 0, the places where the path crosses a border of the law, and 1.
  void find_places(const StopPath& path);
  void add_crossings(const StopPath& path, double border);

  dynamics::Contact& contact_;
  Index stop_;
  /// The error of the shortcuts, in parts of the law's pull: the part of it that is left at kFarOff and beside kSharp.
  static constexpr double kShortcuts = 3e-3;
  /// The same error where kPrecisePanels are used.
  static constexpr double kPreciseError = 2e-4;

  double gap_, stiffness_, bend_width_, far_force_;
  bool is_precise_ = false, is_finest_ = false;
  bool is_linear_, on_upper_, on_lower_;
  struct FarRest {
    double open, closed;
  };
  bool knows_far_rest_ = false;
  FarRest upper_rest_{}, lower_rest_{};
  struct Place {
    double s;
    bool is_bend;  ///< g = 0
  };
  std::vector<Place> places_;
};

}  // namespace butee::integrators
