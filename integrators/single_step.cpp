#include "integrators/single_step.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "butee/dynamics/dynamics.hpp"

namespace butee::integrators {
namespace {
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Moves the end, speed and middle of a path by a force, and returns by how much.
std::array<double, 3> move(std::array<double, 3>& path, const PathCoupling& coupling, const ForceMoments& force) {
  std::array<double, 3> moved{};
  for (std::size_t row = 0; row < 3; ++row) {
    moved[row] = coupling[row][0] * force[0] + coupling[row][1] * force[1] + coupling[row][2] * force[2];
    path[row] += moved[row];
  }
  return moved;
}
}  // namespace

bool SingleStep::can_take(const dynamics::Dynamics& dynamics) {
  const auto& loads = dynamics.system().loads;
  return dynamics.size() == 1 && dynamics.stop_count() == 1 &&
         std::all_of(loads.begin(), loads.end(), [](const auto& load) { return load.in_time->harmonic().has_value(); });
}

SingleStep::SingleStep(dynamics::Dynamics& dynamics, dynamics::ModalSystem& modal, int order, const StepGoal& goal,
                       std::size_t most)
    : dynamics_(dynamics),
      modal_(modal),
      orders_(static_cast<std::size_t>(order / 2)),
      goal_(goal),
      tolerance_(goal.middle),
      output_tolerance_(goal.outputs),
      stop_(dynamics.contact(), 0),
      own_(stop_.stiffness(), orders_),
      pull_(dynamics.contact(), 0),
      gap_(dynamics.contact().gap_of(0)),
      upper_(dynamics.contact().sides_of(0) == model::Sides::negative ? kInfinite : gap_),
      lower_(dynamics.contact().sides_of(0) == model::Sides::positive ? -kInfinite : -gap_),
      longest_near_(longest_near_stops(modal)),
      calm_border_(calm_border(dynamics.contact(), 0)),
      stop_shape_(modal.stop_shapes().matrix()(0, 0)),
      square_(modal.frequencies()[0] * modal.frequencies()[0]),
      decay_(modal.decay()[0]),
      harmonics_(modal.harmonics()),
      oscillator_(modal.frequencies()[0], decay_),
      motion_(modal),
      energy_(dynamics, modal) {
  for (const dynamics::ModalHarmonic& harmonic : harmonics_) {
    constexpr double kResonance = 1e-7;
    const double turn = harmonic.angular_frequency;
    const std::complex<double> hold(square_ - turn * turn, 2.0 * decay_ * turn),
        motion = std::complex<double>(harmonic.cosine[0], -harmonic.sine[0]) / hold;
    is_kept_ = is_kept_ && std::abs(hold) > kResonance * (square_ + turn * turn);
    kept_.push_back({motion.real(), -motion.imag()});
  }
  for (const dynamics::ModalHarmonic& harmonic : harmonics_)
    load_frequency_ = std::max(load_frequency_, harmonic.angular_frequency);
  for (Eigen::VectorXd* one : {&padded_q_, &padded_v_, &padded_force_[0], &padded_force_[1], &padded_force_[2]})
    one->setZero(dynamics::ModalMotion::padded(1));
  knots_.reserve(most + 1);
  times_.reserve(most + 1);
  phases_.resize((most + 1) * harmonics_.size());
}

void SingleStep::complete(double* memory) const {
  memory[2] = kMostTurns;
  std::fill(memory + 3, memory + memory_size(), 0.0);
}

void SingleStep::save(double* memory) const {
  memory[0] = now_.q;
  memory[1] = now_.v;
  memory[2] = turns_;
  const Phase* last = phases_.data() + (knots_.size() - 1) * harmonics_.size();
  for (std::size_t j = 0; j < harmonics_.size(); ++j) {
    memory[3 + 2 * j] = last[j].cosine;
    memory[4 + 2 * j] = last[j].sine;
  }
}

void SingleStep::begin(double t, const double* memory, StopScale scale) {
  now_ = {memory[0], memory[1]};
  scale_ = scale;
  if (!stop_.is_linear())
    stop_.allow(kLasting * goal_.tolerance / goal_.run_time * scale.speed / (stop_shape_ * stop_shape_),
                kLasting * goal_.tolerance / scale.own_time() * scale.speed / (stop_shape_ * stop_shape_));
  knots_.assign(1, {t, now_});
  times_.assign(1, t);
  turns_ = static_cast<int>(memory[2]);
  if (turns_ == kMostTurns) return find_phases();
  for (std::size_t j = 0; j < harmonics_.size(); ++j) phases_[j] = {memory[3 + 2 * j], memory[4 + 2 * j]};
}

void SingleStep::accept(double t) {
  Knot& last = knots_.back();
  const double h = tried_->h, w = stop_shape_ * now_.q;
  last.hv0 = h * stop_shape_ * now_.v;
  now_ = next_;
  last.hv1 = h * stop_shape_ * now_.v;
  last.bulge = orders_ == 3 ? path_[2] - (0.5 * (w + stop_shape_ * now_.q) + 0.125 * (last.hv0 - last.hv1)) : 0.0;
  last.force = force_;
  if (orders_ == 1) last.force[1] = 0.0;  // That was for the estimate alone.
  knots_.push_back({t, now_});
  times_.push_back(t);
  if (++turns_ == kMostTurns) return find_phases();
  Phase* to = phases(knots_.size() - 1);
  const Phase* from = to - harmonics_.size();
  for (std::size_t j = 0; j < harmonics_.size(); ++j) {
    const auto [c, s] = tried_->harmonics[j].turn;
    to[j] = {c * from[j].cosine - s * from[j].sine, s * from[j].cosine + c * from[j].sine};
  }
}

void SingleStep::find_phases() {
  turns_ = 0;
  Phase* phase = phases(knots_.size() - 1);
  for (const dynamics::ModalHarmonic& harmonic : harmonics_) {
    const double angle = harmonic.angular_frequency * knots_.back().t;
    *phase++ = {std::cos(angle), std::sin(angle)};
  }
}

std::span<const double> SingleStep::knots() const {
  if (times_.size() < 3) return {};
  return {times_.data() + 1, times_.size() - 2};
}

void SingleStep::fill(dynamics::StepFlow& from, Flow& flow) const {
  const dynamics::ModalFlow &whole = from.whole, &half = from.half;
  flow.h = from.h();
  flow.qq = whole.qq()[0];
  flow.qv = whole.qv()[0];
  flow.vq = whole.vq()[0];
  flow.vv = whole.vv()[0];
  flow.half_qq = half.qq()[0];
  flow.half_qv = half.qv()[0];
  flow.swing_q = from.swing_q[0];
  flow.swing_v = from.swing_v[0];
  flow.swing_harmonics = from.swing_harmonics;
  for (std::size_t k = 0; k < 3; ++k) {
    flow.force_q[k] = whole.force_q(static_cast<int>(k))[0] * stop_shape_;
    flow.force_v[k] = whole.force_v(static_cast<int>(k))[0] * stop_shape_;
  }
  flow.coupling = from.own_coupling(0);
  flow.closed_inverse = own_.closed_inverse(flow.coupling);
  flow.harmonics.clear();
  for (std::size_t j = 0; j < harmonics_.size(); ++j) {
    const double angle = harmonics_[j].angular_frequency * flow.h;
    flow.harmonics.push_back({{whole.harmonic_q(j, 0)[0], -whole.harmonic_q(j, 1)[0], whole.harmonic_v(j, 0)[0],
                               -whole.harmonic_v(j, 1)[0], half.harmonic_q(j, 0)[0], -half.harmonic_q(j, 1)[0]},
                              {std::cos(angle), std::sin(angle)}});
  }
}

Trial SingleStep::attempt_rung(int level) {
  Flow& flow = flows_[static_cast<std::size_t>(level & 7)];
  if (flow.h == 0.0 || flow.level != level) {
    fill(modal_.ladder(level), flow);
    flow.level = level;
  }
  return attempt(flow);
}

Trial SingleStep::attempt_until(double t) {
  fill(modal_.odd(t - knots_.back().t), odd_);
  return attempt(odd_);
}

Trial SingleStep::attempt(const Flow& flow) {
  tried_ = &flow;
  const Phase* phase = phases(knots_.size() - 1);
  const auto [q, v] = now_;
  double q1 = flow.qq * q + flow.qv * v, v1 = flow.vq * q + flow.vv * v, middle = flow.half_qq * q + flow.half_qv * v;
  for (std::size_t j = 0; j < harmonics_.size(); ++j) {
    const auto [c, s] = phase[j];
    const std::array<double, 6>& load = flow.harmonics[j].load;
    q1 += c * load[0] + s * load[1];
    v1 += c * load[2] + s * load[3];
    middle += c * load[4] + s * load[5];
  }
  if (!std::isfinite(q1 + v1)) return Trial::not_finite;
  const double h = flow.h, shape = stop_shape_, w = shape * q, hv = h * shape * v;
  path_ = {shape * q1, h * shape * v1, shape * middle};
  error_ = 0.0;
  force_ = {};
  const double swing = flow.swing_q * std::abs(q) + flow.swing_v * std::abs(v);
  std::array<double, 3> pulled = path_;
  if (!stop_.is_linear()) {
    force_ = stop_.far_force(StopPath(w, hv, path_[0], path_[1], 0.0));
    move(pulled, flow.coupling, force_);
  }
  const double highest = std::max({w, path_[0], pulled[0]}), lowest = std::min({w, path_[0], pulled[0]});
  const double nearest =
      std::max(upper_ < kInfinite ? highest : -kInfinite, lower_ > -kInfinite ? -lowest : -kInfinite);
  const double reach = nearest + kBump * (std::abs(hv) + std::max(std::abs(path_[1]), std::abs(pulled[1]))) + swing +
                       flow.swing_harmonics;
  is_quiet_ = reach <= calm_border_ && is_steady(flow, w, reach);
  if (is_quiet_) {
    // Of the slower and the faster of two decaying motions too, whose rates are within 2 delta + omega. What a load
    // starts from rest is such a motion as well.
    const double rate = square_ + 4.0 * decay_ * decay_, angle = h * h * rate;
    const double turn = h * load_frequency_;
    double error = flow.swing_harmonics * std::min(1.0, kQuintic * (angle + turn * turn));
    if (rate > 0.0)
      error += std::min(2.0, angle * angle * angle / 46080.0) * (std::abs(w) + std::abs(shape * v) / std::sqrt(rate));
    unsmooth_ = error > 0.0 ? error / (output_tolerance_ * std::max(scale_.displacement, std::abs(path_[0]))) : 0.0;
    if (unsmooth_ > 1.0) return Trial::too_long;
  }
  if (!is_quiet_) {
    if (h > longest_near_) return Trial::too_long;
    force_ = {};
    const Trial trial = iterate(flow, w, hv);
    if (trial != Trial::accepted) return trial;
  }
  for (std::size_t k = 0; k < orders_; ++k) {
    q1 += force_[k] * flow.force_q[k];
    v1 += force_[k] * flow.force_v[k];
  }
  next_ = {q1, v1};
  scale_.displacement = std::max(scale_.displacement, std::abs(shape * q1));
  scale_.speed = std::max(scale_.speed, std::abs(shape * v1));
  return Trial::accepted;
}

bool SingleStep::is_steady(const Flow& flow, double w, double reach) const {
  if (stop_.is_linear()) return true;
  const StopScale reached = {std::max(scale_.displacement, std::abs(path_[0])),
                             std::max(scale_.speed, std::abs(path_[1]) / flow.h)};
  const double steps = steps_of(reached, flow.h);
  return pull_.unfelt(w, path_[0], reach, std::abs(flow.coupling[0][0]), steps) <=
         kUnfeltPull * output_tolerance_ * reached.displacement * share_of_run(flow.h, steps, goal_.run_time);
}

Trial SingleStep::iterate(const Flow& flow, double w, double hv) {
  using Course = StopForce::Course;
  double last = 0.0;
  Course before = Course::changing;
  const auto& coupling = flow.coupling;
  for (int i = 0; i < kMostSweeps; ++i) {
    const double bulge = path_[2] - (0.5 * (w + path_[0]) + 0.125 * (hv - path_[1]));
    const StopPath path(w, hv, path_[0], path_[1], orders_ == 3 ? bulge : 0.0);
    const Course course = stop_.course(path);
    const double scale = std::max(scale_.displacement, std::abs(path_[0]));
    double change = 0.0;
    // A spring throughout, whose equations were solved before, or no force at all.
    const bool is_solved = stop_.is_linear() && course != Course::changing && course == before;
    if (!is_solved) {
      const Projection projection = stop_.project(path, course);
      const ForceMoments more =
          own_.correction(course == Course::closed ? flow.closed_inverse : own_.inverse(projection.closed, coupling),
                          projection.force, force_);
      const std::array<double, 3> moved = move(path_, coupling, more);
      for (std::size_t k = 0; k < 3; ++k) force_[k] += more[k];
      if (orders_ == 1) force_[1] = projection.force[1];  // for the estimate alone
      change = std::abs(moved[0]) + kBump * std::abs(moved[1]) + std::abs(moved[2]);
      if (!std::isfinite(change)) return Trial::too_long;
    }
    before = course;
    const double stiff = stop_.stiffness() * coupling[1][0];
    const StopScale reached = {scale, std::max(scale_.speed, std::max(std::abs(hv), std::abs(path_[1])) / flow.h)};
    const double next = change * (change / last);
    const double enough = std::max(kConverged * allowed_change(tolerance_, stiff, flow.h, reached), kRounding * scale);
    const bool is_expected = i > 0 && change < last && next <= kExpected * enough;
    last = change;
    if (change > enough && !is_expected) continue;
    error_ = std::abs(bulge);
    if (force_[0] != 0.0) {
      error_ = error_of_path(error_, stiff, flow.h, reached, course == Course::closed);
    } else if (const double depth = beyond(path) + kPathError * std::abs(bulge); depth > 0.0) {
      // The path passes the stop by, but might have changed its speed.
      const double push = stiff * depth;
      error_ = std::max(error_, push / (flow.h * scale_.speed) * tolerance_ / goal_.tolerance * scale);
    }
    if (orders_ == 1) error_ += std::abs(coupling[0][1] * force_[1]);
    return error_ <= tolerance_ * scale ? Trial::accepted : Trial::too_long;
  }
  return Trial::too_long;
}

Motion SingleStep::motion_of(Point at, double harmonic_force) const {
  const double shape = modal_.shapes()(0, 0);
  const double force = dynamics_.contact().force_of(0, stop_shape_ * at.q);
  const double a = harmonic_force + stop_shape_ * force - square_ * at.q - 2.0 * decay_ * at.v;
  return {shape * at.q, shape * at.v, shape * a};
}

const Motion& SingleStep::motion_at(std::size_t knot) {
  Knot& at = knots_[knot];
  if (at.has_motion) return at.motion;
  at.has_motion = true;
  double harmonic_force = 0.0;
  for (std::size_t j = 0; j < harmonics_.size(); ++j) {
    const auto [c, s] = phases(knot)[j];
    harmonic_force += c * harmonics_[j].cosine[0] + s * harmonics_[j].sine[0];
  }
  return at.motion = motion_of(at.at, harmonic_force);
}

double SingleStep::time_to_stop() const {
  const double w = stop_shape_ * now_.q, speed = stop_shape_ * now_.v;
  if (speed > 0.0 && upper_ < kInfinite) return (calm_border_ - w) / speed;
  if (speed < 0.0 && lower_ > -kInfinite) return (calm_border_ + w) / -speed;
  return kInfinite;
}

double SingleStep::beyond(const StopPath& path) const {
  return std::max(path.highest() - upper_, lower_ - path.lowest());
}

StopPath SingleStep::path_from(std::size_t knot) const {
  const Knot& from = knots_[knot];
  return {stop_shape_ * from.at.q, from.hv0, stop_shape_ * knots_[knot + 1].at.q, from.hv1, from.bulge};
}

bool SingleStep::is_quintic(std::size_t knot) const {
  // The part of a quintic's slope that is wrong: (omega h)^5 sqrt(5)/30000 where nothing bends the motion, and
  // kKinkedSlope (omega h)^2 where a stop opens or closes; and up to kJumpedSlope of the speed that a force gives that
  // jumps by the height of its jump.
  constexpr double kGoodPart = 0.5, kKinkedSlope = 5e-3, kJumpedSlope = 0.07;
  const Knot& from = knots_[knot];
  const double h = knots_[knot + 1].t - from.t;
  const double stiff = from.force[0] != 0.0 ? h * h * stop_.stiffness() * stop_shape_ * stop_shape_ : 0.0;
  const double angle = h * h * (square_ + 4.0 * decay_ * decay_ + load_frequency_ * load_frequency_) + stiff;
  const double good = kGoodPart * output_tolerance_;
  if (quintic_error(1.0, angle * angle * std::sqrt(angle)).v > good) return false;
  const StopPath path = path_from(knot);
  if (kJumpedSlope * h * stop_shape_ * stop_shape_ * stop_.jump(path) > good * scale_.speed) return false;
  return kKinkedSlope * stiff <= good || stop_.course(path) != StopForce::Course::changing;
}

Motion SingleStep::motion_within(std::size_t knot, double t) {
  const Knot& from = knots_[knot];
  const double h = knots_[knot + 1].t - from.t, tau = t - from.t, part = tau / h;
  const StopPath path = path_from(knot);
  const bool is_changing = stop_.course(path) == StopForce::Course::changing || stop_.jump(path) > 0.0;
  ForceMoments force = moments_within(from.force, 0.0, part);
  if (is_changing) {
    const StopPath so_far = path.until(part);
    force = stop_.project(so_far, stop_.course(so_far)).force;
  }
  for (double& moment : force) moment *= stop_shape_;
  double harmonic_force = 0.0;
  Oscillator::Point at{from.at.q, from.at.v}, kept{};
  for (std::size_t j = 0; j < harmonics_.size(); ++j) {
    const dynamics::ModalHarmonic& load = harmonics_[j];
    const Kept& motion = kept_[j];
    const Phase before = phases(knot)[j];
    const double angle = load.angular_frequency * t, c = std::cos(angle), s = std::sin(angle);
    harmonic_force += c * load.cosine[0] + s * load.sine[0];
    at.q -= before.cosine * motion.cosine + before.sine * motion.sine;
    at.v -= load.angular_frequency * (before.cosine * motion.sine - before.sine * motion.cosine);
    kept.q += c * motion.cosine + s * motion.sine;
    kept.v += load.angular_frequency * (c * motion.sine - s * motion.cosine);
  }
  if (is_kept_ && oscillator_.can_move(tau)) {
    const double r = 1.0 / tau;
    at = oscillator_.move(
        at, {force[0] - force[1] + force[2], r * (2.0 * force[1] - 6.0 * force[2]), 6.0 * r * r * force[2]}, tau);
    return motion_of({at.q + kept.q, at.v + kept.v}, harmonic_force);
  }
  padded_q_[0] = from.at.q;
  padded_v_[0] = from.at.v;
  std::array<const double*, 3> moments{};
  for (std::size_t k = 0; k < 3; ++k) {
    padded_force_[k][0] = force[k];
    moments[k] = padded_force_[k].data();
  }
  motion_.begin(from.t, tau, padded_q_.data(), padded_v_.data(), moments.data());
  motion_.find(1.0);
  return motion_of({motion_.q()[0], motion_.v()[0]}, harmonic_force);
}

std::span<const time::EnergyAt> SingleStep::energies(std::span<const double> instants) {
  const auto at = [&](std::size_t knot) {
    const Knot& known = knots_[knot];
    return ModalEnergy::Knot{known.t, &known.at.q, &known.at.v, {phases(knot), harmonics_.size()}};
  };
  energy_.begin(at(0), instants);
  std::vector<Phase> middle_phases(harmonics_.size());
  for (std::size_t knot = 1; knot < knots_.size(); ++knot) {
    // Flights are as long as quintics allow, and the cubics of the energies need half of that.
    const double t = 0.5 * (knots_[knot - 1].t + knots_[knot].t);
    const Motion motion = motion_within(knot - 1, t);
    const Point middle = {motion.x / modal_.shapes()(0, 0), motion.v / modal_.shapes()(0, 0)};
    for (std::size_t j = 0; j < harmonics_.size(); ++j) {
      const double angle = harmonics_[j].angular_frequency * t;
      middle_phases[j] = {std::cos(angle), std::sin(angle)};
    }
    const double w_middle = stop_shape_ * middle.q, w = stop_shape_ * knots_[knot].at.q;
    energy_.go_on({t, &middle.q, &middle.v, middle_phases}, &w_middle, false);
    energy_.go_on(at(knot), &w, knot + 1 == knots_.size());
  }
  return energy_.told();
}

void SingleStep::interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
  if (dofs.empty()) return;
  const auto put = [&](std::size_t place, const Motion& motion) {
    if (!out.x.empty()) out.x[place] = motion.x;
    if (!out.v.empty()) out.v[place] = motion.v;
    if (!out.a.empty()) out.a[place] = motion.a;
  };
  std::size_t knot = 0;
  for (std::size_t i = 0; i < times.size();) {
    while (knot + 2 < knots_.size() && knots_[knot + 1].t <= times[i]) ++knot;
    if (times[i] == knots_[knot].t) {
      put(i++, motion_at(knot));
      continue;
    }
    const double begin = knots_[knot].t, end = knots_[knot + 1].t, h = end - begin;
    if (is_quintic(knot)) {
      const Quintic course(h, motion_at(knot), motion_at(knot + 1));
      for (; i < times.size() && times[i] < end; ++i) {
        const double s = (times[i] - begin) / h;
        put(i, {course.value(s), course.slope(s), course.curvature(s)});
      }
    } else {
      for (; i < times.size() && times[i] < end; ++i) put(i, motion_within(knot, times[i]));
    }
    if (knot + 2 == knots_.size() && i < times.size() && times[i] >= end) put(i++, motion_at(knot + 1));
  }
}

}  // namespace butee::integrators
