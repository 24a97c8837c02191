#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "butee/dynamics/elastic_stops.hpp"
#include "integrators/exponential/contact_path.hpp"
#include "integrators/exponential/force_moments.hpp"

namespace butee::integrators {

/// The contact status of a stop along a path.
enum class ContactStatus {
  open,    ///< no spring force
  closed,  ///< a spring throughout
  changing
};

/// The projection of a stop's force along a given path onto P_0, P_1 and P_2:
///
///     f_k = (2 k + 1) int_0^1 P_k(s) F(w(s)) ds,      F = spring + rest
///
/// The spring part is integrated exactly for any number of openings and closings. The rest of a
/// regularised law is integrated by Gauss's rule with four points between the roots of g = 0 and of
/// w = 0, on panels graded towards the transitions (bends) of the law at g = 0. If the transition
/// is narrow or far away, the rest is replaced by its limit, the constant residual force. Checked
/// against Simpson's rule in tests/unit/contact_force_test.cpp.
class ContactForce {
 public:
  /// `contact` must outlive it.
  ContactForce(dynamics::ElasticStops& contact, Index stop);

  ContactStatus status(const ContactPath& path) const {
    const double low = path.lowest(), high = path.highest();
    if ((!on_upper_ || high <= gap_) && (!on_lower_ || low >= -gap_)) return ContactStatus::open;
    if ((on_upper_ && low >= gap_) || (on_lower_ && high <= -gap_)) return ContactStatus::closed;
    return ContactStatus::changing;
  }
  Projection project(const ContactPath& path, ContactStatus status);
  /// True if a stop with this displacement and gap, m, has just left the middle (time::leave_middle()).
  static bool is_leaving(double w, double gap) { return w != 0.0 && std::abs(w) < kLeaving * std::abs(gap); }
  /// The force of a stop at a displacement, N.
  double force_at(double w) { return rest_at(w, 0.0); }
  /// The stiffness of a closed stop at a displacement, N/m; beside the transition of a regularised law.
  double tangent_at(double w) const;
  /// The same at a penetration, m.
  double tangent_behind(double penetration) const;
  /// The coefficients of P_3 and P_4 in the force along a path, N, which its projection leaves out. They are exact for
  /// a spring; for other laws these two terms are chosen to meet the force at both ends of the step.
  std::pair<double, double> missed(const ContactPath& path);
  /// Sets the allowed error of the force, N, if it persists for the whole run and if it persists
  /// for the characteristic time of the motion. Approximations of the rest with larger errors are
  /// not used, and more panels are taken. The first bound applies to one-sided stops, whose errors
  /// keep their sign during the whole run.
  void allow(double for_run, double for_characteristic_time) {
    const double error = on_upper_ != on_lower_ ? for_run : for_characteristic_time;
    is_precise_ = kShortcuts * residual_ > error;
    is_finest_ = kPreciseError * residual_ > error;
  }
  /// The force is a spring force plus a constant over the whole step.
  bool is_spring(const ContactPath& path, ContactStatus status) const {
    return status == ContactStatus::closed && (is_linear_ || is_constant_beside_bends(path));
  }
  /// The moments of such a force, equal to project(path, closed).force.
  ForceMoments of_spring(const ContactPath& path) {
    const double side = on_upper_ && path.lowest() >= gap_ ? 1.0 : -1.0;
    const std::array<double, 5>& c = path.coefficients();
    // (2 k + 1) int_0^1 P_k(s) s^j ds: j! j! (2 k + 1) / ((j - k)! (j + k + 1)!)
    const double f0 = c[0] - side * gap_ + c[1] / 2.0 + c[2] / 3.0 + c[3] / 4.0 + c[4] / 5.0,
                 f1 = (c[1] + c[2]) / 2.0 + 0.45 * c[3] + 0.4 * c[4],
                 f2 = c[2] / 6.0 + 0.25 * c[3] + (2.0 / 7.0) * c[4];
    const double rest = is_linear_ ? 0.0 : constant_rest(path.value(0.5), side);
    return {rest - stiffness_ * f0, -stiffness_ * f1, -stiffness_ * f2};
  }
  /// The moments of the residual force along a path without contact; the force is constant except
  /// for its change of sign at w = 0.
  ForceMoments residual_moments(const ContactPath& path);
  /// The jump of the residual force, N, if the path crosses the middle of the gap.
  double jump(const ContactPath& path) const {
    return on_upper_ && on_lower_ && path.lowest() < 0.0 && path.highest() > 0.0 ? 2.0 * residual_ : 0.0;
  }
  /// A bound of the change of the residual force beside its bends, N.
  double bend(const ContactPath& path) const { return is_linear_ || is_off_bends(path) ? 0.0 : residual_; }
  double stiffness() const { return stiffness_; }
  /// stiffness(), or the largest tangent along a path if that is larger, as with laws of a power of the penetration.
  double stiffness_along(const ContactPath& path) const { return is_bounded_ ? stiffness_ : steepest(path); }
  /// No tangent exceeds stiffness(), or only within the bend of a regularised law.
  bool is_bounded() const { return is_bounded_; }
  /// The law is a spring while closed, without residual force.
  bool is_linear() const { return is_linear_; }

