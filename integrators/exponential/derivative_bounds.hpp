#pragma once

#include <array>
#include <span>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/exponential/breakpoints.hpp"

namespace butee::integrators {

/// Bounds of the modal coordinates and their first six derivatives between two breakpoints without
/// contact, and of the difference between the motion and a quintic (plugins/exponential/THEORY.md,
/// section 10). Checked in tests/unit/derivative_bounds_test.cpp.
class DerivativeBounds {
 public:
  /// Both must outlive it.
  DerivativeBounds(const dynamics::ModalSystem& modal, const Breakpoints& breakpoints);

  /// Starts a new macro step.
  void begin() { known_ = kNone; }
  /// time::Interpolant::departure()
  void departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out);

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  /// Entry k bounds derivative k of each mode.
  using OfModes = std::array<Eigen::ArrayXd, 7>;
  /// Free motion whose derivative k is at most amplitude rate^k e^(-decay s), s behind the breakpoint.
  struct Decaying {
    Eigen::ArrayXd amplitude, rate, decay;
  };

  /// Computes the bounds for the step that begins at a breakpoint.
  void find(std::size_t breakpoint);
  /// The bounds of a mode with q and v at t by its forced response and its free motion.
  void find(Index mode, double t, double h, double q, double v);
  /// of_ := the bounds of the forced and free motion at `since` behind the breakpoint without the fast parts, and
  /// of_fast_ := those of these.
  void find_bounds(double since);
  /// Bounds of the departures of x, v or a (order 0, 1, 2) of each mode from a quintic over h. Searches halve the step
  /// again and again; the bounds for these lengths are kept.
  const Eigen::ArrayXd& of_modes(std::size_t order, double h);
  Eigen::ArrayXd find_of_modes(std::size_t order, double h) const;

  const dynamics::ModalSystem& modal_;
  const Breakpoints& breakpoints_;
  std::size_t known_ = kNone;  ///< the breakpoint for which the bounds are valid
  double longest_ = 0.0;       ///< length of the step that begins there, s
  double since_ = -1.0;        ///< s behind the breakpoint, of the last find_bounds(); below 0: none
  OfModes by_energy_, forced_, of_, of_fast_;
  /// The bounds by order and number of halvings, and those of the last length that is no such part of the step.
  std::array<std::vector<Eigen::ArrayXd>, 3> departures_;
  Eigen::ArrayXd of_other_;
  Decaying free_;  ///< or the slow part of an overdamped mode
  Decaying fast_;  ///< the fast part of an overdamped mode; amplitude 0: others
};

}  // namespace butee::integrators
