// Of ExponentialStep: the forces and paths of the stops within reach, found together.
#include <algorithm>
#include <cmath>

#include "integrators/exponential_step.hpp"

namespace butee::integrators {

using dynamics::StepFlow;
using Eigen::ArrayXd;

Trial ExponentialStep::iterate(StepFlow& flow) {
  hv_ = flow.h() * wv_;
  path_.end = w_new_;
  path_.speed = flow.h() * wv_new_;
  modal_.stop_shapes().displacement(q_half_.data(), path_.middle.data());
  for (ArrayXd& force : force_) force.setZero();
  for (const Index i : touched_) is_touched_[static_cast<std::size_t>(i)] = false;
  touched_.clear();
  choose_registers();
  guess(flow);
  double last = 0.0;
  for (int i = 0; i < kMostSweeps; ++i) {
    const double scale_before = std::max(scale_.displacement, path_.end.abs().maxCoeff());
    const double change = sweep(flow, scale_before, i > 0);
    if (!std::isfinite(change)) return Trial::too_long;
    const double scale = std::max(scale_.displacement, path_.end.abs().maxCoeff());
    const double next = change * (change / last);
    const bool is_expected = i > 0 && change < last && next <= kExpected * kConverged;
    last = change;
    if (change > kConverged && !is_expected) continue;
    find_error(flow, scale);
    return error_ <= tolerance_ * scale ? Trial::accepted : Trial::too_long;
  }
  return Trial::too_long;
}

void ExponentialStep::choose_registers() {
  near_registers_.clear();
  far_registers_.clear();
  std::size_t next = 0;
  for (Index begin = 0, end = 0; begin < path_.end.size(); begin = end) {
    end = StepFlow::next_register(begin);
    const std::size_t first = next;
    while (next < reachable_.size() && reachable_[next] < end) ++next;
    (next > first ? near_registers_ : far_registers_).push_back(begin);
  }
}

void ExponentialStep::find_bounds() {
  bulge_ = path_.middle - (0.5 * (w_ + path_.end) + 0.125 * (hv_ - path_.speed));
  // The Bernstein coefficients of the path, as in StopPath.
  const double bulges = orders_ == 3 ? 16.0 / 6.0 : 0.0;
  const auto b1 = w_ + 0.25 * hv_;
  const auto b2 = 0.5 * (w_ + path_.end) + (hv_ - path_.speed) * (1.0 / 6.0) + bulges * bulge_;
  const auto b3 = path_.end - 0.25 * path_.speed;
  excess_ =
      (w_.max(path_.end).max(b1).max(b2).max(b3) - upper_).max(lower_ - w_.min(path_.end).min(b1).min(b2).min(b3));
}

const StepFlow::Derived& ExponentialStep::derived(StepFlow& flow, Index stop) const {
  StepFlow::Derived& known = flow.derived(stop);
  if (known.is_known) return known;
  known.coupling = flow.own_coupling(stop);
  known.inverse = own_[static_cast<std::size_t>(stop)].closed_inverse(known.coupling);
  known.unresolved =
      (modal_.stop_shapes().of(stop).array().square() * (flow.h() * modal_.frequencies()).unaryExpr([](double x) {
        return unresolved_part(x);
      })).sum();
  known.is_known = true;
  return known;
}

bool ExponentialStep::is_spring(Index stop) const {
  const StopForce& force = stops_[static_cast<std::size_t>(stop)];
  const StopPath path = path_of(stop);
  return force.is_spring(path, force.course(path));
}

void ExponentialStep::see(Index stop) {
  seen_.end[stop] = path_.end[stop];
  seen_.speed[stop] = path_.speed[stop];
  seen_.middle[stop] = path_.middle[stop];
}

double ExponentialStep::moved_since(StepFlow& flow, Index stop) const {
  const double path = std::abs(path_.end[stop] - seen_.end[stop]) +
                      kBump * std::abs(path_.speed[stop] - seen_.speed[stop]) +
                      std::abs(path_.middle[stop] - seen_.middle[stop]);
  const double stiff = stops_[static_cast<std::size_t>(stop)].stiffness() * derived(flow, stop).coupling[1][0];
  return path * (1.0 + std::abs(stiff));
}

double ExponentialStep::allowed_change(StepFlow& flow, Index stop, double displacement) const {
  const double h = flow.h();
  const StopScale scale = scale_of(stop, reached_on_path(stop, h), displacement);
  const double stiff = stops_[static_cast<std::size_t>(stop)].stiffness() * derived(flow, stop).coupling[1][0];
  return std::max(integrators::allowed_change(tolerance_, stiff, h, scale), kRounding / kConverged * displacement);
}

double ExponentialStep::sweep(StepFlow& flow, double displacement, bool may_skip) {
  find_bounds();
  double change = 0.0;
  for (const Index i : reachable_) {
    const auto place = static_cast<std::size_t>(i);
    StopForce& stop = stops_[place];
    if (stop.is_linear() && !is_touched_[place] && excess_[i] <= 0.0) continue;
    if (may_skip && is_touched_[place] && moved_since(flow, i) <= kSettled * allowed_change(flow, i, displacement))
      continue;
    const StopPath path = path_of(i);
    const StopForce::Course course = stop.course(path);
    const ForceMoments old = {force_[0][i], force_[1][i], force_[2][i]};
    const StepFlow::Derived& known = derived(flow, i);
    const bool was_spring = stop.is_spring(path, course);
    see(i);
    ForceMoments projected, more;
    if (was_spring) {
      projected = stop.of_spring(path);
      more = own_[place].correction(known.inverse, projected, old);
    } else {
      const Projection projection = stop.project(path, course);
      projected = projection.force;
      more = own_[place].correction(
          course == StopForce::Course::closed ? known.inverse : own_[place].inverse(projection.closed, known.coupling),
          projected, old);
    }
    if (orders_ == 1) force_[1][i] = projected[1];  // for the estimate alone
    const bool stays = more[0] == 0.0 && more[1] == 0.0 && more[2] == 0.0;
    const double moved = stays ? 0.0 : add_force(flow, i, more);
    if (!std::isfinite(moved)) return moved;
    // The force of a spring was found for where it has led; of all others for where they were.
    if (was_spring && is_spring(i)) see(i);
    // At a start from rest the force itself makes the scale.
    if (moved > 0.0)
      change = std::max(change, moved / allowed_change(flow, i, std::max(displacement, std::abs(path_.end[i]))));
  }
  return change;
}

double ExponentialStep::add_force(StepFlow& flow, Index stop, const ForceMoments& more) {
  const auto place = static_cast<std::size_t>(stop);
  if (!is_touched_[place]) touched_.push_back(stop);
  is_touched_[place] = true;
  for (std::size_t k = 0; k < 3; ++k) force_[k][stop] += more[k];
  return flow.add_force(stop, more, kBump, near_registers_, path_);
}

void ExponentialStep::guess(StepFlow& flow) {
  for (const Index i : reachable_) {
    const double side = w_[i] > upper_[i] ? 1.0 : w_[i] < lower_[i] ? -1.0 : 0.0;
    if (side == 0.0) continue;
    const double stiffness = stops_[static_cast<std::size_t>(i)].stiffness();
    const double at_start = stiffness * (side * gaps_[i] - w_[i]), half_rise = -0.5 * stiffness * hv_[i];
    force_[0][i] = at_start + half_rise;
    if (orders_ > 1) force_[1][i] = half_rise;
    touched_.push_back(i);
    is_touched_[static_cast<std::size_t>(i)] = true;
  }
  flow.add_forces(touched_, force_, near_registers_, path_);
}

StopScale ExponentialStep::scale_of(Index stop, StopScale reached, double displacement) const {
  const double x_floor = kScaleFloor * displacement, v_floor = kScaleFloor * scale_.speed;
  if (const Index place = pair_of_[static_cast<std::size_t>(stop)]; place >= 0) {
    const Pair& pair = pairs_[static_cast<std::size_t>(place)];
    const PairScale& of = pair_scales_[static_cast<std::size_t>(place)];
    return {std::min(std::max(of.x_a, x_floor) / pair.share_a, std::max(of.x_b, x_floor) / pair.share_b),
            std::min(std::max(of.v_a, v_floor) / pair.share_a, std::max(of.v_b, v_floor) / pair.share_b)};
  }
  return {std::max({largest_w_[stop], reached.displacement, x_floor}),
          std::max({largest_wv_[stop], reached.speed, v_floor})};
}

void ExponentialStep::find_error(StepFlow& flow, double displacement) {
  const double h = flow.h();
  for (const Index i : reachable_) {
    const auto place = static_cast<std::size_t>(i);
    double error = is_near(i) ? std::abs(bulge_[i]) : error_of_pull(flow, i);
    if (is_near(i) && is_touched_[place]) {
      const StopScale scale = scale_of(i, reached_on_path(i, h), displacement);
      const double stiffness = stops_[place].stiffness(), stiff = stiffness * flow.derived(i).coupling[1][0];
      error = error_of_path(error, stiff, h, scale, stays_closed(i));
      if (!stays_closed(i)) {
        const double kink = h * h * stiffness * flow.derived(i).unresolved *
                            std::max(std::abs(hv_[i]), std::abs(path_.speed[i])) / (h * scale.speed);
        error = std::max(error, kink * tolerance_ * scale.displacement / (kUnresolved * output_tolerance_));
      }
      error *= displacement / scale.displacement;
    } else if (const double depth = excess_[i] + kPathError * std::abs(bulge_[i]); is_near(i) && depth > 0.0) {
      const double stiff = stops_[place].stiffness() * derived(flow, i).coupling[1][0];
      error = std::max(
          error, error_of_missed(stiff * depth, h, scale_of(i, reached_on_path(i, h), displacement)) * displacement);
    }
    if (orders_ == 1) error += std::abs(flow.own_coupling(i)[0][1] * force_[1][i]);
    error_ = std::max(error_, error);
  }
}

bool ExponentialStep::stays_closed(Index stop) const {
  const double from = w_[stop], to = path_.end[stop];
  return (from > upper_[stop] && to > upper_[stop]) || (from < lower_[stop] && to < lower_[stop]);
}

}  // namespace butee::integrators
