#include "integrators/local_error.hpp"

#include <algorithm>
#include <cmath>

#include "butee/dynamics/frequencies.hpp"
#include "integrators/fastest_rates.hpp"

namespace butee::integrators {
namespace {

constexpr double kSafety = 0.9, kLeast = 0.2, kMost = 5.0;
/// The exponents of r and r_old are these divided by the order.
constexpr double kProportional = 0.7, kIntegral = 0.4;
/// Lower bound of r_old.
constexpr double kSmallest = 1e-4;
/// Number of grid indices per factor of two. The step size grows only if the estimate allows
/// kReserve indices or more.
constexpr double kStepsPerDoubling = 4.0;
constexpr double kReserve = 3.0;
constexpr double kMostDown = 9.0, kMostUp = 9.0;
/// The error of a very short step of a method that treats the linear part exactly is that of a force whose slope is
/// infinite or of unfinished iterations, which does not fall with the power of h of a smooth motion: such steps grow by
/// kGrowth indices if they turn the fastest motion by less than kTiny rad and their error is below kSlack of its bound.
constexpr double kGrowth = 2.0, kTiny = 0.5, kSlack = 0.5;
/// The error assigned to a step that missed a contact: the step is repeated, on the grid with about
/// half its length.
constexpr double kMissed = 8.0;
/// Steps on the grid exceed a limit to which they are shortened by rounding.
constexpr double kOnGrid = 1.0 + 1e-6;
/// The first step turns the fastest motion by the smaller of kFirstTurn and kFirstOfTolerance tolerance^(1/p) (chosen):
/// at a start from rest under a constant force the estimate of an odd order vanishes.
constexpr double kFirstTurn = 0.1, kFirstOfTolerance = 4.0;
/// The part of the displacement reached within 1/omega to which errors are relative at a start from rest: velocities
/// grow as t, displacements as t^2. The guaranteed error is relative to at least a thousandth of the largest of the
/// run.
constexpr double kFromRest = 0.02;
/// The fraction of the account's balance that a step without a change of contact may use in
/// addition to its own share. This is needed at starts from rest, where scales are still small.
constexpr double kSpendOnSmooth = 0.01;
/// The error of the velocity as a fraction of the impulse of a force that jumps within the step.
constexpr double kOfJump = 0.1;
/// The departure of a motion in the middle of a step from the cubic through its ends, as a part of that of h^2 times
/// the acceleration at the start: 12/384, as for contacts on the way.
constexpr double kOfAcceleration = 1.0 / 32.0, kMostUnseen = 0.05;
/// The displacement within a step, interpolated with a velocity of 1/h at one end: the maximum of s^2 (1 - s).
constexpr double kOfVelocity = 4.0 / 27.0;
/// The slope of the quintic with a displacement of 1 at one end, times h: the maximum of 30 s^2 (1 - s)^2. Errors of
/// velocities in outputs within a step may be kInOutputs tolerances large (chosen).
constexpr double kOfDisplacement = 15.0 / 8.0, kInOutputs = 1.0;
/// The estimate of a stiff step may reach this fraction of the tolerance.
constexpr double kMostStiff = 0.5;
/// Friction jumps in a step that changes the slip by more than this multiple of the slip speed of a smooth law.
constexpr double kReversal = 2.0;
/// Errors below kNearRounding may be rounding; those below kQuiet times their bound let the step grow at any rate.
constexpr double kNearRounding = 1e-14, kQuiet = 1e-3;
/// What exceeds the bound of rounding by this factor is no rounding (chosen).
constexpr double kBeyondRounding = 100.0;
/// Errors below kStillError times the displacements (rate_ times these) are rounding in a structure that rests. A
/// control of them would follow vibrations of rounding at the highest frequency.
constexpr double kStillError = 1e-12;
/// The part of the longest stable step that explicit methods take at rest (chosen).
constexpr double kStableAtRest = 0.8;
/// If a stop closes or opens in a step, the error falls with this power of h.
constexpr double kKinkOrder = 2.0;
/// A contact begins or ends with a step if its penetration there is below this fraction of that at
/// the other end.
constexpr double kTouches = 1e-3;

}  // namespace

LocalErrorControl::LocalErrorControl(dynamics::Dynamics& dynamics, const Goal& goal, Orders orders, Steps steps)
    : dynamics_(dynamics),
      stops_(dynamics.stops()),
      obstacles_(dynamics.obstacles()),
      contact_(dynamics, goal.tolerance),
      centre_(dynamics),
      account_(goal),
      orders_(orders),
      power_(orders.estimate / (orders.method + 1.0)),
      steps_(steps),
      scales_(dynamics.system()),
      discontinuities_(dynamics.load_discontinuities()),
      whole_(orders.share * std::pow(goal.tolerance, orders.estimate / orders.method)),
      tolerance_(goal.tolerance),
      output_time_(orders.has_quintic_outputs ? kInOutputs * goal.tolerance / (kOfDisplacement * account_.rate())
                                              : std::numeric_limits<double>::infinity()),
      as_a_whole_(goal.as_a_whole || dynamics.size() > kLargest),
      scale_x_(dynamics.size()),
      scale_v_(dynamics.size()),
      work_(dynamics.size()) {
  const model::System& system = dynamics.system();
  const FastestRates rates = fastest_rates(dynamics);
  const double first_turn = std::min(kFirstTurn, kFirstOfTolerance * std::pow(goal.tolerance, 1.0 / orders.method));
  first_step_ = rates.open > 0.0 ? first_turn / rates.open : 1e-6 * std::min(1.0, goal.run_time);
  omega_ = rates.closed;
  rate_ = fastest_ = rates.any();
  if (!as_a_whole_) rounding_.emplace(dynamics, goal.tolerance, rate_);
  for (const model::FreeLoad& load : system.loads)
    if (const auto harmonic = load.in_time->harmonic(); harmonic && harmonic->angular_frequency > 0.0) {
      first_step_ = std::min(first_step_, first_turn / harmonic->angular_frequency);
      fastest_ = std::max(fastest_, harmonic->angular_frequency);
    }
  first_step_ = std::min(first_step_, first_turn * goal.run_time);
  fastest_ = std::max(fastest_, 1.0 / goal.run_time);
  for (Index i = 0; i < dynamics.stops().size(); ++i)
    if (const double border = inner_border(dynamics.stops().law_of(i)); border > 0.0)
      inner_borders_.emplace_back(i, border);
  for (Index i = 0; obstacles_ != nullptr && i < obstacles_->size(); ++i)
    if (const auto& law = obstacles_->group_of(i).law; law != nullptr && inner_border(*law) > 0.0)
      inner_borders_of_obstacles_.emplace_back(i, inner_border(*law));
  if (std::isfinite(orders.damping)) longest_ = orders.damping / bound_of_damping(system);
}

bool LocalErrorControl::touches_anew(const time::State& from, const time::State& to) const {
  if (obstacles_ == nullptr) return false;
  for (Index i = 0; i < obstacles_->size(); ++i) {
    const model::ContactLaw* law = obstacles_->group_of(i).law.get();
    if (law == nullptr || law->is_piecewise_linear() || !obstacles_->phase(i).touches()) continue;
    const double begin = obstacles_->forces(i, from.t, from.x, from.v).penetration,
                 end = obstacles_->forces(i, to.t, to.x, to.v).penetration;
    if (std::min(begin, end) < kTouches * std::max(begin, end)) return true;
  }
  return false;
}

bool LocalErrorControl::passes_inner_border(const time::State& from, const time::State& to) const {
  const auto passes = [](double border, double begin, double end) { return (begin - border) * (end - border) < 0.0; };
  for (const auto& [i, border] : inner_borders_) {
    const auto penetration = [&stops = stops_, i = i](const Vector& x) {
      const Index a = stops.dof_a(i), b = stops.dof_b(i);
      const double w = (a >= 0 ? x[a] : 0.0) - (b >= 0 ? x[b] : 0.0);
      return std::max(w - stops.play_of(i).upper(), stops.play_of(i).lower() - w);
    };
    if (passes(border, penetration(from.x), penetration(to.x))) return true;
  }
  for (const auto& [i, border] : inner_borders_of_obstacles_)
    if (obstacles_->phase(i).touches() && passes(border, obstacles_->forces(i, from.t, from.x, from.v).penetration,
                                                 obstacles_->forces(i, to.t, to.x, to.v).penetration))
      return true;
  return false;
}

double LocalErrorControl::longest_of_impact(const time::State& from, double h, const Vector& scale_v) {
  double longest = contact_.longest_of_impact(from, h, scale_v);
  if (obstacles_ == nullptr) return longest;
  work_ = from.x + h * from.v;
  const auto has_just_closed = [&](Index i) {
    if (!obstacles_->phase(i).touches()) return false;
    const double depth = obstacles_->forces(i, from.t, work_, from.v).penetration;
    return depth > 0.0 &&
           obstacles_->forces(i, from.t, from.x, from.v).penetration < ContactOnTheWay::kJustClosed * depth;
  };
  bool has_any = false;
  for (Index i = 0; i < obstacles_->size() && !has_any; ++i) has_any = has_just_closed(i);
  if (!has_any) return longest;
  const SparseMatrix& mass = dynamics_.system().mass;
  for (const dynamics::Obstacles::Tangent& tangent : obstacles_->tangents(from.t, work_, from.v)) {
    if (!has_just_closed(tangent.contact)) continue;
    obstacles_->visit(tangent.contact, tangent.stiffness, [&](Index i, Index j, double value) {
      if (i == j && value > 0.0 && std::abs(from.v[i]) > tolerance_ * scale_v[i])
        longest = std::min(longest, ContactOnTheWay::kMostTurn * std::sqrt(mass.coeff(i, i) / value));
    });
  }
  return longest;
}

bool LocalErrorControl::slip_reverses(const time::State& from, const time::State& to) const {
  if (obstacles_ == nullptr) return false;
  for (Index i = 0; i < obstacles_->size(); ++i) {
    const model::Friction& friction = obstacles_->group_of(i).friction;
    const bool is_smooth = friction.rule == model::Friction::Rule::tanh || friction.rule == model::Friction::Rule::sqrt;
    if (!is_smooth || !obstacles_->phase(i).touches()) continue;
    const double begin = obstacles_->forces(i, from.t, from.x, from.v).slip_speed,
                 end = obstacles_->forces(i, to.t, to.x, to.v).slip_speed;
    if (begin * end < 0.0 && std::abs(end - begin) > kReversal * friction.slip_speed) return true;
  }
  return false;
}

void LocalErrorControl::start(time::State& state) {
  const Index n = state.x.size();
  state.memory.head(memory_size(n)).setZero();
  state.memory[kOld] = 1.0;
  state.memory[kAccount] = account_.advance();
  state.memory[kNormX] = norm(state.x);
  state.memory[kNormV] = norm(state.v);
  scales_.raise(state.x, state.memory.segment(kScales, n));
  scales_.largest_of_kind(state.memory.segment(kScales, n), work_);
  work_ *= kStill * rate_;
  scales_.raise(work_, state.memory.segment(kScales + n, n));
  scales_.raise(state.v, state.memory.segment(kScales + n, n));
}

double LocalErrorControl::smooth_error(double h) const {
  if (as_a_whole_) return whole_;
  const double smooth = std::pow(account_.rate() * h / orders_.constant, power_);
  return h * rate_ > kStiff ? std::min(smooth, kMostStiff * tolerance_) : smooth;
}

double LocalErrorControl::relative_error(double h, ConstVectorRef error_x, ConstVectorRef error_v,
                                         const Vector& scale_x, const Vector& scale_v) {
  double largest = 0.0;
  const auto look = [&largest](ConstVectorRef error, const Vector& scale, double factor) {
    for (Index i = 0; i < error.size(); ++i)
      if (error[i] != 0.0) {
        const double part = factor * std::abs(error[i]) / scale[i];
        if (!(part <= largest)) largest = part;
        if (std::isnan(largest)) return;
      }
  };
  look(error_x, scale_x, 1.0);
  if (!std::isnan(largest)) look(error_v, scale_v, 1.0);
  if (!std::isnan(largest)) look(error_v, scale_x, kOfVelocity * h);
  return largest;
}

double LocalErrorControl::output_error(ConstVectorRef error_x, const Vector& scale_x) const {
  double largest = 0.0;
  for (Index i = 0; i < output_v_.size(); ++i)
    if (const double error = std::abs(error_x[i]); error > kNearRounding * scale_x[i] && output_v_[i] > 0.0)
      largest = std::max(largest, error / (output_time_ * output_v_[i]));
  return largest;
}

double LocalErrorControl::unseen_start(const time::State& from, const time::State& to, double h,
                                       const Vector& scale_x) {
  work_ = (h * h) * from.a - 6.0 * (to.x - from.x) + h * (4.0 * from.v + 2.0 * to.v);
  double largest = 0.0;
  for (Index i = 0; i < work_.size(); ++i)
    if (scale_x[i] > 0.0) largest = std::max(largest, kOfAcceleration * std::abs(work_[i]) / scale_x[i]);
  return largest;
}

bool LocalErrorControl::is_still(const time::State& state) {
  if (as_a_whole_) return state.memory[kNormV] <= kStill * rate_ * state.memory[kNormX];
  const auto x = scales_x(state), v = scales_v(state);
  if (v.maxCoeff() > kStill * rate_ * x.maxCoeff()) return false;
  scales_.largest_of_kind(x, work_);
  return (v.array() <= kStill * rate_ * work_.array()).all();
}

bool LocalErrorControl::rests(const time::State& to, ConstVectorRef error_x, ConstVectorRef error_v) {
  if (rate_ == 0.0 || !is_still(to)) return false;
  if (as_a_whole_)
    return norm(error_x) <= kStillError * to.memory[kNormX] && norm(error_v) <= kStillError * rate_ * to.memory[kNormX];
  return (error_x.array().abs() <= kStillError * work_.array()).all() &&
         (error_v.array().abs() <= kStillError * rate_ * work_.array()).all();
}

double LocalErrorControl::longest_stable() {
  if (std::isinf(orders_.stable_turn)) return std::numeric_limits<double>::infinity();
  if (longest_stable_) return *longest_stable_;
  const model::System& system = dynamics_.system();
  SparseMatrix damping =
      system.damping.mass_proportional * system.mass + system.damping.stiffness_proportional * system.stiffness;
  if (system.dashpots.size() > 0) damping += system.dashpots;
  const auto range = dynamics::frequency_range(system, dynamics::StopState::closed);
  const double decay = dynamics::fastest_decay(damping, system.mass).value_or(0.0);
  const double by_turn = range && range->highest > 0.0 ? orders_.stable_turn / range->highest : longest_,
               by_decay = decay > 0.0 ? orders_.stable_decay / decay : longest_;
  longest_stable_ = std::min(by_turn, by_decay);
  return *longest_stable_;
}

double LocalErrorControl::norm(ConstVectorRef y) {
  dynamics_.inertia_force(y, work_);
  return std::sqrt(std::max(0.0, y.dot(work_)));
}

double LocalErrorControl::whole_error(const time::State& from, time::State& to, double h, ConstVectorRef error_x,
                                      ConstVectorRef error_v, double smooth) {
  const double x = std::max(from.memory[kNormX], norm(to.x)), v = std::max(from.memory[kNormV], norm(to.v));
  to.memory[kNormX] = x;
  to.memory[kNormV] = v;
  const double of_x = norm(error_x), of_v = norm(error_v);
  const auto part = [](double error, double scale) { return error > 0.0 ? error / scale : 0.0; };
  const double epsilon = std::max(part(of_x, x), part(of_v, v));
  if (!(epsilon > smooth) || rate_ == 0.0) return epsilon;
  // At a start from rest, as for components in judge().
  scale_x_ = (to.v - from.v) / h;
  const double speed = std::max({v, norm(from.a) / fastest_, norm(scale_x_) / fastest_});
  return std::max(part(of_x, std::max(x, speed / fastest_)), part(of_v, speed));
}

void LocalErrorControl::judge(const time::State& from, time::State& to, double h, ConstVectorRef error_x,
                              ConstVectorRef error_v, time::StepReport& report) {
  const Index n = to.x.size();
  scale_x_ = scales_x(from);
  scale_v_ = scales_v(from);
  scales_.raise(to.x, scale_x_);
  scales_.raise(to.v, scale_v_);
  to.memory.segment(kNormX, 2) = from.memory.segment(kNormX, 2);
  to.memory.segment(kScales, n) = scale_x_;
  to.memory.segment(kScales + n, n) = scale_v_;
  if (!as_a_whole_ && std::isfinite(output_time_)) output_v_ = scale_v_;
  const double smooth = smooth_error(h);
  const double balance = from.memory[kAccount] + account_.rate() * h;
  const auto error_relative_to = [&](const Vector& scale_x, const Vector& scale_v) {
    return std::max(relative_error(h, error_x, error_v, scale_x, scale_v), output_error(error_x, scale_x));
  };
  double epsilon =
      as_a_whole_ ? whole_error(from, to, h, error_x, error_v, smooth) : error_relative_to(scale_x_, scale_v_);
  if (rests(to, error_x, error_v)) {
    to.memory[kOld] = kSmallest;
    to.memory[kAccount] = balance;
    report.error = kSmallest;
    report.proposal =
        std::min(kStableAtRest * longest_stable(),
                 steps_ == Steps::any ? any_step(h, 0.0, 1.0, orders_.method) : grid_step(h, 0.0, orders_.estimate));
    return;
  }
  if (!as_a_whole_ && epsilon > smooth && rate_ > 0.0) {
    // At a start from rest errors are relative to the velocities that the accelerations cause within 1/fastest_, or
    // until a load's slope jumps, and to a part of the displacements that these velocities cause within 1/fastest_.
    const auto jump = std::upper_bound(discontinuities_.begin(), discontinuities_.end(), from.t);
    const double time = jump == discontinuities_.end() ? 1.0 / fastest_ : std::min(1.0 / fastest_, *jump - from.t);
    work_ = time * from.a.cwiseAbs().cwiseMax(to.a.cwiseAbs()).cwiseMax((to.v - from.v).cwiseAbs() / h);
    scales_.raise(work_, scale_v_);
    work_ = (kFromRest / fastest_) * scale_v_;
    scales_.raise(work_, scale_x_);
    if (output_v_.size() > 0) output_v_ = output_v_.cwiseMax(kFromRest * scale_v_);
    epsilon = error_relative_to(scale_x_, scale_v_);
  }
  const Change change = change_of_contact(from, to, h);
  double charge = 0.0;
  double r = error_ratio(from, to, h, epsilon, change, scale_x_, charge);
  const auto allow_rounding = [&](double bound) {
    level_x_ = scale_x_;
    level_v_ = scale_v_;
    rounding_->raise(from, to, h, longest_stable(), bound, level_x_, level_v_);
    if (output_v_.size() > 0) output_v_ = (level_v_.array() > scale_v_.array()).select(level_v_, output_v_);
    epsilon = error_relative_to(level_x_, level_v_);
    if (epsilon > kBeyondRounding * bound) {
      excess_x_ = (error_x.cwiseAbs() - kBeyondRounding * bound * level_x_).cwiseMax(0.0);
      excess_v_ = (error_v.cwiseAbs() - kBeyondRounding * bound * level_v_).cwiseMax(0.0);
      epsilon = std::max(epsilon, relative_error(h, excess_x_, excess_v_, scale_x_, scale_v_));
    }
    r = error_ratio(from, to, h, epsilon, change, level_x_, charge);
  };
  // Nor does the account pay for rounding.
  if (rounding_ && (r > 1.0 || (!change.has_changed && epsilon > smooth)))
    allow_rounding(change.has_changed ? ErrorAccount::kSpend * balance / orders_.contact_change : smooth);
  // Rounding does not fall with the step, and must not keep it short either: rounding of velocities falls with h, the
  // bound nearly so, and accepted steps would shrink by orders of magnitude.
  // Steps of a method that treats the linear part exactly would stay as short as a change of contact made them.
  const auto shrinks = [&] {
    if (h * rate_ >= kTiny) return false;
    return steps_ == Steps::any ? any_step(h, r, from.memory[kOld], power_ * orders_.method) < h
                                : orders_.is_linear_part_exact;
  };
  if (rounding_ && !change.has_changed && r <= 1.0 && r > kQuiet && (epsilon < kNearRounding || shrinks()))
    allow_rounding(kQuiet * smooth);
  to.memory[kOld] = std::max(epsilon / smooth, kSmallest);
  to.memory[kAccount] = balance - charge;
  if (!std::isfinite(r)) {
    report.status = time::StepStatus::not_finite;
    return;
  }
  const bool is_unstable = r <= 1.0 && change.has_changed && h * omega_ > orders_.stability;
  if (r <= 1.0 && (is_unstable || contact_.was_missed(from, to, h, scale_v_))) {
    report.error = kMissed;
    report.proposal = steps_ == Steps::any ? 0.5 * h : grid_step(h, kMissed, orders_.estimate);
    return;
  }
  if (const double longest = r <= 1.0 && !orders_.is_linear_part_exact ? longest_of_impact(from, h, scale_v_) : h;
      h > kOnGrid * longest) {
    report.error = kMissed;
    report.proposal = steps_ == Steps::any ? longest : longer_step(longest, 0.0);
    return;
  }
  report.error = r;
  const double order = change.has_changed && r > 1.0 ? kKinkOrder : power_ * orders_.method;
  const double next = change.has_changed && r <= 1.0 ? to.memory[kOld] : r;
  report.proposal = steps_ == Steps::any ? any_step(h, next, from.memory[kOld], order) : grid_step(h, next, order);
  if (orders_.is_linear_part_exact && r <= kSlack && h * rate_ < kTiny)
    report.proposal = std::max(report.proposal, longer_step(h, kGrowth));
  report.proposal = std::min(report.proposal, longest_);
}

LocalErrorControl::Change LocalErrorControl::change_of_contact(const time::State& from, const time::State& to,
                                                               double h) {
  const double crossing = centre_.jump(from, to, h, scale_v_);
  Change change;
  change.has_changed = contact_.changed(from, to, h, scale_v_) || touches_anew(from, to) ||
                       passes_inner_border(from, to) || slip_reverses(from, to) ||
                       h * crossing > ContactOnTheWay::kNegligibleImpulse * smooth_error(h);
  if (as_a_whole_ || !change.has_changed) return change;
  change.least = kOfJump * h * std::max(contact_.jump(from, to, h, scale_v_), crossing);
  if (orders_.kink > 0.0)
    change.least = std::max(change.least, orders_.kink * h * h * contact_.kink(from, to, scale_v_));
  return change;
}

double LocalErrorControl::error_ratio(const time::State& from, const time::State& to, double h, double epsilon,
                                      const Change& change, const Vector& scale_x, double& charge) {
  const double smooth = smooth_error(h), balance = from.memory[kAccount] + account_.rate() * h;
  double r = epsilon / smooth;
  charge = 0.0;
  if (as_a_whole_) return change.has_changed ? orders_.contact_change * r : r;
  if (change.has_changed) {
    charge = std::max(orders_.contact_change * epsilon, change.least);
    r = charge / (ErrorAccount::kSpend * balance);
  } else if (const bool is_fast = contact_.is_fast_at_bend(); r > 1.0 || (is_fast && epsilon > account_.rate() * h)) {
    charge = orders_.constant * std::pow(epsilon, 1.0 / power_);
    if (is_fast) {
      charge = std::max(charge, epsilon);
      r = std::max(r, epsilon / (account_.rate() * h));
    }
    r = std::min(r, charge / (kSpendOnSmooth * balance));
  }
  if (orders_.is_linear_part_exact) return r;
  // The departure grows with h^2.
  const double unseen = unseen_start(from, to, h, scale_x);
  return unseen > kMostUnseen ? std::max(r, std::pow(unseen / kMostUnseen, 0.5 * power_ * orders_.method)) : r;
}

double LocalErrorControl::any_step(double h, double r, double old, double order) const {
  const double careful = std::max(r, kSmallest);
  if (r > 1.0) return h * std::clamp(kSafety * std::pow(careful, -1.0 / order), kLeast, kSafety);
  return h * std::clamp(kSafety * std::pow(careful, -kProportional / order) * std::pow(old, kIntegral / order), kLeast,
                        kMost);
}

double LocalErrorControl::grid_step(double h, double r, double order) const {
  const double shift = std::log2(kSafety / std::max(r, kSmallest)) * kStepsPerDoubling / order;
  if (r <= 1.0 && shift < kReserve) return h;
  return longer_step(h, std::clamp(shift - (r <= 1.0 ? kReserve - 1.0 : 0.0), -kMostDown, kMostUp));
}

double LocalErrorControl::longer_step(double h, double indices) {
  return std::exp2(std::floor(kStepsPerDoubling * std::log2(h) + indices + 1e-6) / kStepsPerDoubling);
}

config::Parameter LocalErrorControl::parameter(double fallback, double smallest) {
  return config::number("tolerance", "1",
                        "largest relative error of a displacement, rotation or velocity, see `butee help methods`")
      .at_least(smallest)
      .at_most(kLargestTolerance)
      .or_else(fallback)
      .sweep(1e-1, std::max(smallest, 1e-9));
}

}  // namespace butee::integrators