 private:
  /// Stops nearer to the middle than this part of their gap have just left it.
  static constexpr double kLeaving = 1e-50;

  void add_spring(const ContactPath& path, double begin, double end, double side, Projection& to) const;
  double steepest(const ContactPath& path) const;
  /// The rest of the law: its force minus the spring force on `side` (0: no spring), N.
  double rest_at(double w, double side);
  /// The limit of the rest far from the bends of the law, N.
  double constant_rest(double w, double side);
  /// The moments of the rest over a part of the step.
  ForceMoments of_rest(const ContactPath& path, double begin, double end, double side);
  /// The same with the constant limit of the rest.
  ForceMoments of_constant_rest(const ContactPath& path, double begin, double end, double side);
  /// The moments of the rest between `graded` and `other`, on panels that shrink towards `graded`.
  ForceMoments of_graded_rest(const ContactPath& path, double graded, double other, double side);
  /// +1, -1: the side on which a spring acts; 0: none.
  double side_at(double w) const { return on_upper_ && w > gap_ ? 1.0 : on_lower_ && w < -gap_ ? -1.0 : 0.0; }
  /// The whole path is far from the bends of the law.
  bool is_off_bends(const ContactPath& path) const;
  /// The rest may be approximated by a constant between bends.
  bool is_constant_beside_bends(const ContactPath& path) const;
  /// The rest keeps its sign between bends.
  bool stays_on_a_side(const ContactPath& path) const;
  Projection of_pieces(const ContactPath& path);
  /// The projection for a constant rest and a path that crosses one border once; false in any other
  /// case.
  bool of_one_crossing(const ContactPath& path, Projection& to);
  /// Fills places_ with 0, the places where the path crosses a border of the law, and 1.
  void find_places(const ContactPath& path);
  void add_crossings(const ContactPath& path, double border);

  /// Error bounds as fractions of the residual force: kShortcuts for the constant rest at kFarOff
  /// and beside kSharp, kPreciseError for kPrecisePanels.
  static constexpr double kShortcuts = 3e-3, kPreciseError = 2e-4;

  dynamics::ElasticStops& contact_;
  Index stop_;
  double gap_, stiffness_, transition_width_, residual_;
  bool is_precise_ = false, is_finest_ = false;
  bool is_linear_, is_bounded_, on_upper_, on_lower_;
  struct RestLimits {
    double open, closed;
  };
  bool knows_limits_ = false;
  RestLimits upper_limits_{}, lower_limits_{};
  struct Place {
    double s;
    bool is_bend;  ///< g = 0
  };
  std::vector<Place> places_;
};

}  // namespace butee::integrators
