#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "butee/config/parameters.hpp"
#include "butee/dynamics/dynamics.hpp"
#include "butee/time/contact_events.hpp"
#include "butee/time/state.hpp"
#include "butee/time/step_controller.hpp"

namespace butee::time {

/// Where interpolate() writes: one entry per DOF asked for, instant by instant; an empty span is not computed.
struct Interpolated {
  std::span<double> x, v, a;
};

/// The energies of a motion at an instant, J; work and dissipation since the step began.
struct EnergyAt {
  double t = 0.0;  ///< s
  double kinetic = 0.0, strain = 0.0, contact = 0.0;
  double work = 0.0, dissipated = 0.0;
};

/// The dense output of a method between two neighbouring breakpoints of a step.
enum class DenseOutput {
  cubic,         ///< x the cubic through x and v at both, v the one through v and a, a the straight line
  quintic,       ///< x the quintic through x, v and a at both, or the cubic by x and v; v and a its derivatives
  near_quintic,  ///< near to that quintic: v by 1/200 of its largest value or less
  other          ///< any smooth motion; departure() bounds it
};

/// A time integration method: takes State over a Step.
///
/// A step is a pure function of (state, step): what a method remembers is in the state, so that a rejected step needs
/// no undoing and a restart is bit-identical. The method asks its Dynamics for accelerations and effective solves and
/// owns no matrix. To write one, derive and override do_step(); the public functions check and call the private ones.
class BUTEE_EXPORT Integrator {
 public:
  /// `dynamics` must outlive it.
  explicit Integrator(dynamics::Dynamics& dynamics) : dynamics_(dynamics) {}
  virtual ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Completes a state of which t, x and v are given: a = M^-1 (F + F_c - C v - K x), and the method's memory.
  void start(State& state);
  /// The same where the contacts go on from what contact_memory() gave of another run; it may be empty.
  void start(State& state, ConstVectorRef contact_memory);

  /// Takes contacts whose phase is over at a state to the next one; its acceleration follows. `h` is the length of the
  /// step to come. A state must be settled before a step from it.
  void settle(State& state, double h);

  /// Computes the state at the end of the step. `to` is of no use where the report's status is not ok.
  StepReport step(const State& from, const Step& step, State& to);

  /// The motion of `dofs` at `t` in [from.t, to.t] of an accepted step.
  void interpolate(const State& from, const State& to, double t, std::span<const Index> dofs, Interpolated out) const {
    interpolate(from, to, {&t, 1}, dofs, out);
  }
  /// The same at several instants, ascending.
  void interpolate(const State& from, const State& to, std::span<const double> times, std::span<const Index> dofs,
                   Interpolated out) const;

  /// What chose this method, and why, where the scene did not: "exponential, tolerance 1e-4: ...".
  const std::string& choice() const { return choice_; }
  void set_choice(std::string choice) { choice_ = std::move(choice); }

  /// The judge of an adaptive method; nullptr for fixed steps.
  virtual const StepController* controller() const { return nullptr; }

  /// The length of a first step from `state` that the method finds itself, s; asked for where time_step is absent,
  /// which its IntegratorType must allow.
  virtual double first_step(const State& state) const {
    (void)state;
    return 0.0;
  }

  /// The largest stable h omega where its parameters narrow what its IntegratorType declares.
  virtual double stability_limit() const { return std::numeric_limits<double>::infinity(); }

  /// The energies at the first breakpoints of an accepted step at or after each of `instants`, ascending, and at its
  /// end, where the method knows them for less than the motion of all DOFs would cost; else none. Valid until the next
  /// call.
  virtual std::span<const EnergyAt> energies(const State& from, const State& to,
                                             std::span<const double> instants) const {
    (void)from, (void)to, (void)instants;
    return {};
  }

  /// True where the method itself minds the instants at which a load or its derivative jumps. Steps of all other
  /// adaptive methods end there: a load that lasts shorter than a step could pass unseen.
  virtual bool handles_load_discontinuities() const { return false; }

  /// True where steps that the method takes may end at changes of phase of contacts (ContactEvents), between which it
  /// integrates; else contacts act by the motion of the instant alone, and laws with memory are refused.
  virtual bool follows_contact_phases() const { return false; }

  /// The part of a step by which its end may miss a change of phase, for methods that follow phases.
  virtual double event_precision() const { return 1e-12; }

