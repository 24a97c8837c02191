#include "integrators/exponential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "integrators/local_error.hpp"
#include "integrators/methods.hpp"
#include "integrators/modal_collocation.hpp"

namespace butee::integrators {
namespace {

using dynamics::ModalSystem;
using time::State;
using time::StepReport;
using time::StepStatus;

/// Steps in a block; its knots stay in the cache.
constexpr int kBlock = 32;
/// What the state carries behind the memory of a step: the rung of the ladder, the largest displacement and speed of
/// a stop, whether the last step was a quiet one, without stops within reach, by how many rungs those are longer, and
/// until when the last block was to go, without which it cannot be taken again.
constexpr Index kExtras = 6;
/// After a step with contact that is
constexpr int kQuietRungs = 2;
/// Rungs to go down where a long step without contact came within reach of a stop.
constexpr int kRungsToStop = 3;
/// What outputs between two quiet steps may be wrong by, in tolerances; the steps themselves go on from the exact
/// state.
constexpr double kOutputs = 2.0;
/// Steps so many rungs below the first one may be so short because the motion has just begun: its scales are then
/// those of the first step.
constexpr int kRungsToRest = 10;
/// So many rungs below the first step no step is worth trying.
constexpr int kMostRungsDown = 80;

/// The displacement in the middle of a step may depart from the cubic by this part of the scale. At order 4 that is
/// what the error is made of; at order 2 the error is of a lower power of h. At order 6, which takes the departure into
/// the path, the error falls a little faster than it where stops open and close, and with its power 3/2 elsewhere.
/// Calibrated on beams and oscillators: tests/models/exponential_test.cpp.
/// Below kProportional, where impacts are all that is left of the error, it is proportional to the tolerance.
double middle_tolerance(const ExponentialOptions& options) {
  constexpr double kProportional = 1e-4;
  switch (options.order) {
    case 2:
      return 0.1 * std::pow(options.tolerance, 1.5);
    case 4:
      return 0.03 * options.tolerance;
    default:
      return 0.12 * std::min(std::pow(options.tolerance, 0.8), std::pow(kProportional, -0.2) * options.tolerance);
  }
}

/// The highest rung whose step is shorter than this time.
int rung_below(double time) {
  if (!(time > 0.0)) return std::numeric_limits<int>::min();
  return time < 1e30 ? static_cast<int>(std::floor(2.0 * std::log2(time))) : std::numeric_limits<int>::max();
}

/// Rungs to go down after a step whose error was `ratio` times what it might have been, at the fifth power of h.
int rungs_down(double ratio) {
  constexpr double kPower = 5.0, kMost = 8.0;
  return ratio > 1.0 ? static_cast<int>(std::clamp(std::floor(2.0 / kPower * std::log2(ratio)), 1.0, kMost)) : 1;
}

/// What a truncated basis lacks.
std::string describe_basis(const ModalSystem& modal, Index dofs) {
  std::string text = "exponential with the lowest " + std::to_string(modal.size() - modal.static_count()) + " of " +
                     std::to_string(dofs) + " modes";
  if (modal.static_count() > 0)
    text += " and " + std::to_string(modal.static_count()) + " static shapes: the modes left out hold up to " +
            to_short_text(100.0 * modal.truncation()) +
            " % of what a stop or a load moves itself by; they follow forces slower than " +
            to_short_text(modal.highest_mode()) + " rad/s, and what faster ones lose no tolerance makes good";
  else
    text += ": what the others hold is left out, whatever the tolerance";
  return text + "; give more modes, or another type, where that is too much";
}

}  // namespace

template <class Step>
Exponential<Step>::Exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options)
    : Integrator(dynamics),
      options_(options),
      modal_(dynamics.modal(options.modes)),
      step_(dynamics, modal_, options.order,
            {middle_tolerance(options), kOutputs * options.tolerance, options.tolerance, options.run_time}, kBlock),
      kinks_(dynamics.load_kinks()) {
  first_level_ = find_first_level();
}

template <class Step>
int Exponential<Step>::find_first_level() const {
  if (!step_.has_stops()) return 0;
  const Vector stiffness = dynamics().contact().closed_stiffness();
  double square = 0.0;
  for (Index i = 0; i < modal_.stop_count(); ++i)
    square = std::max(square, stiffness[i] * modal_.stop_shapes().of(i).squaredNorm());
  const double h = std::pow(options_.tolerance, options_.order == 2 ? 0.5 : 0.25) * 4.0 / std::sqrt(square);
  // Nor beyond what shows the slowest motion as one.
  const double lowest = modal_.frequencies().minCoeff();
  const double most = std::min(1.0 / std::sqrt(square), lowest > 0.0 ? 1.0 / lowest : h);
  return static_cast<int>(std::floor(2.0 * std::log2(std::min(h, most))));
}

template <class Step>
double Exponential<Step>::first_step(const State&) const {
  return step_.has_stops() ? kBlock * ModalSystem::ladder_step(first_level_) : std::numeric_limits<double>::infinity();
}

