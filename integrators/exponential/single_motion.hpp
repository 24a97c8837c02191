#pragma once

#include <array>
#include <span>
#include <vector>

#include "butee/dynamics/modal_motion.hpp"
#include "integrators/exponential/contact_force.hpp"
#include "integrators/exponential/single_breakpoint.hpp"

namespace butee::integrators {

/// The motion of one DOF with one stop at a breakpoint and within a step, in closed form under
/// harmonic loads and the projected force of the stop. If the stop changes its status, its force is
/// projected again up to the instant.
class SingleMotion {
 public:
  /// All must outlive it.
  SingleMotion(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, const SingleMode& mode,
               ContactForce& contact);

  /// The motion at a breakpoint; `phases` of the loads there.
  Motion at(Oscillator::Point point, std::span<const Phase> phases) const;
  /// The motion at t between two breakpoints; `phases` of the loads at the first.
  Motion within(const SingleBreakpoint& from, const SingleBreakpoint& to, std::span<const Phase> phases, double t);

 private:
  /// The steady-state response to a load.
  struct Maintained {
    double cosine, sine;
  };
  /// `load`: modal force of all loads.
  Motion motion_of(Oscillator::Point at, double load) const;

  dynamics::Dynamics& dynamics_;
  const SingleMode& mode_;
  ContactForce& contact_;
  Oscillator oscillator_;
  std::vector<Maintained> maintained_;  ///< one per load
  bool is_resonant_ = false;            ///< a load has no steady-state response
  dynamics::ModalMotion motion_;        ///< used if oscillator_ is not accurate
  Eigen::VectorXd padded_q_, padded_v_;
  std::array<Eigen::VectorXd, 3> padded_force_;
};

}  // namespace butee::integrators
