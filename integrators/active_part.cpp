#include "integrators/active_part.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"

namespace butee::integrators {
namespace {

/// Radius of the first part in edges of the sparsity pattern; for a chain of beams, in elements.
constexpr double kFirstRadius = 32.0;
/// Ratio of the radii of successive parts, and radius of the inner region over that of the part.
constexpr double kGrowth = 1.5, kInner = 0.75;
/// Bound of a residual force, as a fraction of tolerance times the force that closes the gap. Open
/// stops with a larger residual force belong to the start set.
constexpr double kNegligibleForce = 0.005;
/// Fraction of the tolerance that the motion in the outer region may reach.
constexpr double kNegligible = 0.1;
/// Number of memory entries before the scales.
const Index kBefore = LocalErrorControl::memory_size(0);

/// The start set: DOFs with loads, initial motion, stops that push at rest, or open stops with a
/// residual force.
std::vector<Index> moving_first(dynamics::Dynamics& dynamics, double tolerance) {
  const model::System& system = dynamics.system();
  Vector moves = system.initial_displacement.cwiseAbs() + system.initial_velocity.cwiseAbs();
  Vector force = Vector::Zero(system.size());
  dynamics.add_contact_force(Vector::Zero(system.size()), force);
  moves += force.cwiseAbs();
  for (const model::FreeLoad& load : system.loads)
    for (const Index dof : load.dofs) moves[dof] = 1.0;
  const dynamics::ElasticStops& contact = dynamics.stops();
  for (Index i = 0; i < contact.size(); ++i) {
    const model::ContactLaw& law = contact.law_of(i);
    if (law.asymptotic_force() <= kNegligibleForce * tolerance * law.closed_stiffness() * contact.play_of(i).gap)
      continue;
    for (const Index dof : {contact.dof_a(i), contact.dof_b(i)})
      if (dof >= 0) moves[dof] = 1.0;
  }
  std::vector<Index> dofs;
  for (Index i = 0; i < moves.size(); ++i)
    if (moves[i] > 0.0) dofs.push_back(i);
  return dofs;
}

/// The distance of each DOF from the start set, in edges of the sparsity pattern; unconnected DOFs
/// are beyond all others.
std::vector<Index> distances_of(dynamics::Dynamics& dynamics, double tolerance) {
  std::vector<Index> distances = model::distances(dynamics.system(), moving_first(dynamics, tolerance));
  const Index last = *std::max_element(distances.begin(), distances.end()) + 1;
  std::replace(distances.begin(), distances.end(), Index{-1}, last);
  return distances;
}

std::vector<Index> within(const std::vector<Index>& distances, double radius) {
  std::vector<Index> dofs;
  for (std::size_t i = 0; i < distances.size(); ++i)
    if (static_cast<double>(distances[i]) <= radius) dofs.push_back(static_cast<Index>(i));
  return dofs;
}

bool is_small(const std::vector<Index>& dofs, Index all) {
  return !dofs.empty() && 2 * static_cast<Index>(dofs.size()) <= all;
}

}  // namespace

bool ActivePart::can_take(dynamics::Dynamics& dynamics, double tolerance) {
  if (dynamics.size() <= LocalErrorControl::kLargest) return false;
  if (dynamics.system().damping.is_modal() || dynamics.obstacles() != nullptr) return false;
  return is_small(within(distances_of(dynamics, tolerance), kFirstRadius), dynamics.size());
}

ActivePart::ActivePart(dynamics::Dynamics& dynamics, const Goal& goal, Make make)
    : Integrator(dynamics),
      goal_{goal.tolerance, goal.run_time, true},
      make_(make),
      distances_(distances_of(dynamics, goal.tolerance)) {
  parts_.push_back(make_part(0));
}

ActivePart::Part& ActivePart::at(std::size_t place) {
  while (parts_.size() <= place) parts_.push_back(make_part(parts_.size()));
  return parts_[place];
}

ActivePart::Part ActivePart::make_part(std::size_t place) const {
  Part part;
  const double radius = kFirstRadius * std::pow(kGrowth, static_cast<double>(place));
  std::vector<Index> dofs = within(distances_, radius);
  if (!is_small(dofs, dynamics().size())) {
    part.method = make_(dynamics(), goal_);
    return part;
  }
  part.places.assign(static_cast<std::size_t>(dynamics().size()), -1);
  for (std::size_t i = 0; i < dofs.size(); ++i) part.places[static_cast<std::size_t>(dofs[i])] = static_cast<Index>(i);
  part.dofs = std::move(dofs);
  part.system = std::make_unique<model::System>(model::part_of(dynamics().system(), part.dofs));
  part.dynamics = std::make_unique<dynamics::Dynamics>(*part.system);
  part.method = make_(*part.dynamics, goal_);
  const auto size = static_cast<Index>(part.dofs.size());
  part.is_outer = part.work = part.outer = Vector::Zero(size);
  for (Index i = 0; i < size; ++i) {
    const Index distance = distances_[static_cast<std::size_t>(part.dofs[static_cast<std::size_t>(i)])];
    if (static_cast<double>(distance) > kInner * radius) part.is_outer[i] = 1.0;
  }
  return part;
}

bool ActivePart::holds(const Part& part, const time::State& state) {
  const auto has_all = [&](const Vector& y) {
    return (y.array() != 0.0).count() == (y(part.dofs).array() != 0.0).count();
  };
  return part.is_whole() || (has_all(state.x) && has_all(state.v));
}

void ActivePart::do_start(time::State& state) {
  std::size_t place = 0;
  while (!holds(at(place), state)) ++place;
  Part& part = at(place);
  if (part.is_whole()) {
    part.method->start(state);
  } else {
    part.from.t = state.t;
    part.from.x = state.x(part.dofs);
    part.from.v = state.v(part.dofs);
    part.dynamics->loads_changed();
    part.dynamics->counters() = {};
    part.method->start(part.from);
    dynamics().counters() = dynamics().counters() + part.dynamics->counters();
    state.memory = Vector::Zero(place_of_part());
    extend_memory(part, part.from.memory, state.memory);
  }
  state.memory.conservativeResize(place_of_part() + 1);
  state.memory[place_of_part()] = static_cast<double>(place);
}

time::StepReport ActivePart::do_step(const time::State& from, const time::Step& step, time::State& to) {
  require(from.memory.size() == place_of_part() + 1, "a state of this method");
  for (int redone = 0;; ++redone) {
    const std::size_t place = static_cast<std::size_t>(from.memory[place_of_part()]) + static_cast<std::size_t>(redone);
    Part& part = at(place);
    time::StepReport report = part.is_whole() ? part.method->step(from, step, to) : step_on(part, from, step, to);
    to.memory[place_of_part()] = static_cast<double>(place);
    output_.accept(part);
    const bool stands = report.status == time::StepStatus::ok && controller()->decide(step.h, report).accept;
    report.inner_rejected += redone;
    if (part.is_whole() || !stands || !has_come_near(part)) return report;
  }
}

time::StepReport ActivePart::step_on(Part& part, const time::State& from, const time::Step& step, time::State& to) {
  part.from.t = from.t;
  part.from.x = from.x(part.dofs);
  part.from.v = from.v(part.dofs);
  part.from.a = from.a(part.dofs);
  restrict_memory(part, from.memory, part.from.memory);
  part.to.memory.resize(part.from.memory.size());
  part.dynamics->loads_changed();  // The part is not notified of changed loads.
  part.dynamics->counters() = {};
  const time::StepReport report = part.method->step(part.from, step, part.to);
  dynamics().counters() = dynamics().counters() + part.dynamics->counters();
  if (report.status != time::StepStatus::ok) return report;
  for (Vector* vector : {&to.x, &to.v, &to.a}) vector->setZero();
  to.t = part.to.t;
  to.x(part.dofs) = part.to.x;
  to.v(part.dofs) = part.to.v;
  to.a(part.dofs) = part.to.a;
  to.memory = from.memory;
  extend_memory(part, part.to.memory, to.memory);
  return report;
}

std::span<const double> ActivePart::Output::breakpoints(const time::State& from, const time::State& to,
                                                        time::Detail detail) {
  if (part_->is_whole()) return part_->method->dense_output(from, to).breakpoints(detail);
  return holds(from, to) ? of_method().breakpoints(detail) : std::span<const double>();
}

void ActivePart::Output::interpolate(const time::State& from, const time::State& to, double t,
                                     std::span<const Index> dofs, time::Interpolated out) {
  if (part_->is_whole()) return part_->method->dense_output(from, to).interpolate(t, dofs, out);
  if (!holds(from, to)) return Interpolant::interpolate(from, to, t, dofs, out);
  dofs_.clear();
  entries_.clear();
  for (std::size_t i = 0; i < dofs.size(); ++i)
    if (const Index place = part_->places[static_cast<std::size_t>(dofs[i])]; place >= 0) {
      dofs_.push_back(place);
      entries_.push_back(i);
    }
  const auto room = [this](std::span<double> wanted, std::vector<double>& values) {
    values.resize(wanted.empty() ? 0 : dofs_.size());
    return std::span(values);
  };
  of_method().interpolate(t, dofs_, {room(out.x, x_), room(out.v, v_), room(out.a, a_)});
  const auto spread = [this](const std::vector<double>& values, std::span<double> wanted) {
    std::ranges::fill(wanted, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) wanted[entries_[i]] = values[i];
  };
  spread(x_, out.x);
  spread(v_, out.v);
  spread(a_, out.a);
}

void ActivePart::restrict_memory(const Part& part, const Vector& whole, Vector& to) {
  const auto size = static_cast<Index>(part.dofs.size()), all = (whole.size() - kBefore) / 2;
  to.resize(LocalErrorControl::memory_size(size));
  to.head(kBefore) = whole.head(kBefore);
  to.segment(kBefore, size) = whole.segment(kBefore, all)(part.dofs);
  to.tail(size) = whole.segment(kBefore + all, all)(part.dofs);
}

void ActivePart::extend_memory(const Part& part, const Vector& from, Vector& whole) {
  const auto size = static_cast<Index>(part.dofs.size()), all = (whole.size() - kBefore) / 2;
  whole.head(kBefore) = from.head(kBefore);
  whole.segment(kBefore, all)(part.dofs) = from.segment(kBefore, size);
  whole.segment(kBefore + all, all)(part.dofs) = from.tail(size);
}

bool ActivePart::has_come_near(Part& part) const {
  const auto norm = [&](const Vector& y) {
    part.outer = y.cwiseProduct(part.is_outer);
    part.dynamics->inertia_force(part.outer, part.work);
    return std::sqrt(std::max(0.0, part.outer.dot(part.work)));
  };
  const double enough = kNegligible * goal_.tolerance;
  return norm(part.to.x) > enough * LocalErrorControl::norm_x(part.to) ||
         norm(part.to.v) > enough * LocalErrorControl::norm_v(part.to);
}

}  // namespace butee::integrators
