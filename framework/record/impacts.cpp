#include "butee/record/impacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "butee/record/csv_writer.hpp"

namespace butee::record {
namespace {

/// Halvings of an interval that take it below the spacing of doubles.
constexpr int kBisections = 60;
/// Of an impact as bytes, its name empty.
constexpr std::size_t kLeastBytes = 53;

void put(const Impact& impact, ByteWriter& to) {
  to.put(impact.t_in);
  to.put(impact.t_out.has_value());
  to.put(impact.t_out.value_or(0.0));
  for (const double number : {impact.peak_force, impact.impulse, impact.impact_speed}) to.put(number);
}

void take(Impact& impact, ByteReader& from) {
  from.take(impact.t_in);
  const bool is_over = from.take<bool>();
  const auto t_out = from.take<double>();
  impact.t_out = is_over ? std::optional(t_out) : std::nullopt;
  for (double* number : {&impact.peak_force, &impact.impulse, &impact.impact_speed}) from.take(*number);
}

}  // namespace

ImpactRecorder::ImpactRecorder(solve::Dynamics& dynamics) : dynamics_(dynamics) {
  const solve::Contact& contact = dynamics.contact();
  const auto node = [&](Index dof) {
    const std::string name = dynamics.dof_name(dof);
    return name.substr(name.rfind(' ') + 1);
  };
  for (Index i = 0; i < contact.size(); ++i)
    for (const double side : {1.0, -1.0}) {
      const model::Sides sides = contact.sides_of(i);
      if (sides == (side > 0.0 ? model::Sides::negative : model::Sides::positive)) continue;
      Watch watch{i, side, contact.gap_of(i), {}, false, {}};
      std::string name;
      for (const Index dof : {contact.dof_a(i), contact.dof_b(i)}) {
        watch.dofs.push_back(dof);
        if (dof < 0) continue;
        if (!name.empty()) name += '|';
        name += node(dof);
      }
      watch.current.node = name;
      watch.current.side = side > 0.0 ? 1 : -1;
      watches_.push_back(std::move(watch));
    }
}

ImpactRecorder::Motion ImpactRecorder::motion(const Watch& watch, const time::State& state) const {
  Motion motion{-watch.gap, 0.0};
  double sign = watch.side;
  for (const Index dof : watch.dofs) {
    if (dof >= 0) {
      motion.penetration += sign * state.x[dof];
      motion.speed += sign * state.v[dof];
    }
    sign = -sign;
  }
  return motion;
}

ImpactRecorder::Motion ImpactRecorder::motion(const Watch& watch, const time::AcceptedStep& step, double t) const {
  Motion motion{-watch.gap, 0.0};
  double sign = watch.side;
  for (const Index dof : watch.dofs) {
    if (dof >= 0) {
      std::array<double, 1> x{}, v{};
      step.integrator.interpolate(step.from, step.to, t, std::array{dof}, {x, v, {}});
      motion.penetration += sign * x[0];
      motion.speed += sign * v[0];
    }
    sign = -sign;
  }
  return motion;
}

double ImpactRecorder::force(const Watch& watch, double penetration) {
  return std::abs(dynamics_.contact().force_of(watch.stop, watch.side * (penetration + watch.gap)));
}

void ImpactRecorder::start(const time::State& state) {
  done_.clear();
  for (Watch& watch : watches_) {
    const Motion at = motion(watch, state);
    watch.closed = at.penetration > 0.0;
    watch.current.t_in = state.t;
    watch.current.impact_speed = at.speed;
    watch.current.peak_force = watch.closed ? force(watch, at.penetration) : 0.0;
    watch.current.impulse = 0.0;
  }
}

void ImpactRecorder::step(const time::AcceptedStep& step) {
  const double half = 0.5 * (step.from.t + step.to.t);
  for (Watch& watch : watches_) {
    follow(watch, step, step.from.t, half);
    follow(watch, step, half, step.to.t);
  }
}

double ImpactRecorder::crossing(const Watch& watch, const time::AcceptedStep& step, double begin, double end) const {
  const bool closed_at_begin = watch.closed;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (begin + end);
    if (middle <= begin || middle >= end) break;
    ((motion(watch, step, middle).penetration > 0.0) == closed_at_begin ? begin : end) = middle;
  }
  return end;
}

