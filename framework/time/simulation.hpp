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

/// An accepted step, as observers see it.
struct AcceptedStep {
  const State& from;
  const State& to;
  double h;  ///< s
  const Integrator& integrator;
};

/// Watches a run.
class BUTEE_EXPORT Observer {
 public:
  virtual ~Observer() = default;
  virtual void start(const State& state) { (void)state; }
  virtual void step(const AcceptedStep& step) = 0;
  /// After the last step, of a failed run too.
  virtual void finish() {}
  /// The next instant after `t` at which it wants to know the motion, s; infinite where any will do.
  virtual double next_instant(double t) const {
    (void)t;
    return std::numeric_limits<double>::infinity();
  }
  /// True where it has to see the whole state after every step that a method takes of its own.
  virtual bool watches_every_step() const { return false; }
  /// Seconds spent on files so far, which do not count as integration.
  virtual double file_seconds() const { return 0.0; }
  /// Writes what it remembers of the steps so far; restore() takes it up again, in another process too, instead of
  /// start(). One that remembers something and does not write it makes Simulation::restore() incomplete.
  virtual void save(ByteWriter& to) const { (void)to; }
  virtual void restore(ByteReader& from) { (void)from; }
};

struct SimulationOptions {
  double time_step = 0.0;  ///< s; the first step of an adaptive method, 0 where it finds that itself
  double end_time = 0.0;   ///< s
  MethodLimits limits;     ///< of the method, for what is said where a run goes wrong
};

/// What a run came to.
struct RunReport {
  bool completed = false;
  std::string message;  ///< why it failed
  double t_end = 0.0;   ///< s, where it stopped
  std::int64_t steps = 0, rejected = 0, newton_iterations = 0, newton_failures = 0;
  double wall_seconds = 0.0;          ///< the steps alone, without files
  std::vector<std::string> warnings;  ///< of a run that was completed all the same
};

/// A run between two steps: everything that the rest of it depends on, to go back to or to go on from elsewhere.
/// A value: it refers to nothing and may outlive the simulation. As bytes: snapshot.hpp.
struct Snapshot {
  State state;
  double next_h = 0.0;        ///< s
  double origin = 0.0;        ///< s, from which steps of a fixed length are counted
  std::int64_t accepted = 0;  ///< steps of a fixed length
  RunReport report;
  bool over = false;
  std::vector<std::byte> watchers;  ///< what the watch for growth remembers, then the observers, in the order of add()
};

/// Takes a system from its initial state to end_time, with fixed steps or as the method's controller decides.
///
/// A step that is not finite, or in which Newton failed, is never accepted: an adaptive method tries half of it, a
/// fixed one fails with a diagnosis. Both rejections in a row and the smallest step are bounded, so that a run always
/// ends. Motion that grows beyond what the loads can have put into it ends a run as well (GrowthWatch).
class BUTEE_EXPORT Simulation {
 public:
  /// `dynamics` and `integrator` must outlive it; the integrator is one of this dynamics.
  Simulation(dynamics::Dynamics& dynamics, Integrator& integrator, SimulationOptions options);

  /// `observer` must outlive the simulation. Before the first step.
  void add(Observer& observer);

  /// Begins with this motion in place of the system's initial one; `contact_memory` is what contact_memory() gave of
  /// it, or empty. Before start().
  void begin_with(ConstVectorRef x, ConstVectorRef v, ConstVectorRef contact_memory);

  /// Completes the initial state (a_0, and what the method needs for it). Every other function does so where it is
  /// still due.
  void start();

  /// Takes steps until end_time or a failure.
  const RunReport& run();
  /// The same, asking after every accepted step but the last whether to go on. A run that was stopped is neither
  /// completed nor failed, and another run() goes on with it.
  const RunReport& run(const std::function<bool()>& goes_on);

  /// Moves the end of the run, forwards or back, but not before the present instant; a run that was completed goes on.
  /// Fixed steps count from there: the last one before a new end may be shorter. Not for a run that has failed, before
  /// set_motion(), loads_changed() or restore().
  void set_end_time(double end_time);

  /// Takes other displacements and velocities at the present instant, as another solver wants them. A run that has
  /// failed may go on from them.
  void set_motion(ConstVectorRef x, ConstVectorRef v);

  /// Says that functions of time of the system's loads are others from now on. `jump`: their values at the present
  /// instant as well, so that the method starts anew from the same motion. A run that has failed may go on with them.
  void loads_changed(bool jump);

  /// Takes one accepted step; false where the run is over, completed or failed (see report()).
  bool advance();

  /// The run as it stands. Taking one changes nothing; what follows restore() is bit for bit what followed the
  /// snapshot, of methods that allow it (IntegratorType::restarts_exactly). take_snapshot() uses the memory of an
  /// earlier one.
  Snapshot snapshot();
  void take_snapshot(Snapshot& into);
  /// Goes to a snapshot of this simulation, or of another one of an equal system and method with the same options and
  /// observers; then it stands for start(). Counters of the Dynamics go on, since they count what was done.
  void restore(const Snapshot& snapshot);

  const State& state() const { return state_; }
  const RunReport& report() const { return report_; }

 private:
  /// Starts the method at the present state, after a failure too.
  void start_anew();
  Step propose() const;
  double next_landing() const;
  double next_discontinuity() const;
  void accept(const Step& step, const StepReport& result);
  /// True where the steps of an adaptive method have become so short that it would never end.
  bool has_stalled();
  void fail(const Step& step, const std::string& reason);

  dynamics::Dynamics& dynamics_;
  Integrator& integrator_;
  const StepController* controller_;  ///< the integrator's; null for fixed steps
  SimulationOptions options_;
  std::vector<Observer*> observers_;
  State state_, next_;
  Vector contact_memory_;  ///< to begin with
  GrowthWatch growth_;
  RunReport report_;
  std::vector<double> discontinuities_;  ///< of the loads, at which steps end
  double next_h_;
  double origin_ = 0.0;        ///< s, from which steps of a fixed length are counted
  std::int64_t accepted_ = 0;  ///< steps of a fixed length
  double stall_t_ = 0.0;       ///< s, at the last look at its progress
  bool watched_ = false;       ///< an observer watches every step
  bool started_ = false, over_ = false;
};

}  // namespace butee::time
