#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "integrators/contact_state_flow.hpp"

namespace butee::integrators {

/// What a stop does: open, closed on a side (+1, -1), or with dissipation and beyond its gap on a side, yet without
/// force.
using StopStatus = std::int8_t;
inline constexpr StopStatus kOpen = 0, kClosed = 1, kReleased = 2;
inline StopStatus on_side(StopStatus status, double side) {
  return static_cast<StopStatus>(side < 0.0 ? -status : status);
}
inline bool is_closed(StopStatus status) {
  return status == kClosed || status == -kClosed;
}

/// How far g(s) surely stays positive, s: the first root, from below, of its Taylor polynomial of degree 2 less
/// `third` s^3/6, a bound of the third derivative. g(0) > 0, or g(0) = 0 and then positive. Infinite where there is
/// none.
double safe_step(double g, double slope, double curvature, double third);

/// Finds the first change of status of any stop along a piece of a contact state.
///
/// Every switching function is positive until it changes sign. Bounds of its third derivative over the rest of the
/// piece give a step that cannot pass a root; near a simple root it is Newton's. Only the stop whose step ends first is
/// looked at again. A function that is zero to rounding is decided by its first derivative that is not. Theory:
/// piecewise.md. Checked in tests/unit/first_change_test.cpp.
class FirstChange {
 public:
  /// `system` must outlive it.
  explicit FirstChange(const SmallSystem& system);

  struct Change {
    Index stop;
    StopStatus to;
  };
  struct Result {
    double s;                      ///< of the change; else until where none occurs, s
    std::optional<Change> change;  ///< nothing: the piece may go on from s
  };
  /// For 0 <= s <= `until`. `changed`: the stop that has just changed, if any, and so is on its border. `wait`: stops
  /// that are on a border to rounding wait there until they have left it, which ends chatter by rounding.
  Result find(const ContactStateFlow& flow, ContactStateFlow::Piece& piece, std::span<const StopStatus> status,
              double until, Index changed, bool wait);

  /// Looks at single stops, ever.
  std::int64_t looks() const { return looks_; }

 private:
  struct Watch {
    double next = 0.0;  ///< nothing happens before, s
    bool is_change = false;
    StopStatus to = kOpen;
    std::array<double, 5> bounds{}, sizes{};  ///< over the rest of the piece, and of what is summed at its start
    double bounded_at = 0.0;                  ///< where they were taken, s
    bool has_changed = false;
  };
  /// One switching function and its bounds.
  struct Function {
    Jet g;
    std::array<double, 4> noise;
    double third, fourth;
    StopStatus to;
    bool has_changed;
  };
  void look(const ContactStateFlow& flow, const ContactStateFlow::Piece& piece, Index stop, StopStatus status,
            double until, bool wait);
  void consider(const Function& function, double s, double until, double t, bool wait, Watch& watch) const;

  const SmallSystem& system_;
  std::vector<Watch> watches_;
  std::int64_t looks_ = 0;
};

}  // namespace butee::integrators