void ImpactRecorder::follow(Watch& watch, const time::AcceptedStep& step, double begin, double end) {
  const bool closed_at_end = (end == step.to.t ? motion(watch, step.to) : motion(watch, step, end)).penetration > 0.0;
  if (closed_at_end == watch.closed) {
    if (watch.closed) accumulate(watch, step, begin, end);
    return;
  }
  const double t = crossing(watch, step, begin, end);
  if (watch.closed) {
    accumulate(watch, step, begin, t);
    watch.current.t_out = t;
    done_.push_back(watch.current);
  } else {
    watch.current.t_in = t;
    watch.current.t_out.reset();
    watch.current.impact_speed = motion(watch, step, t).speed;
    watch.current.peak_force = watch.current.impulse = 0.0;
    accumulate(watch, step, t, end);
  }
  watch.closed = closed_at_end;
}

void ImpactRecorder::accumulate(Watch& watch, const time::AcceptedStep& step, double begin, double end) {
  if (end <= begin) return;
  const Motion first = motion(watch, step, begin), last = motion(watch, step, end);
  const Motion middle = motion(watch, step, 0.5 * (begin + end));
  const double f0 = force(watch, first.penetration), f1 = force(watch, middle.penetration),
               f2 = force(watch, last.penetration);
  watch.current.impulse += (end - begin) / 6.0 * (f0 + 4.0 * f1 + f2);
  watch.current.peak_force = std::max({watch.current.peak_force, f0, f1, f2});
  if (first.speed > 0.0 && last.speed < 0.0) {
    double low = begin, high = end;
    for (int i = 0; i < kBisections; ++i) {
      const double half = 0.5 * (low + high);
      (motion(watch, step, half).speed > 0.0 ? low : high) = half;
    }
    watch.current.peak_force = std::max(watch.current.peak_force, force(watch, motion(watch, step, low).penetration));
  }
}

void ImpactRecorder::save(ByteWriter& to) const {
  for (const Watch& watch : watches_) {
    to.put(watch.closed);
    put(watch.current, to);
  }
  to.put(std::uint64_t{done_.size()});
  for (const Impact& impact : done_) {
    to.put(impact.node);
    to.put(impact.side);
    put(impact, to);
  }
}

void ImpactRecorder::restore(ByteReader& from) {
  for (Watch& watch : watches_) {
    from.take(watch.closed);
    take(watch.current, from);
  }
  done_.assign(from.count(kLeastBytes), {});
  for (Impact& impact : done_) {
    from.take(impact.node);
    from.take(impact.side);
    take(impact, from);
  }
}

std::vector<Impact> ImpactRecorder::impacts() const {
  std::vector<Impact> all = done_;
  for (const Watch& watch : watches_)
    if (watch.closed) all.push_back(watch.current);
  std::stable_sort(all.begin(), all.end(), [](const Impact& a, const Impact& b) { return a.t_in < b.t_in; });
  return all;
}

std::vector<std::string> ImpactRecorder::columns() {
  return {"node", "side", "t_in", "t_out", "peak_force", "impulse", "impact_speed"};
}

std::string ImpactRecorder::csv_line(const Impact& impact) {
  std::string line = impact.node + "," + std::to_string(impact.side) + ",";
  append_number(line, impact.t_in);
  line += ',';
  if (impact.t_out) append_number(line, *impact.t_out);
  for (const double value : {impact.peak_force, impact.impulse, impact.impact_speed}) {
    line += ',';
    append_number(line, value);
  }
  return line;
}

}  // namespace butee::record
