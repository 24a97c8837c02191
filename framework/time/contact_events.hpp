#pragma once

#include <vector>

#include "butee/time/contact_search.hpp"
#include "butee/time/contact_switches.hpp"

namespace butee::time {

/// The phases of contacts from step to step.
///
/// Within a step every contact keeps the phase that it has at the start. A step in which a phase
/// ends is cut there (ContactSearch), so that every step is smooth. State::contact holds the phases,
/// kEntries numbers for each contact; the last one tells which switching function ended the step (0:
/// none).
class BUTEE_EXPORT ContactEvents {
 public:
  static constexpr Index kEntries = dynamics::Obstacles::kStateSize + 1;

  /// `dynamics` must have obstacles and outlive this object. `velocity_uncertainty`: see Traits.
  ContactEvents(dynamics::Dynamics& dynamics, double velocity_uncertainty);

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

  /// The search for changes within a step.
  ContactSearch& search() { return search_; }
  /// Marks in `to` the contact whose phase ends with the step.
  void mark(const ContactSearch::Event& event, State& to);

 private:
  /// Lets rigid contacts slip whose friction force exceeds what they can hold.
  void release_overloaded(State& state);
  bool sticks_rigidly(Index contact) const {
    return obstacles_.group_of(contact).friction.rule == model::Friction::Rule::rigid &&
           obstacles_.phase(contact).slip == dynamics::ContactPhase::Slip::stick;
  }
  void enter(Index contact, const dynamics::ContactPhase& next, State& state);

  dynamics::Dynamics& dynamics_;
  dynamics::Obstacles& obstacles_;
  ContactSwitches switches_;
  ContactSearch search_;
  ContactSwitches::Sample now_, work_;
  std::vector<double> stick_rates_;  ///< of every contact, 1/s2; empty if there is no stick spring
};

/// The memory of the contacts of a state, Obstacles::kMemorySize numbers for each contact. A run
/// with other parameter values or another start time can start from it. Empty if no phases are
/// followed.
BUTEE_EXPORT Vector contact_memory(dynamics::Dynamics& dynamics, const State& state);

}  // namespace butee::time
