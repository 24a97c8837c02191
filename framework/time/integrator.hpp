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

/// Output arrays of interpolate(): one entry for each DOF asked for, instant by instant. An empty
/// span is not computed.
struct Interpolated {
  std::span<double> x, v, a;
};

/// Energies at an instant, J; work and dissipation are counted from the beginning of the step.
struct EnergyAt {
  double t = 0.0;  ///< s
  double kinetic = 0.0, strain = 0.0, contact = 0.0;
  double work = 0.0, dissipated = 0.0;
};

/// The dense output of a method between two neighbouring breakpoints of a step.
enum class DenseOutput {
  cubic,         ///< x: cubic through x and v at both ends; v: cubic through v and a; a: linear
  quintic,       ///< x: quintic through x, v and a at both ends, or the cubic through x and v; v and a its derivatives
  near_quintic,  ///< close to that quintic: v differs by at most 1/200 of its largest value
  other          ///< any smooth motion; departure() bounds it
};

/// A time integration method: advances a State over a Step.
///
/// A step is a pure function of (state, step): all memory of a method is in the state, so that a
/// rejected step needs no undoing and a restart is bit-identical. The method asks its Dynamics for
/// accelerations and effective solves and owns no matrix. To write a method, derive and override
/// do_step(); the public functions check and call the private ones.
class BUTEE_EXPORT Integrator {
 public:
  /// `dynamics` must outlive this object.
  explicit Integrator(dynamics::Dynamics& dynamics) : dynamics_(dynamics) {}
  virtual ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Completes a state with given t, x and v: a = M^-1 (F + F_c - C v - K x), and the method's
  /// memory.
  void start(State& state);
  /// The same; the contacts continue from the result of contact_memory() of another run, which may
  /// be empty.
  void start(State& state, ConstVectorRef contact_memory);

  /// Switches contacts whose phase is over at a state to the next phase; the acceleration follows.
  /// `h` is the length of the coming step. A state must be settled before a step from it.
  void settle(State& state, double h);

  /// Computes the state at the end of the step. `to` is meaningful only if the report's status is
  /// ok.
  StepReport step(const State& from, const Step& step, State& to);

  /// The motion of `dofs` at `t` in [from.t, to.t] of an accepted step.
  void interpolate(const State& from, const State& to, double t, std::span<const Index> dofs, Interpolated out) const {
    interpolate(from, to, {&t, 1}, dofs, out);
  }
  /// The same at several instants, ascending.
  void interpolate(const State& from, const State& to, std::span<const double> times, std::span<const Index> dofs,
                   Interpolated out) const;

  /// Why `auto` chose this method: "exponential, tolerance 1e-4: ..."; empty if the scene names the
  /// method.
  const std::string& choice() const { return choice_; }
  void set_choice(std::string choice) { choice_ = std::move(choice); }

  /// The step-size controller of an adaptive method; nullptr for fixed steps.
  virtual const StepController* controller() const { return nullptr; }

  /// The length of the first step from `state`, s, found by the method. Called if time_step is
  /// absent, which the IntegratorType must allow.
  virtual double first_step(const State& state) const {
    (void)state;
    return 0.0;
  }

  /// The largest stable h omega, if the parameters make it smaller than the limit that the
  /// IntegratorType declares.
  virtual double stability_limit() const { return std::numeric_limits<double>::infinity(); }

  /// The energies at the first breakpoints of an accepted step at or after each of `instants`
  /// (ascending), and at its end, if the method can compute them for less than the motion of all
  /// DOFs would cost; else empty. Valid until the next call.
  virtual std::span<const EnergyAt> energies(const State& from, const State& to,
                                             std::span<const double> instants) const {
    (void)from, (void)to, (void)instants;
    return {};
  }

  /// True if the method handles the instants itself at which a load or its derivative jumps. Steps
  /// of all other adaptive methods end there, since a load shorter than a step could be missed.
  virtual bool handles_load_discontinuities() const { return false; }

  /// True if steps of the method may end at changes of phase of contacts (ContactEvents), between
  /// which it integrates. Otherwise the contact forces depend on the motion at each instant alone,
  /// and laws with memory are refused.
  virtual bool follows_contact_phases() const { return false; }