template <class Step>
void Exponential<Step>::do_start(State& state) {
  const Index n = modal_.size();
  state.memory.resize(step_.memory_size() + kExtras);
  modal_.to_modal(state.x, state.memory.head(n));
  modal_.to_modal(state.v, state.memory.segment(n, n));
  step_.complete(state.memory.data());
  StopScale scale;
  if (step_.has_stops()) {
    Vector w(modal_.stop_count()), speed(modal_.stop_count());
    modal_.stop_shapes().displacement(state.memory.data(), w.data());
    modal_.stop_shapes().displacement(state.memory.data() + n, speed.data());
    scale = {w.lpNorm<Eigen::Infinity>(), speed.lpNorm<Eigen::Infinity>()};
  }
  state.memory.tail(kExtras) << static_cast<double>(first_level_), scale.displacement, scale.speed, 0.0,
      static_cast<double>(kQuietRungs), state.t;
  if (modal_.is_complete()) return;
  Vector kept(state.x.size());
  for (const Vector* given : {&state.x, &state.v}) {
    modal_.to_physical(state.memory.data() + (given == &state.v ? n : 0), kept);
    if ((kept - *given).norm() > options_.tolerance * given->norm())
      throw InputError("integrator.modes: " + std::to_string(n) +
                       " modes do not hold the initial displacements and velocities to the tolerance; take more modes");
  }
}

template <class Step>
StepReport Exponential<Step>::do_step(const State& from, const time::Step& step, State& to) {
  StepReport report = follow(from, step.t_end, step.single ? 1 : kBlock, std::numeric_limits<double>::infinity());
  if (report.status != StepStatus::ok) return report;
  to.t = step_.t();
  step_.save(to.memory.data());
  to.memory.tail(kExtras) << static_cast<double>(level_), step_.scale().displacement, step_.scale().speed,
      is_quiet_ ? 1.0 : 0.0, static_cast<double>(quiet_rungs_), step.t_end;
  modal_.to_physical(step_.q(), to.x);
  modal_.to_physical(step_.v(), to.v);
  dynamics().acceleration(to.t, to.x, to.v, to.a);
  report.error =
      step_.has_stops() ? kBlock * ModalSystem::ladder_step(level_) : std::numeric_limits<double>::infinity();
  return report;
}

template <class Step>
StepReport Exponential<Step>::follow(const State& from, double end, int most, double until) {
  const auto extras = from.memory.tail(kExtras);
  begin_t_ = from.t;
  end_t_ = std::numeric_limits<double>::quiet_NaN();
  begin_memory_ = from.memory;
  step_.begin(from.t, from.memory.data(), {extras[1], extras[2]});
  level_ = static_cast<int>(extras[0]);
  is_quiet_ = extras[3] != 0.0;
  quiet_rungs_ = static_cast<int>(extras[4]);
  StepReport report;
  report.inner_steps = 0;
  while (report.inner_steps < most && step_.t() < std::min(end, until)) {
    if (!advance(end, report)) break;
  }
  end_t_ = step_.t();
  return report;
}

template <class Step>
bool Exponential<Step>::advance(double end, StepReport& report) {
  const double t = step_.t(), kink = next_kink(t), last = std::min(end, kink), limit = last - t;
  int rungs = level_ + (is_quiet_ ? quiet_rungs_ : 0);
  // A flight ends before the stop that it leads to: a step beyond it would be tried in vain.
  if (rungs > level_) rungs = std::clamp(rung_below(step_.time_to_stop()), level_, rungs);
  bool expects_motion = false;
  while (true) {
    const double h = ModalSystem::ladder_step(rungs);
    if (!(t + h > t)) {
      report.status = StepStatus::not_finite;
      return false;
    }
    const bool fits = step_.has_stops() && t + h <= last;
    // What is left of a block is shorter than a step: the next block takes it with whole ones.
    if (!fits && kink >= end && report.inner_steps > 0) return false;
    const Trial trial = fits ? step_.attempt_rung(rungs) : step_.attempt_until(last);
    if (trial == Trial::accepted) {
      step_.accept(fits ? t + h : last);
      ++report.inner_steps;
      is_quiet_ = step_.is_quiet();
      if (!is_quiet_) {
        quiet_rungs_ = kQuietRungs;
        if (fits && step_.is_easy()) ++level_;
      } else if (fits) {
        quiet_rungs_ += step_.spare_rungs();
      }
      return true;
    }
    if (trial == Trial::not_finite || rungs <= first_level_ - kMostRungsDown) {
      report.status = StepStatus::not_finite;
      return false;
    }
    ++report.inner_rejected;
    if (step_.is_quiet()) {
      rungs = fits ? rungs - 1 : static_cast<int>(std::ceil(2.0 * std::log2(limit))) - 1;
      quiet_rungs_ = rungs - level_;
    } else if (fits && rungs > level_) {
      rungs = std::max(level_, rungs - kRungsToStop);  // A stop came within reach of a long step.
    } else {
      rungs = (fits ? rungs : static_cast<int>(std::ceil(2.0 * std::log2(limit)))) - rungs_down(step_.error_ratio());
      level_ = std::min(level_, rungs);
      if (!expects_motion && rungs < first_level_ - kRungsToRest) {
        step_.expect_motion(first_level_);
        expects_motion = true;
      }
    }
  }
}

