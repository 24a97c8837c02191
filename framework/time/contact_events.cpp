#include "butee/time/contact_events.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/core/error.hpp"

namespace butee::time {
namespace {

using dynamics::ContactPhase;
using dynamics::Obstacles;

constexpr double kAhead = ContactSearch::kAhead;
/// A switching function is at its end if it is this small relative to its change until the first
/// sample, or if it ends within the precision of located changes.
constexpr double kAtEnd = 1e-6;
/// The largest number of changes of phase at one instant; more are not physical.
constexpr int kMostAtOnce = 50;
/// A stick spring whose tension is within this part of the sum of both limits of one of them is near it; steps are then
/// at most this phase angle of the bodies on the spring, rad (both chosen: the tension leaves a limit by the square of
/// the angle).
constexpr double kNearLimit = 1e-3, kPartOfStick = 0.2;

/// The stiffness of the contact's stick spring over the mass of the bodies, 1/s2, at most; 0 without one.
double stick_rate(const Obstacles& obstacles, Index contact, const Vector& mass) {
  const model::Friction& friction = obstacles.group_of(contact).friction;
  if (friction.rule != model::Friction::Rule::spring) return 0.0;
  double compliance = 0.0;
  for (const auto& side : {obstacles.ends_of(contact).a, obstacles.ends_of(contact).b})
    for (const Index dof : side)
      if (dof >= 0) compliance += 1.0 / mass[dof];
  return friction.stick_stiffness * compliance;
}

/// The release of a rigid stick whose force exceeds its limit by the fraction `overload`. Where several exceed theirs
/// at an instant, only the one with the largest is released: without it the others may hold.
struct Release {
  Index contact;
  ContactPhase to;
  double overload;
};

/// The overload of a rigid stick, from its switching functions: the last two are limit -+ force.
double overload(std::span<const Obstacles::Switch> switches) {
  const double one = switches[switches.size() - 2].value, other = switches.back().value, limit = 0.5 * (one + other);
  return limit > 0.0 ? -std::min(one, other) / limit : std::numeric_limits<double>::infinity();
}

}  // namespace

ContactEvents::ContactEvents(dynamics::Dynamics& dynamics, double velocity_uncertainty)
    : dynamics_(dynamics),
      obstacles_(*dynamics.obstacles()),
      switches_(dynamics, velocity_uncertainty),
      search_(dynamics, switches_),
      now_(switches_.room()),
      work_(switches_.room()) {
  const Vector mass = dynamics.system().mass.diagonal();
  for (Index i = 0; i < obstacles_.size(); ++i) stick_rates_.push_back(stick_rate(obstacles_, i, mass));
  if (std::all_of(stick_rates_.begin(), stick_rates_.end(), [](double rate) { return rate == 0.0; }))
    stick_rates_.clear();
}

void ContactEvents::start(State& state, ConstVectorRef memory) {
  constexpr Index kSize = Obstacles::kMemorySize;
  require(memory.size() == 0 || memory.size() == kSize * obstacles_.size(), "the memory of every contact");
  state.contact = Vector::Zero(kEntries * obstacles_.size());
  follow(state);
  for (Index i = 0; i < obstacles_.size(); ++i)
    enter(i,
          memory.size() == 0 ? obstacles_.phase_at(i, state.t, state.x, state.v)
                             : obstacles_.phase_after(i, memory.segment<kSize>(kSize * i), state.t, state.x, state.v),
          state);
  dynamics_.acceleration(state.t, state.x, state.v, state.a);
  release_overloaded(state);
}

void ContactEvents::release_overloaded(State& state) {
  switches_.measure(state);
  for (Index round = 0; round < kMostAtOnce + obstacles_.size(); ++round) {
    switches_.take(state, now_);
    std::optional<Release> worst;
    for (const Index i : std::vector<Index>(switches_.sticks())) {
      const auto found = switches_.of(i, now_);
      const auto over = std::find_if(found.begin(), found.end(), [](const Obstacles::Switch& one) {
        return one.value < 0.0 && one.to.slip != ContactPhase::Slip::stick;
      });
      if (over == found.end()) continue;
      if (const double by = overload(found); !worst || by > worst->overload) worst = {i, over->to, by};
    }
    if (!worst) return;
    enter(worst->contact, worst->to, state);
    dynamics_.acceleration(state.t, state.x, state.v, state.a);
  }
}

double ContactEvents::longest_step(const State& state) {
  double longest = std::numeric_limits<double>::infinity();
  if (stick_rates_.empty()) return longest;
  follow(state);
  switches_.measure(state);
  switches_.take(state, now_);
  for (Index i = 0; i < obstacles_.size(); ++i) {
    const double rate = stick_rates_[static_cast<std::size_t>(i)];
    if (rate == 0.0 || obstacles_.phase(i).slip != ContactPhase::Slip::stick) continue;
    // The distances of the tension from both limits are the last two switching functions.
    const auto found = switches_.of(i, now_);
    if (found.size() < 2) continue;
    const double one = found[found.size() - 2].value, other = found.back().value;
    if (std::min(one, other) < kNearLimit * (one + other)) longest = std::min(longest, kPartOfStick / std::sqrt(rate));
  }
  return longest;
}

void ContactEvents::follow(const State& state) {
  Vector phases(Obstacles::kStateSize * obstacles_.size());
  for (Index i = 0; i < obstacles_.size(); ++i)
    phases.segment<Obstacles::kStateSize>(Obstacles::kStateSize * i) =
        state.contact.segment<Obstacles::kStateSize>(kEntries * i);
  obstacles_.follow(phases);
}

void ContactEvents::enter(Index contact, const ContactPhase& next, State& state) {
  obstacles_.set_phase(contact, next);
  state.contact.segment<kEntries>(kEntries * contact) << static_cast<double>(next.normal),
      static_cast<double>(next.slip), next.anchor, next.angle, 0.0;
}

void ContactEvents::settle(State& state, double h, double precision) {
  const double at_end = std::max(kAtEnd, precision / kAhead);
  follow(state);
  switches_.measure(state);
  bool changed = false;
  std::array<Obstacles::Switch, Obstacles::kMostSwitches> present;
  const auto change = [&](Index i, ContactPhase next) {
    const ContactPhase before = obstacles_.phase(i);
    if (next.touches() && !before.touches()) {
      const auto normal = next.normal;
      obstacles_.set_phase(i, next);
      next = obstacles_.phase_at(i, state.t, state.x, state.v);
      next.normal = normal;
    }
    enter(i, next, state);
    if (next.slip == ContactPhase::Slip::stick) dynamics_.stop_sliding(state.t, state.v);
    changed = true;
  };
  for (Index round = 0; round < kMostAtOnce + obstacles_.size(); ++round) {
    bool again = false;
    std::optional<Release> worst;
    if (changed) dynamics_.acceleration(state.t, state.x, state.v, state.a);
    switches_.take(state, now_);
    switches_.look_ahead(state, kAhead * h, work_);
    for (Index i = 0; i < obstacles_.size(); ++i) {
      double& mark = state.contact[kEntries * i + kEntries - 1];
      if (mark == 0.0 && obstacles_.phase(i).normal == ContactPhase::Normal::apart && obstacles_.is_apart(i, work_.x))
        continue;
      const auto found = switches_.of(i, now_);
      const std::size_t count = found.size();
      std::copy(found.begin(), found.end(), present.begin());
      std::optional<std::size_t> over;
      const bool is_marked = mark > 0.0 && static_cast<std::size_t>(mark) <= count;
      double by = 0.0;
      if (is_marked) {
        over = static_cast<std::size_t>(mark) - 1;
      } else {
        const auto ahead = switches_.of(i, work_);
        for (std::size_t k = 0; k < count && !over; ++k)
          if (ahead[k].value < 0.0 && present[k].value <= at_end * -ahead[k].value) over = k;
        if (over && sticks_rigidly(i)) by = overload(ahead);
      }
      mark = 0.0;
      if (!over) continue;
      if (const ContactPhase& next = present[*over].to;
          !is_marked && sticks_rigidly(i) && next.touches() && next.slip != ContactPhase::Slip::stick) {
        if (!worst || by > worst->overload) worst = {i, next, by};
        continue;
      }
      change(i, present[*over].to);
      again = true;
    }
    if (!again && worst) {
      change(worst->contact, worst->to);
      again = true;
    }
    if (!again) break;
  }
  if (changed) dynamics_.acceleration(state.t, state.x, state.v, state.a);
  for (Index i = 0; i < obstacles_.size(); ++i)
    if (const ContactPhase next = obstacles_.rebased(i, obstacles_.phase(i), state.x); next != obstacles_.phase(i))
      enter(i, next, state);
}

void ContactEvents::mark(const ContactSearch::Event& event, State& to) {
  to.contact[kEntries * event.contact + kEntries - 1] = static_cast<double>(event.which + 1);
}

Vector contact_memory(dynamics::Dynamics& dynamics, const State& state) {
  if (dynamics.obstacles() == nullptr || state.contact.size() == 0) return {};
  constexpr Index kSize = Obstacles::kMemorySize;
  const Obstacles& obstacles = *dynamics.obstacles();
  Vector memory(kSize * obstacles.size());
  for (Index i = 0; i < obstacles.size(); ++i) {
    const auto entry = state.contact.segment<ContactEvents::kEntries>(ContactEvents::kEntries * i);
    const ContactPhase phase{static_cast<ContactPhase::Normal>(static_cast<int>(entry[0])),
                             static_cast<ContactPhase::Slip>(static_cast<int>(entry[1])), entry[2], entry[3]};
    memory.segment<kSize>(kSize * i) = obstacles.memory(i, phase, state.t, state.x, state.v);
  }
  return memory;
}

}  // namespace butee::time