  /// The largest error of a located change of phase, as a fraction of the step, for methods that
  /// follow phases.
  virtual double event_precision() const { return 1e-12; }

  /// The motion of `dofs` within the last computed step, for the detection of changes of contact:
  /// the result of interpolate() or, if much cheaper, a polynomial as accurate as the method's own
  /// representation of its contacts.
  void trace(const State& from, const State& to, double t, std::span<const Index> dofs, Interpolated out) const {
    do_trace(from, to, t, dofs, out);
  }

  /// The number of parts of a step that the detection of contact changes examines one by one: the
  /// parts between breakpoints, unless trace() is smoother.
  virtual int trace_parts(const State& from, const State& to) const {
    return static_cast<int>(1 + breakpoints(from, to).size());
  }

  /// True if steps should end at the output instants that observers ask for, since the method can
  /// take any step length.
  virtual bool lands_on_outputs() const { return false; }

  /// The instants, ascending and strictly within an accepted step, between which the method took
  /// internal steps. The dense output is smooth between them.
  virtual std::span<const double> breakpoints(const State& from, const State& to) const {
    (void)from, (void)to;
    return {};
  }

  /// The kind of motion that interpolate() gives, for the search for extremes.
  virtual DenseOutput dense_output() const { return DenseOutput::cubic; }

  /// For DenseOutput::other only: for each DOF, bounds on how far x, v and a depart from the
  /// quintic through x, v and a at both instants, and its derivatives, between two instants of an
  /// accepted step with no breakpoint between them.
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
  /// Default: one instant after the other. Override if several instants share work.
  virtual void do_interpolate_all(const State& from, const State& to, std::span<const double> times,
                                  std::span<const Index> dofs, Interpolated out) const;

  virtual void do_trace(const State& from, const State& to, double t, std::span<const Index> dofs,
                        Interpolated out) const {
    interpolate(from, to, t, dofs, out);
  }

  /// Cuts an accepted step at the first change of phase within it.
  void end_at_event(const State& from, const Step& step, State& to, StepReport& report);

  dynamics::Dynamics& dynamics_;
  std::unique_ptr<ContactEvents> events_;  ///< null unless the method follows phases of contacts
  std::string choice_;
};

/// The contacts that a method can treat in addition to elastic stops.
enum class ContactSupport {
  elastic_stops,   ///< no others
  without_memory,  ///< rings, planes, dissipation, regularised friction
  without_rigid,   ///< and friction with a stick spring
  all              ///< and rigid stick
};

/// A registered method: names, parameters and factory. `time_step` and `end_time` are read for it
/// by the framework.
///
///     {.name = "my_method", .summary = "...", .parameters = {...}, .order = 2.0, .fixed_step = true, .make = ...}
struct IntegratorType {
  std::string name{};
  std::vector<std::string> aliases{};
  std::string summary{};
  std::vector<config::Parameter> parameters{};
  /// Order of convergence of x and v with equal steps of smooth motion; 0: not stated, or no such
  /// order.
  double order = 0.0;
  /// The largest h omega at which undamped oscillation stays bounded; infinite for unconditionally stable methods.
  double stability_limit = std::numeric_limits<double>::infinity();
  /// The largest h c/m at which a mass with only a dashpot c comes to rest; infinite for
  /// unconditionally stable methods.
  double damping_limit = std::numeric_limits<double>::infinity();
  /// True if time_step alone sets the accuracy; comparisons then vary it.
  bool fixed_step = false;
  /// True if the method finds its first step itself, so that time_step may be absent.
  bool finds_first_step = false;
  /// False if a method has memory outside the State. A run continued from a checkpoint would then
  /// differ from the unbroken one in the last bits, so checkpoints are refused.
  bool restarts_exactly = true;
  ContactSupport contacts = ContactSupport::elastic_stops;
  std::function<std::unique_ptr<Integrator>(const config::Parameters&, dynamics::Dynamics&)> make{};
  /// Reports values that are each allowed but not in combination. May be empty.
  std::function<void(const config::Parameters&, config::Diagnostics&)> check{};
};

}  // namespace butee::time
