#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "integrators/contact_state_flow.hpp"

namespace butee::integrators {

/// The status of a stop: open, closed on a side (+1, -1), or released (+2, -2): a stop with
/// dissipation that is beyond its gap but exerts no force.
using StopStatus = std::int8_t;
inline constexpr StopStatus kOpen = 0, kClosed = 1, kReleased = 2;
inline StopStatus on_side(StopStatus status, double side) {
  return static_cast<StopStatus>(side < 0.0 ? -status : status);
}
inline bool is_closed(StopStatus status) {
  return status == kClosed || status == -kClosed;
}

/// A time s, in seconds, up to which g stays positive: a lower bound of the first root of the
/// Taylor polynomial of degree 2 minus `third` s^3/6, with `third` a bound of the third derivative.
/// Requires g(0) > 0, or g(0) = 0 and g > 0 just after. Infinite if there is no root.
double safe_step(double g, double slope, double curvature, double third);

/// Finds the first change of status of any stop along a piece of the motion.
///
/// Every switching function is positive until the status changes. A bound of its third derivative
/// over the rest of the piece gives a step that cannot pass a root; near a simple root this is
/// Newton's step. Only the stop whose step ends first is evaluated again. If a function is zero to
/// rounding, its first derivative that is not zero to rounding decides. Theory: piecewise.md.
/// Checked in tests/unit/first_change_test.cpp.
class FirstChange {
 public:
  /// `system` must outlive it.
  explicit FirstChange(const SmallSystem& system);

  struct Change {
    Index stop;
    StopStatus to;
    double uncertainty;  ///< rounding error of the displacement at which it was located, m
  };
  /// The stop that has changed at the start of a piece, which is therefore on its border within `uncertainty`; -1:
  /// none.
  struct Changed {
    Index stop = -1;
    double uncertainty = 0.0;  ///< m
  };
  struct Result {
    double s;                      ///< time of the change, s; without a change, the time up to which none occurs
    std::optional<Change> change;  ///< empty: the search may continue from s
  };
  /// Searches 0 <= s <= `until`. `chatter`: the largest uncertainty of the changes at this instant, m, if stops
  /// chatter by rounding; those within it of a border then keep their status until they have left it.
  Result find(const ContactStateFlow& flow, ContactStateFlow::Piece& piece, std::span<const StopStatus> status,
              double until, Changed changed, std::optional<double> chatter);

  /// Number of evaluations of single stops since construction.
  std::int64_t looks() const { return looks_; }

 private:
  struct Watch {
    double next = 0.0;  ///< no change occurs before this time, s
    bool is_change = false;
    StopStatus to = kOpen;
    double uncertainty = 0.0;  ///< of the change, m
    std::array<double, 5> bounds{},
        sizes{};  ///< bounds of |w| and derivatives over the rest of the piece, and of the terms summed at its start
    double bounded_at = 0.0;  ///< time at which the bounds were computed, s
    double border = 0.0;      ///< distance within which the stop is on its border, if it has just changed, m
    bool has_changed = false;
  };
  /// One switching function and its bounds.
  struct Function {
    Jet g;
    std::array<double, 4> noise;
    double third, fourth;
    StopStatus to;
    double per_displacement;  ///< unit of g for a displacement of 1 m
  };
  void look(const ContactStateFlow& flow, const ContactStateFlow::Piece& piece, Index stop, StopStatus status,
            double until, std::optional<double> chatter);
  void consider(const Function& function, double s, double until, double t, std::optional<double> chatter,
                Watch& watch) const;

  const SmallSystem& system_;
  std::vector<Watch> watches_;
  std::int64_t looks_ = 0;
};

}  // namespace butee::integrators
