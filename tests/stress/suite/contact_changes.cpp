#include "contact_changes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace butee::stress {
namespace {

/// Number of sample points in a piece of `exact`, which spans two or three radians of its highest frequency.
constexpr int kPoints = 6;

/// The start and the ends of the pieces of a step.
std::vector<double> ends_of(const time::AcceptedStep& step) {
  std::vector<double> ends = {step.from.t};
  const auto breakpoints = step.motion.breakpoints();
  ends.insert(ends.end(), breakpoints.begin(), breakpoints.end());
  ends.push_back(step.to.t);
  return ends;
}

double sum_of_ends(const std::vector<Index>& ends, ConstVectorRef values) {
  double sum = 0.0;
  for (const Index dof : ends) sum += values[dof];
  return sum;
}

}  // namespace

CourseWatch::CourseWatch(dynamics::Dynamics& dynamics)
    : contact_(dynamics.stops()), obstacles_(dynamics.obstacles()), w_(contact_.size()), penetration_(contact_.size()) {
  const Vector of_stops = contact_.closed_stiffness();
  const Index stops = contact_.size(), obstacles = obstacles_ != nullptr ? obstacles_->size() : 0;
  ends_.resize(static_cast<std::size_t>(stops + obstacles));
  stiffness_.resize(stops + obstacles);
  for (Index i = 0; i < stops + obstacles; ++i) {
    std::vector<Index> ends = {i < stops ? contact_.dof_a(i) : -1, i < stops ? contact_.dof_b(i) : -1};
    if (i >= stops) {
      const auto& of = obstacles_->ends_of(i - stops);
      ends = {of.a[0], of.a[1], of.b[0], of.b[1]};
    }
    for (const Index dof : ends)
      if (dof >= 0) ends_[static_cast<std::size_t>(i)].push_back(dof);
    stiffness_[i] = i < stops ? of_stops[i] : obstacles_->closed_stiffness(i - stops);
  }
  now_.resize(ends_.size());
  sides_.resize(ends_.size());
  closings_.assign(ends_.size(), -1);
}

void CourseWatch::find_sides(double t, ConstVectorRef x, ConstVectorRef v) {
  contact_.displacement(x, w_);
  contact_.penetration(w_, penetration_);
  for (Index i = 0; i < w_.size(); ++i)
    now_[static_cast<std::size_t>(i)] = penetration_[i] > 0.0 ? std::copysign(1.0, w_[i]) : 0.0;
  for (auto i = static_cast<std::size_t>(w_.size()); i < now_.size(); ++i)
    now_[i] = obstacles_->forces(static_cast<Index>(i) - w_.size(), t, x, v).penetration > 0.0 ? 1.0 : 0.0;
}

void CourseWatch::start(const time::State& state) {
  largest_x = state.x.cwiseAbs();
  largest_v = state.v.cwiseAbs();
  all_.clear();
  for (Index i = 0; i < state.x.size(); ++i) all_.push_back(i);
  find_sides(state.t, state.x, state.v);
  sides_ = now_;
}

void CourseWatch::step(const time::AcceptedStep& step) {
  if (watches == Watches::nothing) return;
  const std::vector<double> ends = ends_of(step);
  const Index size = step.to.x.size();
  for (std::size_t piece = 0; piece + 1 < ends.size(); ++piece) {
    times_.clear();
    for (int k = 1; k <= kPoints; ++k)
      times_.push_back(std::lerp(ends[piece], ends[piece + 1], static_cast<double>(k) / kPoints));
    x_.resize(all_.size() * times_.size());
    v_.resize(x_.size());
    step.motion.interpolate(times_, all_, {x_, v_, {}});
    const Eigen::Map<const Eigen::MatrixXd> x(x_.data(), size, kPoints), v(v_.data(), size, kPoints);
    largest_x = largest_x.cwiseMax(x.cwiseAbs().rowwise().maxCoeff());
    largest_v = largest_v.cwiseMax(v.cwiseAbs().rowwise().maxCoeff());
    if (watches != Watches::all) continue;
    find_sides(times_[kPoints / 2 - 1], x.col(kPoints / 2 - 1), v.col(kPoints / 2 - 1));
    for (std::size_t i = 0; i < now_.size(); ++i)
      if (now_[i] != sides_[i]) change(step, ends[piece], static_cast<Index>(i), now_[i]);
  }
}

