#pragma once

#include <array>
#include <optional>
#include <vector>

#include "butee/time/contact_switches.hpp"
#include "butee/time/dip.hpp"

namespace butee::time {

/// Finds the first change of phase of a contact within a step, on a method's dense output.
///
/// A change is detected if a switching function has the opposite sign at one of kSamples instants
/// within the step, or at the lowest point of a dip between three of them. Shorter phases are not
/// detected. A function that is below zero at the start and rises leaves the change at which the last
/// step ended, which is located to a precision only.
class ContactSearch {
 public:
  /// The first instant sampled in a step, as a fraction of it.
  static constexpr double kAhead = 1e-4;

  /// `dynamics` must have obstacles; it and `switches` must outlive this object.
  ContactSearch(dynamics::Dynamics& dynamics, ContactSwitches& switches);

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

 private:
  static constexpr int kSamples = 8;

  /// Appends the DOFs of a contact.
  void add_dofs(Index contact, std::vector<Index>& dofs) const;
  /// False if the motion over the step cannot bring the contact to a change of phase.
  bool is_near(Index contact, const DenseOutput& motion) const;
  /// Narrows [begin, event.t] to the root of the event's switching function; `value` is its value
  /// at event.t.
  Event refine(const DenseOutput& motion, Event event, double begin, double value);

  dynamics::Dynamics& dynamics_;
  dynamics::Obstacles& obstacles_;
  ContactSwitches& switches_;
  ContactSwitches::Sample now_, work_;
  /// A switching function of a watched contact.
  struct Watched {
    Look before, last;          ///< at the last two instants
    bool is_returning = false;  ///< below zero since the start of the step, and rising
  };
  std::vector<std::array<Watched, dynamics::Obstacles::kMostSwitches>> functions_;
  std::vector<Index> watched_, watched_dofs_, own_dofs_;
};

}  // namespace butee::time
