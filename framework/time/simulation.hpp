#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "butee/core/bytes.hpp"
#include "butee/time/diagnosis.hpp"
#include "butee/time/growth_watch.hpp"
#include "butee/time/integrator.hpp"

namespace butee::time {

/// An accepted step, as passed to observers.
struct AcceptedStep {
  const State& from;
  const State& to;
  double h;  ///< s
  DenseOutput motion;
  double event_error;  ///< s, largest error of a change of contact located at the end
};

/// Watches a run.
class BUTEE_EXPORT Observer {
 public:
  virtual ~Observer() = default;
  virtual void start(const State& state) { (void)state; }
  virtual void step(const AcceptedStep& step) = 0;
  /// Called after the last step, also of a failed run.
  virtual void finish() {}
  /// The next instant after `t` at which the observer needs the motion, s; infinite if it needs
  /// none in particular.
  virtual double next_instant(double t) const {
    (void)t;
    return std::numeric_limits<double>::infinity();
  }
  /// True if the observer needs the whole state after every internal step of a method.
  virtual bool watches_every_step() const { return false; }
  /// Seconds spent on files so far; not counted as integration.
  virtual double file_seconds() const { return 0.0; }
  /// Writes all it remembers of the steps so far; restore() reads it, also in another process,
  /// instead of start(). An observer that has memory and does not write it makes
  /// Simulation::restore() incomplete.
  virtual void save(ByteWriter& to) const { (void)to; }
  virtual void restore(ByteReader& from) { (void)from; }
};

struct SimulationOptions {
  double time_step = 0.0;  ///< s; first step of an adaptive method, 0 if the method finds it
  double end_time = 0.0;   ///< s
  MethodLimits limits;     ///< stability limits of the method, for messages about failures
};

/// The result of a run.
struct RunReport {
  bool completed = false;
  std::string message;  ///< why it failed
  double t_end = 0.0;   ///< s, time reached
  std::int64_t steps = 0, rejected = 0, newton_iterations = 0, newton_failures = 0;
  double wall_seconds = 0.0;          ///< time of the steps alone, without files
  std::vector<std::string> warnings;  ///< of a completed run
};

/// A run between two steps: everything that the rest of it depends on, to go back to or to continue
/// from elsewhere. A value: it refers to nothing and may outlive the simulation. As bytes:
/// snapshot.hpp.
struct Snapshot {
  State state;
  double next_h = 0.0;        ///< s
  double origin = 0.0;        ///< s, from which steps of fixed length are counted
  std::int64_t accepted = 0;  ///< number of steps of fixed length
  RunReport report;
  bool over = false;
  std::vector<std::byte> watchers;  ///< memory of the growth watch, then of the observers in the order of add()
};

/// Advances a system from its initial state to end_time, with fixed steps or as the method's
/// controller decides.
///
/// A step with values that are not finite, or in which Newton failed, is never accepted: an
/// adaptive method tries half the step, a fixed step fails with a diagnosis. The number of
/// consecutive rejections and the smallest step are bounded, so that a run always ends. Motion that
/// grows beyond the energy supplied by the loads also ends a run (GrowthWatch).
class BUTEE_EXPORT Simulation {
 public:
  /// Both must outlive this object; the integrator must use this dynamics.
  Simulation(dynamics::Dynamics& dynamics, Integrator& integrator, SimulationOptions options);

  /// `observer` must outlive the simulation. To be called before the first step.
  void add(Observer& observer);

  /// Sets the initial motion in place of the system's own; `contact_memory` is the result of
  /// contact_memory() for that motion, or empty. To be called before start().
  void begin_with(ConstVectorRef x, ConstVectorRef v, ConstVectorRef contact_memory);

  /// Steps that a method chooses become no longer than this, s, so that observers that write much in each leave room
  /// for interruptions. To be called before start().
  void limit_steps(double longest) { longest_ = longest; }

  /// Completes the initial state (a_0, and the method's memory). Every other function calls it if
  /// necessary.
  void start();

  /// True while observers are called with a step, whose end is not yet the state.
  bool is_observed() const { return is_observed_; }
  /// Takes steps until end_time or a failure.
  const RunReport& run();
  /// The same; asks after every accepted step except the last whether to continue. A stopped run is
  /// neither completed nor failed, and another run() continues it.
  const RunReport& run(const std::function<bool()>& goes_on);

  /// Moves the end of the run, forwards or back, but not before the present instant; a completed
  /// run continues. Fixed steps are counted from the present instant: the last one before a new end
  /// may be shorter. Not allowed after a failure, until set_motion(), loads_changed() or restore()
  /// is called.
  void set_end_time(double end_time);

  /// Sets displacements and velocities at the present instant, for example from another solver. A
  /// failed run may continue from them.
  void set_motion(ConstVectorRef x, ConstVectorRef v);

  /// To be called after time functions of the system's loads have changed. `jump`: their values at
  /// the present instant have changed too, so that the method restarts from the same motion. A
  /// failed run may continue.
  void loads_changed(bool jump);

  /// Takes one accepted step; false if the run is over, completed or failed (see report()).
  bool advance();

  /// The present state of the run. Taking a snapshot changes nothing. After restore() the run
  /// repeats bit for bit what followed the snapshot, for methods that allow it
  /// (IntegratorType::restarts_exactly). take_snapshot() reuses the memory of an earlier snapshot.
  Snapshot snapshot();
  void take_snapshot(Snapshot& into);
  /// Goes to a snapshot of this simulation, or of one with an equal system and method and the same
  /// options and observers; it then replaces start(). Counters of the Dynamics are not reset, since
  /// they count work done.
  void restore(const Snapshot& snapshot);

  const State& state() const { return state_; }
  const RunReport& report() const { return report_; }

 private:
  /// Restarts the method at the present state, also after a failure.
  void start_anew();
  Step propose() const;
  double next_landing() const;
  /// The first one after t; infinite if there is none.
  double next_discontinuity(double t) const;
  void accept(const Step& step, const StepReport& result);
  /// True if the steps of an adaptive method have become so short that the run would never end.
  bool has_stalled();
  void fail(const Step& step, const std::string& reason);

  dynamics::Dynamics& dynamics_;
  Integrator& integrator_;
  const Traits traits_;               ///< of the integrator
  const StepController* controller_;  ///< of the integrator; null for fixed steps
  SimulationOptions options_;
  std::vector<Observer*> observers_;
  State state_, next_;
  Vector contact_memory_;  ///< initial memory of the contacts
  GrowthWatch growth_;
  RunReport report_;
  std::vector<double> discontinuities_;  ///< instants of load discontinuities, at which steps end
  double next_h_;
  double origin_ = 0.0;                                       ///< s, from which steps of fixed length are counted
  std::int64_t accepted_ = 0;                                 ///< number of steps of fixed length
  double stall_t_ = 0.0;                                      ///< s, time of the last check of progress
  double longest_ = std::numeric_limits<double>::infinity();  ///< s, of a step that the method chooses
  bool watched_ = false;                                      ///< an observer watches every step
  bool started_ = false, over_ = false;
  bool is_observed_ = false;  ///< observers are called with a step
};

}  // namespace butee::time