  /// The motion of `dofs` within the last step that was computed, as those see it who look for changes of contact: as
  /// interpolate(), or where that is much cheaper by a polynomial as good as the method's own view of its contacts.
  void trace(const State& from, const State& to, double t, std::span<const Index> dofs, Interpolated out) const {
    do_trace(from, to, t, dofs, out);
  }

  /// The parts of a step that those who look for changes of contact look at one by one: those between breakpoints,
  /// unless trace() is smoother.
  virtual int trace_parts(const State& from, const State& to) const {
    return static_cast<int>(1 + breakpoints(from, to).size());
  }

  /// True where steps best end at the instants that observers ask for, since any length is as good.
  virtual bool lands_on_outputs() const { return false; }

  /// The instants, ascending and strictly within an accepted step, between which the method took steps of its own; its
  /// dense output is smooth between them.
  virtual std::span<const double> breakpoints(const State& from, const State& to) const {
    (void)from, (void)to;
    return {};
  }

  /// What interpolate() gives, for those who look for extremes of the motion.
  virtual DenseOutput dense_output() const { return DenseOutput::cubic; }

  /// Of DenseOutput::other alone: bounds, for each DOF, of how far x, v and a between two instants of an accepted step
  /// that no breakpoint parts depart from the quintic through x, v and a at both and its derivatives.
  virtual void departure(const State& from, const State& to, double begin, double end, std::span<const Index> dofs,
                         Interpolated out) const {
    (void)from, (void)to, (void)begin, (void)end, (void)dofs, (void)out;
  }

 protected:
  dynamics::Dynamics& dynamics() const { return dynamics_; }

 private:
  virtual void do_start(State& state);
  virtual StepReport do_step(const State& from, const Step& step, State& to) = 0;
  /// Default: cubic Hermite for x from (x, v) and for v from (v, a), linear for a.
  virtual void do_interpolate(const State& from, const State& to, double t, std::span<const Index> dofs,
                              Interpolated out) const;
  /// Default: one instant after the other. To be overridden where they have something in common.
  virtual void do_interpolate_all(const State& from, const State& to, std::span<const double> times,
                                  std::span<const Index> dofs, Interpolated out) const;

  virtual void do_trace(const State& from, const State& to, double t, std::span<const Index> dofs,
                        Interpolated out) const {
    interpolate(from, to, t, dofs, out);
  }

  /// Cuts an accepted step at the first change of phase within it.
  void end_at_event(const State& from, const Step& step, State& to, StepReport& report);

  dynamics::Dynamics& dynamics_;
  std::unique_ptr<ContactEvents> events_;  ///< null unless it follows phases of contacts
  std::string choice_;
};

/// The contacts that a method can treat beside elastic stops.
enum class ContactSupport {
  elastic_stops,   ///< none
  without_memory,  ///< rings, planes, dissipation, regularised friction
  without_rigid,   ///< and friction with a stick spring
  all              ///< and rigid stick
};

/// A registered method: its names, parameters and maker. `time_step` and `end_time` are read for it.
///
///     {.name = "my_method", .summary = "...", .parameters = {...}, .order = 2.0, .fixed_step = true, .make = ...}
struct IntegratorType {
  std::string name{};
  std::vector<std::string> aliases{};
  std::string summary{};
  std::vector<config::Parameter> parameters{};
  /// The order of convergence of x and v with equal steps of smooth motion; 0: not stated, or no such order.
  double order = 0.0;
  /// The largest h omega at which undamped oscillation stays bounded; infinite for unconditionally stable methods.
  double stability_limit = std::numeric_limits<double>::infinity();
  /// The largest h c/m at which a mass with a dashpot c alone comes to rest; infinite for unconditionally stable ones.
  double damping_limit = std::numeric_limits<double>::infinity();
  /// True where time_step alone sets the accuracy, so that comparisons sweep it.
  bool fixed_step = false;
  /// True where the method finds its first step itself, so that time_step may be absent.
  bool finds_first_step = false;
  /// False where a method remembers more than the State holds, so that a run taken up again from a checkpoint would not
  /// be the unbroken one to the last bit; checkpoints are then refused.
  bool restarts_exactly = true;
  ContactSupport contacts = ContactSupport::elastic_stops;
  std::function<std::unique_ptr<Integrator>(const config::Parameters&, dynamics::Dynamics&)> make{};
  /// Reports values that are each allowed but do not go together. May be empty.
  std::function<void(const config::Parameters&, config::Diagnostics&)> check{};
};

}  // namespace butee::time
