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
  /// A mode whose free motion decays at two rates.
  struct Overdamped {
    Index mode;
    double slow, fast;     ///< the roots, 1/s, negative
    double of_fast = 0.0;  ///< the part of q that decays at the fast rate, at the last breakpoint
  };
  /// Computes the bounds for the step that begins at a breakpoint.
  void find(std::size_t breakpoint);
  /// Lowers the bounds by those of the steady response to harmonic loads and of the free vibration beside it.
  void find_beside_steady(double t, const Eigen::ArrayXd& q, const Eigen::ArrayXd& v);
  /// The bounds of an overdamped mode: its steady state and the part of the slow rate; sets of_fast.
  void find(Overdamped& mode, double t, double h, double q, double v);

  const dynamics::ModalSystem& modal_;
  const Breakpoints& breakpoints_;
  std::size_t known_ = kNone;         ///< the breakpoint for which of_ is valid
  std::array<Eigen::ArrayXd, 7> of_;  ///< entry k bounds derivative k of each mode, without of_fast
  std::vector<Overdamped> overdamped_;
};

}  // namespace butee::integrators
