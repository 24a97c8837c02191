#pragma once

#include <array>
#include <span>
#include <vector>

#include "butee/dynamics/modal_motion.hpp"
#include "integrators/exponential/contact_force.hpp"
#include "integrators/exponential/single_breakpoint.hpp"

namespace butee::integrators {

/// The motion of one DOF with one stop at a breakpoint, and within a step: under harmonic loads and the projected force
/// of the stop in closed form. The force of a stop that changes its status is projected anew.
class SingleMotion {
 public:
  /// All must outlive it.
  SingleMotion(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, const SingleMode& mode,
               ContactForce& contact);

  /// At a breakpoint where the loads have these phases.
  Motion at(Oscillator::Point point, std::span<const Phase> phases) const;
  /// At t between two breakpoints, of which the loads have these phases at the first.
  Motion within(const SingleBreakpoint& from, const SingleBreakpoint& to, std::span<const Phase> phases, double t);

 private:
  /// The motion that a load maintains by itself.
  struct Maintained {
    double cosine, sine;
  };
  /// `load`: modal force of the loads.
  Motion motion_of(Oscillator::Point at, double load) const;

  dynamics::Dynamics& dynamics_;
  const SingleMode& mode_;
  ContactForce& contact_;
  Oscillator oscillator_;
  std::vector<Maintained> maintained_;  ///< by load
  bool is_resonant_ = false;            ///< a load has no such motion
  dynamics::ModalMotion motion_;        ///< where oscillator_ cannot
  Eigen::VectorXd padded_q_, padded_v_;
  std::array<Eigen::VectorXd, 3> padded_force_;
};

}  // namespace butee::integrators
