#pragma once

#include <array>
#include <optional>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/dip.hpp"
#include "butee/time/state.hpp"

namespace butee::time {

class Integrator;

/// Locates the changes of phase of contacts on a method's dense output.
///
/// Within a step every contact keeps the phase that it has at the start; a step in which one ends is cut there, so that
/// every step is smooth. The phases are in State::contact: kEntries numbers a contact, of which the last tells which
/// switching function ended the step (0: none). An end is seen where a switching function has another sign at one of
/// kSamples instants within the step, or at the lowest point of a dip between three of them; shorter visits pass
/// unseen.
class BUTEE_EXPORT ContactEvents {
 public:
  static constexpr Index kEntries = dynamics::Obstacles::kStateSize + 1;

  /// `dynamics` must outlive it and has obstacles.
  explicit ContactEvents(dynamics::Dynamics& dynamics);

  /// The phases that the instant tells, into state.contact; a follows. `memory`, where it is not empty, is that of an
  /// earlier run of the same contacts (contact_memory), from which stick and slip go on.
  void start(State& state, ConstVectorRef memory);
  /// Takes contacts at the end of their phase to the next, and all that follows at the same instant; a follows.
  /// `h` is the length of the step to come, s.
  void settle(State& state, double h);
  /// Has the contacts keep the phases of a state.
  void follow(const State& state);

  /// A change of phase.
  struct Event {
    double t;  ///< s
    Index contact;
    std::size_t which;  ///< of its switching functions
  };
  /// The first within a step, on the dense output of a method.
  std::optional<Event> first(const Integrator& integrator, const State& from, const State& to);
  /// How far the end of a step lies beyond the event, s, by the slope of its switching function there.
  double miss(const Integrator& integrator, const Event& event, const State& from, const State& to);
  /// Notes in `to` the contacts whose phase ends with the step, that of the event among them.
  void mark(const Event& event, State& to);

 private:
  static constexpr int kSamples = 8;

  struct Sample {
    double t = 0.0;
    Vector x, v;
    Vector held;  ///< of the rigid sticks
  };
  /// The motion of `dofs`, or of all where contacts stick rigidly, at `t`.
  void sample(const Integrator& integrator, const State& from, const State& to, double t,
              const std::vector<Index>& dofs, Sample& at);
  /// The DOFs of a contact, into the vector.
  void add_dofs(Index contact, std::vector<Index>& dofs) const;
  static void place(Sample& at, double t, const Vector& x, const Vector& v);
  void hold(Sample& at);
  std::size_t switches(Index contact, const Sample& at);
  double value(Index contact, std::size_t which, const Sample& at);
  /// False where the motion over the step cannot bring the contact to a switch.
  bool is_near(Index contact, const State& from, const State& to) const;
  void enter(Index contact, const dynamics::ContactPhase& next, State& state);
  /// Narrows [begin, event.t] down to the root of the event's switching function, whose value at event.t is `value`.
  Event refine(const Integrator& integrator, const State& from, const State& to, Event event, double begin,
               double value);

  dynamics::Dynamics& dynamics_;
  dynamics::Obstacles& obstacles_;
  std::vector<Index> all_;
  std::vector<double> values_x_, values_v_;
  std::array<dynamics::Obstacles::Switch, dynamics::Obstacles::kMostSwitches> found_{};
  Sample now_, work_;
  /// Every switching function of those watched at the last two instants.
  std::vector<std::array<std::array<Look, 2>, dynamics::Obstacles::kMostSwitches>> looks_;
  std::vector<Index> sticks_, watched_, watched_dofs_, own_dofs_;
};

/// The memory of the contacts of a state, from which a run with other values or at another time can start:
/// Obstacles::kMemorySize numbers each; empty where no phases are followed.
BUTEE_EXPORT Vector contact_memory(dynamics::Dynamics& dynamics, const State& state);

}  // namespace butee::time
