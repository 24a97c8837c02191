#include "butee/time/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace butee::time {
namespace {

using dynamics::ContactPhase;
using dynamics::Obstacles;

constexpr int kBisections = 60;
/// Instants are located to this part of t, some units of rounding.
constexpr double kFinest = 1e-15;
/// The part of a step over which a difference gives the rate of a switching function.
constexpr double kDifference = 1e-3;
/// A function below zero that has not fallen by more than this factor between two samples counts as rising: it may
/// rise by less than rounding.
constexpr double kNoFall = 1.001;
/// Relative decrease towards the lowest sample of a dip that rounding does not cause.
constexpr double kRounding = 1e-9;

/// Number of samples that resolve the loads over a step, since rigid sticks do not move while the
/// loads change.
int samples_of_loads(const model::System& system, double h) {
  constexpr double kPerTurn = 32.0, kMost = 1e5;
  double turns = 0.0;
  for (const model::FreeLoad& load : system.loads)
    if (const auto harmonic = load.in_time->harmonic())
      turns = std::max(turns, std::abs(harmonic->angular_frequency) * h / (2.0 * std::numbers::pi));
  return static_cast<int>(std::min(kPerTurn * turns, kMost));
}

}  // namespace

ContactSearch::ContactSearch(dynamics::Dynamics& dynamics, ContactSwitches& switches)
    : dynamics_(dynamics),
      obstacles_(*dynamics.obstacles()),
      switches_(switches),
      now_(switches.room()),
      work_(switches.room()) {}

void ContactSearch::add_dofs(Index contact, std::vector<Index>& dofs) const {
  for (const auto& side : {obstacles_.ends_of(contact).a, obstacles_.ends_of(contact).b})
    for (const Index dof : side)
      if (dof >= 0) dofs.push_back(dof);
}

bool ContactSearch::is_near(Index contact, const DenseOutput& motion) const {
  const State &from = motion.from(), &to = motion.to();
  const ContactPhase phase = obstacles_.phase(contact);
  if (phase.normal != ContactPhase::Normal::apart || obstacles_.group_of(contact).shape == nullptr) return true;
  return obstacles_.may_touch(contact, obstacles_.motion(contact, from.x, from.v),
                              obstacles_.motion(contact, to.x, to.v), to.t - from.t);
}

std::optional<ContactSearch::Event> ContactSearch::first(const DenseOutput& motion) {
  switches_.update_sticks();
  watched_.clear();
  watched_dofs_.clear();
  for (Index i = 0; i < obstacles_.size(); ++i)
    if (is_near(i, motion)) {
      watched_.push_back(i);
      add_dofs(i, watched_dofs_);
    }
  if (watched_.empty()) return std::nullopt;
  // One DOF may belong to several contacts.
  std::sort(watched_dofs_.begin(), watched_dofs_.end());
  watched_dofs_.erase(std::unique(watched_dofs_.begin(), watched_dofs_.end()), watched_dofs_.end());
  const State &from = motion.from(), &to = motion.to();
  const double h = to.t - from.t;
  switches_.measure(to);
  // Methods with breakpoints within a step take longer steps.
  const int looks = kSamples * motion.trace_parts();
  const int samples = switches_.sticks().empty() ? looks : std::max(looks, samples_of_loads(dynamics_.system(), h));
  double last = from.t;
  // A dip between samples is detected by a lowest value.
  functions_.assign(watched_.size(), {});
  std::array<Obstacles::Switch, Obstacles::kMostSwitches> present;
  // Two samples close to each end detect a dip between the end and its neighbour.
  const double ahead = std::min(kAhead, 0.5 / samples) * h;
  for (int k = -1; k <= samples + 1; ++k) {
    const double t = k == -1            ? from.t
                     : k == 0           ? from.t + ahead
                     : k == samples     ? to.t - ahead
                     : k == samples + 1 ? to.t
                                        : from.t + h * k / samples;
    if (k == -1)
      switches_.take(from, now_);
    else
      switches_.interpolate(motion, t, watched_dofs_, now_);
    std::optional<Event> earliest;
    const auto take = [&earliest](const Event& event) {
      if (!earliest || event.t < earliest->t) earliest = event;
    };
    for (std::size_t w = 0; w < watched_.size(); ++w) {
      const Index i = watched_[w];
      const auto found = switches_.of(i, now_);
      const std::size_t count = found.size();
      std::copy(found.begin(), found.end(), present.begin());
      for (std::size_t which = 0; which < count; ++which) {
        auto& [first, second, is_returning] = functions_[w][which];
        const Look now{t, present[which].value};
        is_returning = now.value < 0.0 && (k == -1 || (is_returning && now.value >= kNoFall * second.value));
        if (is_returning) {
          // no change
        } else if (now.value < 0.0) {
          take(refine(motion, {t, i, which}, last, now.value));
        } else if (k >= 1 && second.value >= 0.0 && second.value <= now.value &&
                   first.value - second.value > kRounding * second.value) {
          const auto at = [&](double instant) {
            own_dofs_.clear();
            add_dofs(i, own_dofs_);
            switches_.interpolate(motion, instant, own_dofs_, work_);
            return switches_.value(i, which, work_);
          };
          if (const auto dip = below_zero({first, second, now}, at))
            take(refine(motion, {dip->first.t, i, which}, dip->second.t, dip->first.value));
        }
        first = second;
        second = now;
      }
    }
    if (earliest) return earliest;
    last = t;
  }
  return std::nullopt;
}

ContactSearch::Event ContactSearch::refine(const DenseOutput& motion, Event event, double begin, double value) {
  own_dofs_.clear();
  add_dofs(event.contact, own_dofs_);
  const auto at = [&](double t) {
    switches_.interpolate(motion, t, own_dofs_, work_);
    return switches_.value(event.contact, event.which, work_);
  };
  // The Illinois variant of the false position method, which keeps a bracket; bisection if it
  // converges too slowly.
  const double precision = kFinest * std::abs(motion.to().t);
  double end = event.t, at_end = value, at_begin = at(begin);
  if (at_begin < 0.0) at_begin = 0.0;
  double width = end - begin;
  int side = 0;
  for (int i = 0; i < kBisections && end - begin > precision; ++i) {
    double middle = i % 3 == 2 && end - begin > 0.5 * width ? 0.5 * (begin + end)
                                                            : end - at_end * (end - begin) / (at_end - at_begin);
    if (i % 3 == 2) width = end - begin;
    if (!(middle > begin && middle < end)) middle = 0.5 * (begin + end);
    if (middle <= begin || middle >= end) break;
    const double found = at(middle);
    if (found < 0.0) {
      end = middle;
      at_end = found;
      if (side < 0) at_begin *= 0.5;
      side = -1;
    } else {
      begin = middle;
      at_begin = found;
      if (side > 0) at_end *= 0.5;
      side = 1;
      if (found == 0.0) {
        end = middle;
        break;
      }
    }
  }
  event.t = end;
  return event;
}

ContactSearch::Miss ContactSearch::miss(const Event& event, double h, const State& to) {
  const double ahead = kDifference * h;
  switches_.take(to, now_);
  const double at_end = switches_.value(event.contact, event.which, now_);
  switches_.look_ahead(to, -ahead, work_);
  const double before = switches_.value(event.contact, event.which, work_);
  const double slope = (before - at_end) / ahead;
  return {slope != 0.0 ? -at_end / slope : 0.0, slope > 0.0};
}

bool ContactSearch::is_over(const Event& event, const State& at) {
  switches_.take(at, now_);
  return switches_.value(event.contact, event.which, now_) <= 0.0;
}

}  // namespace butee::time
