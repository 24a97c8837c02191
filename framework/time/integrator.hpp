#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "butee/config/parameters.hpp"
#include "butee/dynamics/dynamics.hpp"
#include "butee/time/dense_output.hpp"
#include "butee/time/state.hpp"
#include "butee/time/step_controller.hpp"

namespace butee::time {

class ContactEvents;

/// Properties of a method for a system, constant from its construction on.
struct Traits {
  /// The method handles the instants itself at which a load or its derivative jumps. Steps of all
  /// other adaptive methods end there, since a load shorter than a step could be missed.
  bool handles_load_discontinuities = false;
  /// Steps of the method may end at changes of phase of contacts (ContactEvents), between which it
  /// integrates. Otherwise the contact forces depend on the motion at each instant alone, and laws
  /// with memory are refused.
  bool follows_contact_phases = false;
  /// Steps should end at the output instants that observers ask for, since the method can take any
  /// step length.
  bool lands_on_outputs = false;
  /// A stop that starts in the middle of its gap has no force in the first stage, as in the published
  /// method and programs that follow it. Otherwise it leaves the middle at once (leave_middle()).
  bool starts_as_published = false;
  /// The largest error of a located change of phase, as a fraction of the step, for methods that
  /// follow phases.
  double event_precision = 1e-12;
  /// The largest stable h omega, if the parameters make it smaller than the limit that the
  /// IntegratorType declares.
  double stability_limit = std::numeric_limits<double>::infinity();
  /// The uncertainty of velocities within a step, as a fraction of the speed of a contact, for methods that follow
  /// phases. A rate of penetration below it does not tell approach from rebound.
  double velocity_uncertainty = 0.0;
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
  explicit Integrator(dynamics::Dynamics& dynamics);
  virtual ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Completes a state with given t, x and v: a = M^-1 (F + F_c - C v - K x), and the method's
  /// memory. Stops that start in the middle of their gap leave it (leave_middle()), unless
  /// the method starts as published.
  void start(State& state);
  /// The same; the contacts continue from the result of contact_memory() of another run, which may
  /// be empty.
  void start(State& state, ConstVectorRef contact_memory);

  /// At a discontinuity of the loads or of their slopes: stops that nothing has moved so far leave the middle of their
  /// gap. `jumps`: the acceleration of the state is that before a jump of the loads.
  void pass_discontinuity(State& state, bool jumps);

  /// Takes the phases of contacts from a state that was completed before.
  void go_back(const State& state);

  /// Switches contacts whose phase is over at a state to the next phase; the acceleration follows.
  /// `h` is the length of the coming step. A state must be settled before a step from it.
  void settle(State& state, double h);
  /// The longest step that follows the contacts of a settled state, s.
  double longest_step(const State& state);

  /// Computes the state at the end of the step. `to` is meaningful only if the report's status is
  /// ok.
  StepReport step(const State& from, const Step& step, State& to);

  /// The motion within an accepted step; valid as long as both states and this object.
  DenseOutput dense_output(const State& from, const State& to) { return {interpolant(), from, to}; }

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

  virtual Traits traits() const { return {}; }

 protected:
  dynamics::Dynamics& dynamics() const { return dynamics_; }

 private:
  virtual void do_start(State& state);
  /// The acceleration of a state has increased by `jump`; the method's memory of it follows.
  virtual void do_jump(State& state, ConstVectorRef jump);
  virtual StepReport do_step(const State& from, const Step& step, State& to) = 0;
  /// The method's dense output; default: cubic interpolation.
  virtual Interpolant& interpolant() { return cubic_; }

  /// Computes the acceleration and the phases of contacts at a state.
  void complete(State& state, ConstVectorRef contact_memory);
  /// Cuts an accepted step at the first change of phase within it.
  void end_at_event(const State& from, const Step& step, State& to, StepReport& report);

  dynamics::Dynamics& dynamics_;
  Interpolant cubic_;
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
