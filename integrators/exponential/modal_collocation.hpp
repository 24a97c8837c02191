#pragma once

#include <algorithm>
#include <list>
#include <span>

#include "integrators/exponential/collocation_outputs.hpp"
#include "integrators/exponential/modal_loads.hpp"
#include "integrators/exponential/node_forces.hpp"
#include "integrators/exponential/step_response.hpp"

namespace butee::integrators {

/// The form of `exponential` for structures with coupled modes (dashpots, rotating parts of any speed, bearings
/// with cross terms) and for contacts in the plane, with dissipation or with friction.
///
/// The linear part, including harmonic loads, is exact in damped modes (dynamics::DampedModes).
/// Over a step each contact force is a polynomial through its values at the six points of Lobatto's
/// rule and in the middle; other loads are polynomials over a step too. Sweeps find the forces:
/// forces at the nodes, motion of the contacts, forces again. The error of the step is the change
/// of its end if the value in the middle is left out and the forces are evaluated once more, plus
/// the error of Lobatto's rule. A smooth step has order 10. Steps end where a contact changes its
/// phase and at the borders of stops (StopBorders). Derivation:
/// plugins/exponential/COLLOCATION.md.
class ModalCollocation final : public time::Integrator {
 public:
  ModalCollocation(dynamics::Dynamics& dynamics, const Goal& goal, Index most_coupled = dynamics::DampedModes::kMost);

  /// The tolerance below which rounding in the basis of modes may exceed the guaranteed error
  /// (COLLOCATION.md, Damped modes).
  double smallest_tolerance() const { return std::max(kRoundings * modes_.condition(), modes_.rounding()); }

  const time::StepController* controller() const override { return &control_.controller(); }
  double first_step(const time::State& state) const override;
  time::Traits traits() const override {
    return {.follows_contact_phases = true,
            .event_precision = std::min(1e-7, 1e-4 * tolerance_),
            .velocity_uncertainty = control_.velocity_uncertainty()};
  }

 private:
  /// 2.2e-16, over the 10 tolerances of the guarantee, over its smallest scale, a thousandth of the
  /// largest displacement.
  static constexpr double kRoundings = 2.2e-14;

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  time::Interpolant& interpolant() override;

  /// The response over a step of length h, computed at its first use.
  const StepResponse& response(double h);
  /// Shortens the step that forces_ holds so that it ends at to.t, with the same forces; false if
  /// their error is too large there.
  bool end_at(const time::State& from, time::State& to, time::StepReport& report);
  /// Fills `to` with the end of the step that forces_ holds, and motion_.
  void accept(const time::State& from, double h, time::State& to);
  /// Judges the errors of displacements and velocities at the end of the step.
  void judge(const time::State& from, time::State& to, double h, time::StepReport& report);
  /// The step that ended at this state was shortened by a change of contact, which is the last entry of its memory.
  static bool was_shortened(const time::State& state) { return state.memory.tail(1)[0] != 0.0; }
  const double* modal(const time::State& state) const { return state.memory.data() + memory_begin_; }

  LocalErrorControl control_;
  dynamics::DampedModes modes_;
  ModalLoads loads_;
  NodeForces forces_;
  ModalSuperposition all_dofs_;
  LanesOf<4> motion_;  ///< displacements at the end of a step and their errors, velocities and their errors
  double tolerance_, rate_;
  Index memory_begin_;  ///< offset of z and the force polynomials in State::memory
  std::list<StepResponse> responses_;
  StepResponse of_part_;                       ///< over the last step that was shortened
  double step_begin_ = 0.0, step_end_ = -1.0;  ///< the step that forces_ holds, s
  double solved_end_ = -1.0;                   ///< end of the step for which its forces were computed, s
  bool are_nodes_known_ = true;                ///< false: forces_ holds the end of a shortened step, not yet its nodes
  CollocationOutputs outputs_;
};

}  // namespace butee::integrators