std::pair<double, double> CourseWatch::motion_of(const time::AcceptedStep& step, double t, Index contact) {
  if (contact >= w_.size()) {
    const Index obstacle = contact - w_.size();
    Vector x = Vector::Zero(static_cast<Index>(all_.size())), v = x, a = x;
    step.motion.interpolate(t, all_, {{x.data(), all_.size()}, {v.data(), all_.size()}, {a.data(), all_.size()}});
    const Eigen::Vector2d place = obstacles_->gather(obstacle, x).head<2>();
    const auto& shape = obstacles_->group_of(obstacle).shape;
    if (shape == nullptr) return {0.0, 0.0};
    const Eigen::Vector2d normal = shape->at(place).normal;
    return {normal.dot(obstacles_->gather(obstacle, v).head<2>()),
            normal.dot(obstacles_->gather(obstacle, a).head<2>())};
  }
  const double signs[] = {1.0, -1.0};
  const Index dofs[] = {contact_.dof_a(contact), contact_.dof_b(contact)};
  double speed = 0.0, acceleration = 0.0;
  for (int end = 0; end < 2; ++end) {
    if (dofs[end] < 0) continue;
    double v = 0.0, a = 0.0;
    step.motion.interpolate(t, {&dofs[end], 1}, {{}, {&v, 1}, {&a, 1}});
    speed += signs[end] * v;
    acceleration += signs[end] * a;
  }
  return {speed, acceleration};
}

void CourseWatch::change(const time::AcceptedStep& step, double t, Index contact, double side) {
  const auto place = static_cast<std::size_t>(contact);
  ContactChange found{t, contact, side != 0.0, 0.0, 0.0, std::numeric_limits<double>::infinity()};
  const auto [speed, acceleration] = motion_of(step, t, contact);
  found.speed = std::abs(speed);
  found.acceleration = std::abs(acceleration);
  if (sides_[place] != 0.0 && closings_[place] >= 0) changes[static_cast<std::size_t>(closings_[place])].until = t;
  closings_[place] = found.closes ? static_cast<std::ptrdiff_t>(changes.size()) : -1;
  changes.push_back(found);
  sides_[place] = side;
}

void VelocityBand::watch(double begin, double end, Index size) {
  begin_ = begin;
  end_ = end;
  is_active = true;
  low = Vector::Constant(size, std::numeric_limits<double>::infinity());
  high = -low;
  all_.clear();
  for (Index i = 0; i < size; ++i) all_.push_back(i);
  v_.resize(all_.size());
}

void VelocityBand::step(const time::AcceptedStep& step) {
  if (!is_active || step.to.t < begin_ || step.from.t > end_) return;
  const std::vector<double> ends = ends_of(step);
  for (std::size_t piece = 0; piece + 1 < ends.size(); ++piece) {
    const double from = std::max(begin_, ends[piece]), to = std::min(end_, ends[piece + 1]);
    if (to < from) continue;
    looks += kPoints + 1;
    for (int k = 0; k <= kPoints; ++k) {
      step.motion.interpolate(std::lerp(from, to, static_cast<double>(k) / kPoints), all_, {{}, v_, {}});
      const Eigen::Map<const Vector> v(v_.data(), static_cast<Index>(v_.size()));
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
  }
}

double time_margin(const std::vector<ContactChange>& changes, const std::vector<std::vector<Index>>& ends,
                   const Trajectory& scales, Index row, double t, double parts) {
  double margin = 0.0;
  for (const ContactChange& change : changes) {
    const auto& dofs = ends[static_cast<std::size_t>(change.contact)];
    const double size = sum_of_ends(dofs, scales.x.col(row)), way = parts * size;
    // At rest at the contact boundary the speed bound is infinite; the bound from the acceleration then
    // applies.
    const double reach = std::min(way / change.speed, 2.0 * std::sqrt(2.0 * way / change.acceleration));
    if (!(reach > margin) || !std::isfinite(reach)) continue;
    const double own_time = size / sum_of_ends(dofs, scales.v.col(row));
    const double end = change.closes && change.until - change.t < own_time ? change.until : change.t;
    if (t >= change.t - reach && t <= end + reach) margin = reach;
  }
  return margin;
}

}  // namespace butee::stress
