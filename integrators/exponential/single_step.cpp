#include "integrators/exponential/single_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "butee/dynamics/dynamics.hpp"

namespace butee::integrators {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Adds the effect of a force to the end, h times the speed and the middle of a path, and returns
/// the changes.
std::array<double, 3> move(std::array<double, 3>& path, const PathCoupling& coupling, const ForceMoments& force) {
  std::array<double, 3> moved{};
  for (std::size_t row = 0; row < 3; ++row) {
    moved[row] = coupling[row][0] * force[0] + coupling[row][1] * force[1] + coupling[row][2] * force[2];
    path[row] += moved[row];
  }
  return moved;
}

}  // namespace

SingleStep::Gap::Gap(const dynamics::ElasticStops& contact)
    : upper(contact.play_of(0).upper()), lower(contact.play_of(0).lower()), limit(constant_force_limit(contact, 0)) {}

bool SingleStep::can_take(const dynamics::Dynamics& dynamics) {
  const auto& loads = dynamics.system().loads;
  return dynamics.size() == 1 && dynamics.stop_count() == 1 &&
         std::all_of(loads.begin(), loads.end(), [](const auto& load) { return load.in_time->harmonic().has_value(); });
}

SingleStep::SingleStep(dynamics::Dynamics& dynamics, dynamics::ModalSystem& modal, const StepGoal& goal,
                       std::size_t most)
    : goal_(goal),
      mode_(modal),
      contact_(dynamics.stops(), 0),
      newton_(contact_.stiffness()),
      residual_(dynamics.stops(), 0),
      gap_(dynamics.stops()),
      longest_near_(longest_near_stops(modal)),
      accounts_(account_goal(goal, modal.frequencies().minCoeff()), 1),
      flows_(modal, mode_, newton_),
      record_(dynamics, modal, mode_, contact_, goal.outputs, most) {}

void SingleStep::save(double* memory) const {
  memory[0] = now_.q;
  memory[1] = now_.v;
  accounts_.save(memory + 2);
  record_.save_phases(memory + 2 + accounts_.memory_size());
}

void SingleStep::begin(double t, const double* memory, ContactScale scale) {
  now_ = {memory[0], memory[1]};
  scale_ = scale;
  accounts_.load(memory + 2);
  if (!contact_.is_linear())
    contact_.allow(
        kLasting * goal_.tolerance / goal_.run_time * scale.speed / (mode_.stop_shape * mode_.stop_shape),
        kLasting * goal_.tolerance / scale.characteristic_time() * scale.speed / (mode_.stop_shape * mode_.stop_shape));
  record_.begin(t, now_, memory + 2 + accounts_.memory_size());
}

void SingleStep::accept(double t) {
  const SingleFlow& flow = *tried_.flow;
  const double h = flow.h, shape = mode_.stop_shape, w = shape * now_.q;
  SingleBreakpoint::Step step;
  step.hv0 = h * shape * now_.v;
  now_ = tried_.to;
  step.hv1 = h * shape * now_.v;
  step.quartic = tried_.path[2] - (0.5 * (w + shape * now_.q) + 0.125 * (step.hv0 - step.hv1));
  step.force = tried_.force;
  record_.add(flow, step, t, now_);
  accounts_.charge(0, tried_.change);
}

Trial SingleStep::attempt(const SingleFlow& flow, double t_end) {
  tried_.flow = &flow;
  tried_.t_end = t_end;
  tried_.change = 0.0;
  const std::span<const Phase> phase = record_.last_phases();
  const auto [q, v] = now_;
  double q1 = flow.qq * q + flow.qv * v, v1 = flow.vq * q + flow.vv * v, middle = flow.half_qq * q + flow.half_qv * v;
  for (std::size_t j = 0; j < phase.size(); ++j) {
    const auto [c, s] = phase[j];
    const std::array<double, 6>& load = flow.harmonics[j].load;
    q1 += c * load[0] + s * load[1];
    v1 += c * load[2] + s * load[3];
    middle += c * load[4] + s * load[5];
  }
  if (!std::isfinite(q1 + v1)) return Trial::not_finite;
  const double h = flow.h, shape = mode_.stop_shape, w = shape * q, hv = h * shape * v;
  tried_.path = {shape * q1, h * shape * v1, shape * middle};
  tried_.error = 0.0;
  const double bound = displacement_bound(flow, w, hv);
  tried_.is_contact_free = bound <= gap_.limit && is_constant(flow, w, bound);
  if (tried_.is_contact_free) {
    if (!is_smooth(flow, w)) return Trial::too_long;
  } else {
    if (h > longest_near_) return Trial::too_long;
    tried_.force = {};
    const Trial trial = iterate(flow, w, hv);
    if (trial != Trial::accepted) return trial;
  }
  for (std::size_t k = 0; k < kForceMoments; ++k) {
    q1 += tried_.force[k] * flow.force_q[k];
    v1 += tried_.force[k] * flow.force_v[k];
  }
  tried_.to = {q1, v1};
  scale_.displacement = std::max(scale_.displacement, std::abs(shape * q1));
  scale_.speed = std::max(scale_.speed, std::abs(shape * v1));
  return Trial::accepted;
}