template <class Step>
double Exponential<Step>::next_kink(double t) const {
  const auto next = std::upper_bound(kinks_.begin(), kinks_.end(), t);
  return next == kinks_.end() ? std::numeric_limits<double>::infinity() : *next;
}

template <class Step>
bool Exponential<Step>::holds(const State& from, double t_end) const {
  return from.t == begin_t_ && t_end == end_t_ && from.memory == begin_memory_;
}

template <class Step>
std::span<const double> Exponential<Step>::knots(const State& from, const State& to) const {
  return recall(from, to).knots();
}

template <class Step>
Step& Exponential<Step>::recall(const State& from, const State& to) const {
  // Recomputing a block that is no longer the last changes nothing that anyone could see.
  auto& self = const_cast<Exponential&>(*this);
  if (!holds(from, to.t)) self.follow(from, to.memory.tail(1)[0], kBlock, to.t);
  return self.step_;
}

template <class Step>
std::span<const time::EnergyAt> Exponential<Step>::energies(const State& from, const State& to,
                                                            std::span<const double> instants) const {
  return recall(from, to).energies(instants);
}

template <class Step>
void Exponential<Step>::departure(const State& from, const State& to, double begin, double end,
                                  std::span<const Index> dofs, time::Interpolated out) const {
  if constexpr (std::is_same_v<Step, ExponentialStep>) {
    if (!step_.has_stops()) recall(from, to).departure(begin, end, dofs, out);
  }
}

template <class Step>
void Exponential<Step>::do_interpolate_all(const State& from, const State& to, std::span<const double> times,
                                           std::span<const Index> dofs, time::Interpolated out) const {
  std::size_t first = 0, last = times.size();
  const auto copy = [&](const State& end, std::size_t instant) {
    for (std::size_t i = 0, place = instant * dofs.size(); i < dofs.size(); ++i, ++place) {
      if (!out.x.empty()) out.x[place] = end.x[dofs[i]];
      if (!out.v.empty()) out.v[place] = end.v[dofs[i]];
      if (!out.a.empty()) out.a[place] = end.a[dofs[i]];
    }
  };
  for (; first < last && times[first] == from.t; ++first) copy(from, first);
  for (; last > first && times[last - 1] == to.t; --last) copy(to, last - 1);
  if (first == last) return;
  const auto rest = [&](std::span<double> all) { return all.empty() ? all : all.subspan(first * dofs.size()); };
  recall(from, to).interpolate(times.subspan(first, last - first), dofs, {rest(out.x), rest(out.v), rest(out.a)});
}

template class Exponential<ExponentialStep>;
template class Exponential<SingleStep>;

namespace {

/// Whether modes, stops and loads are those that the method of uncoupled modes takes.
bool is_coupled(const model::System& system) {
  return !system.is_symmetric || system.rotation != nullptr || !system.obstacles.empty() ||
         (system.size() > 1 && system.dashpots.size() > 0);
}

}  // namespace

std::unique_ptr<time::Integrator> make_exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options) {
  if (is_coupled(dynamics.system()))
    return std::make_unique<ModalCollocation>(dynamics, Goal{options.tolerance, options.run_time});
  if (SingleStep::can_take(dynamics)) return std::make_unique<Exponential<SingleStep>>(dynamics, options);
  auto integrator = std::make_unique<Exponential<ExponentialStep>>(dynamics, options);
  const ModalSystem& modal = dynamics.modal(options.modes);
  if (!modal.is_complete()) integrator->set_choice(describe_basis(modal, dynamics.size()));
  return integrator;
}

time::IntegratorType exponential_type() {
  return {.name = "exponential",
          .aliases = {"EXP"},
          .summary = "the linear part exactly, mode by mode; the stops by the projection of their force; adaptive",
          .parameters = {LocalErrorControl::parameter(1e-4, 1e-10),
                         config::integer("order", "2, 4 or 6").at_least(2).at_most(6).or_else(std::int64_t{6}),
                         config::integer(
                             "modes", "the lowest modes to take; 0: all up to 600 DOFs, 300 above, with static shapes")
                             .at_least(0)
                             .or_else(std::int64_t{0})},
          .finds_first_step = true,
          .contacts = time::ContactSupport::without_memory,
          .make = [](const config::Parameters& p, dynamics::Dynamics& dynamics) -> std::unique_ptr<time::Integrator> {
            return make_exponential(dynamics,
                                    {p.number("tolerance"), p.number("end_time"), static_cast<int>(p.integer("order")),
                                     static_cast<Index>(p.integer("modes"))});
          },
          .check =
              [](const config::Parameters& p, config::Diagnostics& diagnostics) {
                if (p.integer("order") % 2 != 0) p.complain(diagnostics, "order", "must be 2, 4 or 6");
              }};
}

}  // namespace butee::integrators
