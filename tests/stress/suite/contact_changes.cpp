#include "contact_changes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace butee::stress {
namespace {

/// Points that a piece of `exact`, two or three radians of its highest frequency, is looked at.
constexpr int kPoints = 6;

/// The ends of the pieces of a step.
std::vector<double> ends_of(const time::AcceptedStep& step) {
  std::vector<double> ends = {step.from.t};
  const auto knots = step.integrator.knots(step.from, step.to);
  ends.insert(ends.end(), knots.begin(), knots.end());
  ends.push_back(step.to.t);
  return ends;
}

double sum_of_ends(const dynamics::Contact& contact, Index stop, ConstVectorRef values) {
  double sum = 0.0;
  for (const Index dof : {contact.dof_a(stop), contact.dof_b(stop)})
    if (dof >= 0) sum += values[dof];
  return sum;
}

}  // namespace

CourseWatch::CourseWatch(const dynamics::Contact& contact)
    : contact_(contact),
      w_(contact.size()),
      penetration_(contact.size()),
      sides_(static_cast<std::size_t>(contact.size())),
      closings_(static_cast<std::size_t>(contact.size()), -1) {}

void CourseWatch::start(const time::State& state) {
  largest_x = state.x.cwiseAbs();
  largest_v = state.v.cwiseAbs();
  all_.clear();
  for (Index i = 0; i < state.x.size(); ++i) all_.push_back(i);
  contact_.displacement(state.x, w_);
  contact_.penetration(w_, penetration_);
  for (Index i = 0; i < w_.size(); ++i)
    sides_[static_cast<std::size_t>(i)] = penetration_[i] > 0.0 ? std::copysign(1.0, w_[i]) : 0.0;
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
    step.integrator.interpolate(step.from, step.to, times_, all_, {x_, v_, {}});
    const Eigen::Map<const Eigen::MatrixXd> x(x_.data(), size, kPoints), v(v_.data(), size, kPoints);
    largest_x = largest_x.cwiseMax(x.cwiseAbs().rowwise().maxCoeff());
    largest_v = largest_v.cwiseMax(v.cwiseAbs().rowwise().maxCoeff());
    if (watches != Watches::all) continue;
    contact_.displacement(x.col(kPoints / 2 - 1), w_);
    contact_.penetration(w_, penetration_);
    for (Index i = 0; i < w_.size(); ++i) {
      const double side = penetration_[i] > 0.0 ? std::copysign(1.0, w_[i]) : 0.0;
      if (side != sides_[static_cast<std::size_t>(i)]) change(step, ends[piece], i, side);
    }
  }
}

void CourseWatch::change(const time::AcceptedStep& step, double t, Index stop, double side) {
  const auto place = static_cast<std::size_t>(stop);
  ContactChange found{t, stop, side != 0.0, 0.0, 0.0, std::numeric_limits<double>::infinity()};
  const double signs[] = {1.0, -1.0};
  const Index dofs[] = {contact_.dof_a(stop), contact_.dof_b(stop)};
  double speed = 0.0, acceleration = 0.0;
  for (int end = 0; end < 2; ++end) {
    if (dofs[end] < 0) continue;
    double v = 0.0, a = 0.0;
    step.integrator.interpolate(step.from, step.to, t, {&dofs[end], 1}, {{}, {&v, 1}, {&a, 1}});
    speed += signs[end] * v;
    acceleration += signs[end] * a;
  }
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
    for (int k = 0; k <= kPoints; ++k) {
      step.integrator.interpolate(step.from, step.to, std::lerp(from, to, static_cast<double>(k) / kPoints), all_,
                                  {{}, v_, {}});
      const Eigen::Map<const Vector> v(v_.data(), static_cast<Index>(v_.size()));
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
    }
  }
}

double time_margin(const std::vector<ContactChange>& changes, const dynamics::Contact& contact,
                   const Trajectory& scales, Index row, double t, double parts) {
  double margin = 0.0;
  for (const ContactChange& change : changes) {
    const double size = sum_of_ends(contact, change.stop, scales.x.col(row)), way = parts * size;
    // At rest on the border any time would do; the way that the acceleration takes is the larger of both then.
    const double reach = std::min(way / change.speed, 2.0 * std::sqrt(2.0 * way / change.acceleration));
    if (!(reach > margin) || !std::isfinite(reach)) continue;
    const double own_time = size / sum_of_ends(contact, change.stop, scales.v.col(row));
    const double end = change.closes && change.until - change.t < own_time ? change.until : change.t;
    if (t >= change.t - reach && t <= end + reach) margin = reach;
  }
  return margin;
}

}  // namespace butee::stress
