#include "butee/record/impacts.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/quadrature.hpp"
#include "butee/record/bisection.hpp"
#include "butee/record/csv_writer.hpp"

namespace butee::record {
namespace {

/// The bytes of an impact without its names, as put_impact() writes them.
constexpr std::size_t kImpactBytes = 77;
/// A body that is away for less than this fraction of the contacts before and after has not left the stop: it would
/// reach this fraction of its penetration, which is below the rounding error of motion between stops.
constexpr double kNotAway = 1e-12;

}  // namespace

void put_impact(const Impact& impact, ByteWriter& to) {
  to.put(std::uint64_t{impact.contact});
  to.put(impact.side);
  to.put(impact.t_in);
  to.put(impact.t_out.has_value());
  to.put(impact.t_out.value_or(0.0));
  for (const double number : {impact.peak_force, impact.impulse, impact.impact_speed, impact.tangential_impulse,
                              impact.slip, impact.dissipated})
    to.put(number);
}

void take_impact(Impact& impact, ByteReader& from) {
  impact.contact = static_cast<std::size_t>(from.take<std::uint64_t>());
  from.take(impact.side);
  from.take(impact.t_in);
  const bool is_over = from.take<bool>();
  const auto t_out = from.take<double>();
  impact.t_out = is_over ? std::optional(t_out) : std::nullopt;
  for (double* number : {&impact.peak_force, &impact.impulse, &impact.impact_speed, &impact.tangential_impulse,
                         &impact.slip, &impact.dissipated})
    from.take(*number);
}

void ImpactList::append(std::vector<Impact>& all, const Impact& impact, double end) {
  // An impact that begins outwards is the rest of the one before, whose force vanished for a moment by rounding.
  const bool is_rest = impact.impact_speed <= 0.0;
  for (auto last = all.rbegin(); last != all.rend(); ++last) {
    if (!last->t_out) continue;
    const double away = impact.t_in - *last->t_out;
    if (!is_rest && away > kNotAway * end) break;
    if (last->contact != impact.contact) continue;
    if (away > (is_rest ? 1.0 : kNotAway) * std::max(*last->t_out - last->t_in, end - impact.t_in)) break;
    last->t_out = impact.t_out;
    last->peak_force = std::max(last->peak_force, impact.peak_force);
    last->impulse += impact.impulse;
    last->tangential_impulse += impact.tangential_impulse;
    last->slip += impact.slip;
    last->dissipated += impact.dissipated;
    return;
  }
  all.push_back(impact);
}

void ImpactList::add_dissipated(std::size_t contact, double energy) {
  const auto last =
      std::find_if(ended_.rbegin(), ended_.rend(), [&](const Impact& impact) { return impact.contact == contact; });
  if (last != ended_.rend()) last->dissipated += energy;
}

std::vector<Impact> ImpactList::with(const std::vector<Impact>& lasting) const {
  std::vector<Impact> all = ended_;
  for (const Impact& impact : lasting) append(all, impact, std::max(impact.t_in, reached_));
  std::stable_sort(all.begin(), all.end(), [](const Impact& a, const Impact& b) { return a.t_in < b.t_in; });
  return all;
}

void ImpactList::save(ByteWriter& to) const {
  to.put(reached_);
  to.put(std::uint64_t{ended_.size()});
  for (const Impact& impact : ended_) {
    to.put(impact.node);
    put_impact(impact, to);
  }
}

void ImpactList::restore(ByteReader& from) {
  from.take(reached_);
  ended_.assign(from.count(kImpactBytes), {});
  for (Impact& impact : ended_) {
    from.take(impact.node);
    take_impact(impact, from);
  }
}

ImpactRecorder::ImpactRecorder(dynamics::Dynamics& dynamics) : dynamics_(dynamics) {
  const dynamics::ElasticStops& contact = dynamics.stops();
  const auto names_of = [&](Index dof) {  // of "theta of string:3"
    const std::string name = dynamics.dof_name(dof);
    return std::pair(name.substr(name.rfind(' ') + 1), name.substr(0, name.find(' ')));
  };
  for (Index i = 0; i < contact.size(); ++i)
    for (const double side : {1.0, -1.0}) {
      if (!contact.play_of(i).has_side(side)) continue;
      Watch watch{i, side, contact.play_of(i).gap, tracks_.add(contact.dof_a(i), contact.dof_b(i), 1)};
      std::string name;
      for (const Index dof : {contact.dof_a(i), contact.dof_b(i)}) {
        if (dof < 0) continue;
        const auto [node, kind] = names_of(dof);
        if (!name.empty()) name += '|';
        name += node;
        watch.current.dof = kind;
      }
      watch.current.contact = watches_.size();
      watch.current.node = name;
      watch.current.side = side > 0.0 ? 1 : -1;
      watches_.push_back(std::move(watch));
    }
}

double ImpactRecorder::force(const Watch& watch, double displacement) {
  return std::abs(dynamics_.stops().force_of(watch.stop, displacement));
}

void ImpactRecorder::start(const time::State& state) {
  ended_.clear();
  for (Watch& watch : watches_) {
    const Point at = tracks_.at(state, watch.track);
    watch.closed = watch.penetration(at) > 0.0;
    watch.current.t_in = state.t;
    watch.current.impact_speed = std::max(0.0, watch.speed(at));
    watch.current.peak_force = watch.closed ? force(watch, at.of[0]) : 0.0;
    watch.current.impulse = 0.0;
  }
}

void ImpactRecorder::step(const time::AcceptedStep& step) {
  ended_.reach(step.to.t);
  tracks_.visit(step, [&] {
    for (Watch& watch : watches_)
      follow(watch, tracks_.path(step, watch.track), tracks_.from(watch.track), tracks_.to(watch.track));
  });
}

void ImpactRecorder::follow(Watch& watch, const StepPath& path, const Point& from, const Point& to) {
  if (!watch.closed) {
    const auto [least, greatest] = path.enclose(0, from, to);
    if (!((watch.side > 0.0 ? greatest : -least) > watch.gap)) return;
  }
  Range range;
  range.take(from.t, from.of[0]);
  path.extend(0, from, to, range);
  const auto [first, second] = std::minmax(range.t_least, range.t_greatest);
  Point last = from;
  for (const double t : {first, second}) {
    if (!(t > last.t && t < to.t)) continue;
    const Point next = path.at(t);
    follow_part(watch, path, last, next);
    last = next;
  }
  follow_part(watch, path, last, to);
}

void ImpactRecorder::follow_part(Watch& watch, const StepPath& path, const Point& from, const Point& to) {
  const bool closed_at_end = watch.penetration(to) > 0.0;
  if (closed_at_end == watch.closed) {
    if (watch.closed) accumulate(watch, path, from, to);
    return;
  }
  const Point change = crossing(watch, path, from.t, to.t);
  if (watch.closed) {
    accumulate(watch, path, from, change);
    watch.current.t_out = change.t;
    ended_.add(watch.current);
  } else {
    watch.current.t_in = change.t;
    watch.current.t_out.reset();
    watch.current.impact_speed = watch.speed(change);
    watch.current.peak_force = watch.current.impulse = 0.0;
    accumulate(watch, path, change, to);
  }
  watch.closed = closed_at_end;
}

Point ImpactRecorder::crossing(const Watch& watch, const StepPath& path, double begin, double end) const {
  return path.at(bisect(begin, end, [&](double t) { return (watch.penetration(path.at(t)) > 0.0) == watch.closed; }));
}

void ImpactRecorder::accumulate(Watch& watch, const StepPath& path, const Point& from, const Point& to) {
  if (!(to.t > from.t)) return;
  for (const Point* end : {&from, &to})
    if (watch.penetration(*end) > 0.0)
      watch.current.peak_force = std::max(watch.current.peak_force, force(watch, end->of[0]));
  for (const auto& [t, weight] : gauss_points(from.t, to.t))
    watch.current.impulse += weight * force(watch, path.displacement(from, to, t));
}

void ImpactRecorder::save(ByteWriter& to) const {
  for (const Watch& watch : watches_) {
    to.put(watch.closed);
    put_impact(watch.current, to);
  }
  ended_.save(to);
}

void ImpactRecorder::restore(ByteReader& from) {
  for (Watch& watch : watches_) {
    from.take(watch.closed);
    take_impact(watch.current, from);
  }
  ended_.restore(from);
}

std::vector<Impact> ImpactRecorder::impacts() const {
  std::vector<Impact> lasting;
  for (const Watch& watch : watches_)
    if (watch.closed) lasting.push_back(watch.current);
  std::vector<Impact> all = ended_.with(lasting);
  for (Impact& impact : all) impact.dof = watches_[impact.contact].current.dof;  // those of a checkpoint lack it
  return all;
}

std::vector<std::string> ImpactRecorder::columns() {
  return {"node", "side",       "t_in", "t_out", "peak_force", "impulse", "impact_speed", "tangential_impulse",
          "slip", "dissipated", "dof"};
}

std::string ImpactRecorder::csv_line(const Impact& impact) {
  std::string line = impact.node + "," + std::to_string(impact.side) + ",";
  append_number(line, impact.t_in);
  line += ',';
  if (impact.t_out) append_number(line, *impact.t_out);
  for (const double value : {impact.peak_force, impact.impulse, impact.impact_speed, impact.tangential_impulse,
                             impact.slip, impact.dissipated}) {
    line += ',';
    append_number(line, value);
  }
  return line + "," + impact.dof;
}

}  // namespace butee::record
