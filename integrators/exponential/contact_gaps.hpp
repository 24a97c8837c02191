#pragma once

#include "butee/dynamics/elastic_stops.hpp"
#include "integrators/exponential/tried_step.hpp"

namespace butee::integrators {

/// The gaps of all stops and the sides on which they act, as arrays padded to whole vector
/// registers. Checked in tests/unit/contact_gaps_test.cpp.
class ContactGaps {
 public:
  explicit ContactGaps(const dynamics::ElasticStops& contact);

  const Eigen::ArrayXd& gaps() const { return gaps_; }
  /// The displacements at which a stop closes, m; infinite on a side on which it does not act.
  const Eigen::ArrayXd& upper() const { return upper_; }
  const Eigen::ArrayXd& lower() const { return lower_; }
  /// constant_force_limit() of each stop, m
  const Eigen::ArrayXd& limits() const { return limits_; }

  /// The side (+1, -1) on which a stop is closed at w; 0 if it is open.
  double closed_side(Index stop, double w) const { return w > upper_[stop] ? 1.0 : w < lower_[stop] ? -1.0 : 0.0; }
  /// A stop without a gap that acts on both sides is always closed.
  bool is_spring(Index stop) const { return !(upper_[stop] > lower_[stop]); }
  /// The stop closes or opens, or both, on a path between two displacements that exceeds the gap by `excess` (negative
  /// if it does not).
  bool changes(Index stop, double from, double to, double excess) const {
    if (is_spring(stop)) return false;
    const double before = closed_side(stop, from);
    return before != closed_side(stop, to) || (before == 0.0 && excess > 0.0);
  }
  /// The law of the stop passes the end of its bend between two displacements.
  bool passes_inner_border(Index stop, double from, double to) const {
    if (inner_borders_[stop] == 0.0) return false;
    const double upper = upper_[stop] + inner_borders_[stop], lower = lower_[stop] - inner_borders_[stop];
    return (from > upper) != (to > upper) || (from < lower) != (to < lower);
  }
  /// The stop is closed on the same side at both displacements, or always.
  bool stays_closed(Index stop, double from, double to) const {
    return is_spring(stop) || (from > upper_[stop] && to > upper_[stop]) || (from < lower_[stop] && to < lower_[stop]);
  }
  /// Bounds of |w| over a step from w to w_end, only on the sides on which a stop acts. `bump`
  /// bounds the departure from the straight line between the ends, m.
  template <class Bump>
  void bound_displacements(const Eigen::ArrayXd& w, const Eigen::ArrayXd& w_end, const Bump& bump,
                           Eigen::ArrayXd& bounds) const {
    bounds = (w.max(w_end) - off_upper_).max(-w.min(w_end) - off_lower_) + bump;
  }
  /// The time until the first stop reaches its limit at the present speeds, s; infinite if no stop
  /// approaches its limit.
  double time_to_contact(const ModalState& now) const;

 private:
  Eigen::ArrayXd gaps_, upper_, lower_, limits_;
  Eigen::ArrayXd inner_borders_;          ///< inner_border() of the laws, m
  Eigen::ArrayXd off_upper_, off_lower_;  ///< 0, or larger than any displacement on a side on which it does not act
};

/// Displacement bounds of the stops over a step; they determine the stops that may close. The cubic
/// through the ends is bounded by its Hermite functions, the departure from it by the Hermite
/// interpolation error of each mode and load (plugins/exponential/THEORY.md, section 7).
class DisplacementBounds {
 public:
  /// `modal` must outlive it.
  DisplacementBounds(const dynamics::ModalSystem& modal, const dynamics::ElasticStops& contact);

  const ContactGaps& gaps() const { return gaps_; }
  /// longest_near_stops(), s
  double longest_near() const { return longest_near_; }

  void find(const dynamics::ContactPropagator& flow, const TriedStep& step);
  /// Recomputes the bounds for a changed end of the step.
  void update(const TriedStep& step);
  /// Adds to step.carried the stops whose path with the forces of other stops exceeds the gap
  /// according to its bounds; true if there are any. `start_speed` is h times the speed at the
  /// start, m.
  bool find_carried(const Eigen::ArrayXd& start_speed, const dynamics::StopMotion& path, TriedStep& step);

  const Eigen::ArrayXd& all() const { return bounds_; }
  /// The stop may come so near its gap that its force is not constant.
  bool is_near(Index stop) const { return bounds_[stop] > gaps_.limits()[stop]; }
  /// Fills `stops` with all that are near, in order.
  void find_near(std::vector<Index>& stops) const;
  /// The part of the Hermite interpolation error due to loads, m.
  double of_loads() const { return of_loads_; }

 private:
  const dynamics::ModalSystem& modal_;
  ContactGaps gaps_;
  double longest_near_;
  Eigen::ArrayXd bounds_, path_bounds_;
  double of_loads_ = 0.0, beyond_cubic_ = 0.0;
};

}  // namespace butee::integrators
