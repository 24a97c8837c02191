#pragma once

#include <array>
#include <optional>
#include <vector>

#include "butee/time/contact_switches.hpp"
#include "butee/time/dip.hpp"

namespace butee::time {

/// Locates the changes of phase of contacts on a method's dense output.
///
/// Within a step every contact keeps the phase that it has at the start. A step in which a phase
/// ends is cut there, so that every step is smooth. State::contact holds the phases, kEntries
/// numbers for each contact; the last one tells which switching function ended the step (0: none).
/// An end is detected if a switching function has the opposite sign at one of kSamples instants
/// within the step, or at the lowest point of a dip between three of them. Shorter phases are not
/// detected.
class BUTEE_EXPORT ContactEvents {
 public:
  static constexpr Index kEntries = dynamics::Obstacles::kStateSize + 1;

  /// `dynamics` must have obstacles and outlive this object.
  explicit ContactEvents(dynamics::Dynamics& dynamics);

  /// Writes the phases that follow from the motion at this instant into state.contact; a follows.
  /// `memory`, if not empty, is that of an earlier run of the same contacts (contact_memory); stick
  /// and slip continue from it.
  void start(State& state, ConstVectorRef memory);
  /// Switches contacts whose phase is over to the next phase, and all changes that follow at the
  /// same instant or within `precision` h after it; a follows. `h` is the length of the coming step,
  /// s, and `precision` h the uncertainty of a located change.
  void settle(State& state, double h, double precision);
  /// Sets the contacts to the phases of a state.
  void follow(const State& state);
  /// The longest step from a settled state that follows the tension of every stick spring that is near its limit: a
  /// part of the period of the bodies on that spring, s. A longer step may end beyond the limit by its error, and the
  /// contact would slip. Infinite if there is none.
  double longest_step(const State& state);

  /// A change of phase.
  struct Event {
    double t;  ///< s
    Index contact;
    std::size_t which;  ///< index of the switching function of the contact
  };
  /// The first change within a step, on the dense output of a method.
  std::optional<Event> first(const DenseOutput& motion);
  /// How far the end of a step lies beyond an event, by the value and the slope of the switching function there.
  struct Miss {
    double t;    ///< s
    bool falls;  ///< true if the function falls: a change of phase begins there, none ends
  };
  /// The miss of the end `to` of a step of length h.
  Miss miss(const Event& event, double h, const State& to);
  /// Whether the phase of the event is over at the end of a step, but for rounding.
  bool is_over(const Event& event, const State& at);
  /// Marks in `to` the contact whose phase ends with the step.
  void mark(const Event& event, State& to);

 private:
  static constexpr int kSamples = 8;

  /// Appends the DOFs of a contact.
  void add_dofs(Index contact, std::vector<Index>& dofs) const;
  /// False if the motion over the step cannot bring the contact to a change of phase.
  bool is_near(Index contact, const DenseOutput& motion) const;
  /// Lets rigid contacts slip whose friction force exceeds what they can hold.
  void release_overloaded(State& state);
  bool sticks_rigidly(Index contact) const {
    return obstacles_.group_of(contact).friction.rule == model::Friction::Rule::rigid &&
           obstacles_.phase(contact).slip == dynamics::ContactPhase::Slip::stick;
  }
  void enter(Index contact, const dynamics::ContactPhase& next, State& state);
  /// Narrows [begin, event.t] to the root of the event's switching function; `value` is its value
  /// at event.t.
  Event refine(const DenseOutput& motion, Event event, double begin, double value);

  dynamics::Dynamics& dynamics_;
  dynamics::Obstacles& obstacles_;
  ContactSwitches switches_;
  ContactSwitches::Sample now_, work_;
  /// Values of every switching function of the watched contacts at the last two instants.
  std::vector<std::array<std::array<Look, 2>, dynamics::Obstacles::kMostSwitches>> looks_;
  std::vector<Index> watched_, watched_dofs_, own_dofs_;
  std::vector<double> stick_rates_;  ///< of every contact, 1/s2; empty if there is no stick spring
};

/// The memory of the contacts of a state, Obstacles::kMemorySize numbers for each contact. A run
/// with other parameter values or another start time can start from it. Empty if no phases are
/// followed.
BUTEE_EXPORT Vector contact_memory(dynamics::Dynamics& dynamics, const State& state);

}  // namespace butee::time
