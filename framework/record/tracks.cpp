#include "butee/record/tracks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace butee::record {
namespace {

constexpr std::size_t kFixed = static_cast<std::size_t>(-1);

}  // namespace

std::size_t Tracks::add(Index a, Index b, std::size_t order) {
  constexpr std::array kDetails = {time::Detail::displacements, time::Detail::velocities, time::Detail::accelerations};
  detail_ = std::max(detail_, kDetails[std::min(order, kDetails.size() - 1)]);
  const auto found = std::find(pairs_.begin(), pairs_.end(), std::pair{a, b});
  if (found != pairs_.end()) return static_cast<std::size_t>(found - pairs_.begin());
  const auto place = [&](Index dof) {
    if (dof < 0) return kFixed;
    const auto known = std::find(dofs_.begin(), dofs_.end(), dof);
    if (known != dofs_.end()) return static_cast<std::size_t>(known - dofs_.begin());
    dofs_.push_back(dof);
    return dofs_.size() - 1;
  };
  pairs_.emplace_back(a, b);
  const std::size_t place_a = place(a), place_b = place(b);
  places_.emplace_back(place_a, place_b);
  borders_.emplace_back();
  from_.emplace_back();
  to_.emplace_back();
  return pairs_.size() - 1;
}

void Tracks::resolve(std::size_t track, const model::FreePlay& play) {
  for (const double border : {play.lower(), play.upper()})
    if (std::isfinite(border)) borders_[track].push_back(border);
}

void Tracks::sample(const time::AcceptedStep& step, std::span<const double> breakpoints) {
  const std::size_t room = breakpoints.size() * dofs_.size();
  for (std::vector<double>* values : {&x_, &v_, &a_})
    if (values->size() < room) values->resize(room);
  step.motion.interpolate(breakpoints, dofs_, {x_, v_, a_});
}

void Tracks::load(std::size_t breakpoint, double t) {
  const std::size_t begin = breakpoint * dofs_.size();
  for (std::size_t i = 0; i < size(); ++i) {
    Point& point = to_[i];
    point = {t, {0.0, 0.0, 0.0}};
    const auto [a, b] = places_[i];
    if (a != kFixed) point.of = {x_[begin + a], v_[begin + a], a_[begin + a]};
    if (b != kFixed) point.of = {point.of[0] - x_[begin + b], point.of[1] - v_[begin + b], point.of[2] - a_[begin + b]};
  }
}

}  // namespace butee::record
