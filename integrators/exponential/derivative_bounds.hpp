#pragma once

#include <array>
#include <span>

#include "butee/time/integrator.hpp"
#include "integrators/exponential/breakpoints.hpp"

namespace butee::integrators {

/// Bounds of the modal coordinates and their first six derivatives between two breakpoints without contact, and of the
/// departure of the motion from a quintic (plugins/exponential/THEORY.md, section 10). Checked in
/// tests/unit/derivative_bounds_test.cpp.
class DerivativeBounds {
 public:
  /// Both must outlive it.
  DerivativeBounds(const dynamics::ModalSystem& modal, const Breakpoints& breakpoints)
      : modal_(modal), breakpoints_(breakpoints) {}

  /// At a new macro step.
  void begin() { known_ = kNone; }
  /// time::Integrator::departure()
  void departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out);

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  /// From a breakpoint on.
  void find(std::size_t breakpoint);

  const dynamics::ModalSystem& modal_;
  const Breakpoints& breakpoints_;
  std::size_t known_ = kNone;         ///< the breakpoint that of_ holds from
  std::array<Eigen::ArrayXd, 7> of_;  ///< by derivative
};

}  // namespace butee::integrators