double SingleStep::displacement_bound(const SingleFlow& flow, double w, double hv) {
  const std::array<double, 3>& path = tried_.path;
  const double hermite = flow.hermite_q * std::abs(now_.q) + flow.hermite_v * std::abs(now_.v);
  tried_.force = {};
  std::array<double, 3> pulled = path;
  if (!contact_.is_linear()) {
    tried_.force = contact_.residual_moments(ContactPath(w, hv, path[0], path[1], 0.0));
    move(pulled, flow.coupling, tried_.force);
  }
  const double highest = std::max({w, path[0], pulled[0]}), lowest = std::min({w, path[0], pulled[0]});
  const double nearest =
      std::max(gap_.upper < kInfinite ? highest : -kInfinite, gap_.lower > -kInfinite ? -lowest : -kInfinite);
  return nearest + kBump * (std::abs(hv) + std::max(std::abs(path[1]), std::abs(pulled[1]))) + hermite +
         flow.hermite_loads;
}

bool SingleStep::is_smooth(const SingleFlow& flow, double w) {
  // The rates of overdamped motion are at most 2 delta + omega; the transient that a load starts
  // from rest is such a motion as well.
  const double h = flow.h, rate = mode_.square + 4.0 * mode_.decay * mode_.decay, angle = h * h * rate;
  const double turn = h * mode_.load_frequency;
  double error = flow.hermite_loads * std::min(1.0, kQuintic * (angle + turn * turn));
  if (rate > 0.0)
    error += std::min(2.0, angle * angle * angle / 46080.0) *
             (std::abs(w) + std::abs(mode_.stop_shape * now_.v) / std::sqrt(rate));
  tried_.interpolation_error =
      error > 0.0 ? error / (goal_.outputs * std::max(scale_.displacement, std::abs(tried_.path[0]))) : 0.0;
  return !(tried_.interpolation_error > 1.0);
}

bool SingleStep::is_constant(const SingleFlow& flow, double w, double bound) const {
  if (contact_.is_linear()) return true;
  const ContactScale reached = {std::max(scale_.displacement, std::abs(tried_.path[0])),
                                std::max(scale_.speed, std::abs(tried_.path[1]) / flow.h)};
  const double steps = characteristic_steps(reached, flow.h);
  return residual_.constant_error(w, tried_.path[0], bound, std::abs(flow.coupling[0][0]), steps) <=
         kResidualError * goal_.outputs * reached.displacement * share_of_run(flow.h, steps, goal_.run_time);
}

Trial SingleStep::iterate(const SingleFlow& flow, double w, double hv) {
  double last = 0.0;
  ContactStatus before = ContactStatus::changing;
  const auto& coupling = flow.coupling;
  std::array<double, 3>& end = tried_.path;
  ForceMoments& force = tried_.force;
  for (int i = 0; i < kMostSweeps; ++i) {
    const double quartic = end[2] - (0.5 * (w + end[0]) + 0.125 * (hv - end[1]));
    const ContactPath path(w, hv, end[0], end[1], quartic);
    const ContactStatus status = contact_.status(path);
    const double scale = std::max(scale_.displacement, std::abs(end[0]));
    double change = 0.0;
    // A spring throughout the step whose equations were solved before, or no force at all.
    const bool is_solved = contact_.is_linear() && status != ContactStatus::changing && status == before;
    if (!is_solved) {
      const Projection projection = contact_.project(path, status);
      const ForceMoments more = newton_.correction(
          status == ContactStatus::closed ? flow.closed_inverse : newton_.inverse(projection.closed, coupling),
          projection.force, force);
      const std::array<double, 3> moved = move(end, coupling, more);
      for (std::size_t k = 0; k < 3; ++k) force[k] += more[k];
      change = std::abs(moved[0]) + kBump * std::abs(moved[1]) + std::abs(moved[2]);
      if (!std::isfinite(change)) return Trial::too_long;
    }
    before = status;
    const double stiffness = contact_.stiffness_along(path), stiff = stiffness * coupling[1][0];
    const ContactScale reached = {scale, std::max(scale_.speed, std::max(std::abs(hv), std::abs(end[1])) / flow.h)};
    const double next = i > 0 ? change * std::min(1.0, change / last) : change,
                 enough =
                     unfinished_change(goal_, flow.h) * (contact_.is_bounded() ? allowed_change : allowed_next_change)(
                                                            goal_.middle, stiff, flow.h, reached);
    last = change;
    if (change > kRoundingChange * scale && next > enough) continue;
    double error = std::abs(quartic);
    if (force[0] != 0.0) {
      const double speed = std::max(std::abs(hv), std::abs(end[1]));
      error = path_error(error, stiff, flow.h, reached, status == ContactStatus::closed);
      if (status != ContactStatus::closed)
        error = std::max(error, slope_error(goal_, stiffness * flow.unresolved, speed, flow.h, reached));
      if (changes(path, w, end[0])) {
        tried_.change = change_error(stiff, speed, flow.h, reached);
        error = std::max(error, tried_.change / accounts_.allowed(0, tried_.t_end) * goal_.middle * scale);
      } else if (status == ContactStatus::closed) {
        tried_.change = closed_error(quartic, stiff, flow.h, reached);
        error = std::max(error, tried_.change / accounts_.allowed_closed(0, tried_.t_end) * goal_.middle * scale);
      }
    } else if (const double depth = beyond(path) + kPathError * std::abs(quartic); depth > 0.0) {
      error = std::max(error, missed_contact_error(goal_, stiff * depth, flow.h, scale_.speed) * scale);
    }
    tried_.error = error;
    return error <= goal_.middle * scale ? Trial::accepted : Trial::too_long;
  }
  return Trial::too_long;
}

double SingleStep::time_to_contact() const {
  const double w = mode_.stop_shape * now_.q, speed = mode_.stop_shape * now_.v;
  if (speed > 0.0 && gap_.upper < kInfinite) return (gap_.limit - w) / speed;
  if (speed < 0.0 && gap_.lower > -kInfinite) return (gap_.limit + w) / -speed;
  return kInfinite;
}

}  // namespace butee::integrators
