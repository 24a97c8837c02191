#include "integrators/exponential/exponential.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "butee/core/error.hpp"
#include "butee/time/departure.hpp"
#include "integrators/exponential/contact_scales.hpp"
#include "integrators/local_error.hpp"

namespace butee::integrators {
namespace {

using dynamics::ModalSystem;
using time::State;
using time::StepReport;
using time::StepStatus;

/// Number of entries at the end of the state: the index of the step size; the largest displacement
/// and speed of a stop; 1 if the last step had no contact; the number of indices by which steps
/// without contact are longer; and the end time that the last macro step was given, which is needed
/// to repeat it.
constexpr Index kExtras = 6;
/// Allowed error of outputs within a step without contact, in tolerances. The next step starts from
/// the exact state.
constexpr double kOutputs = 2.0;
/// Without stops a step ends where the fastest motion that matters has turned by this angle, rad: searches for peaks
/// examine every period, and a run can be interrupted between steps.
constexpr double kMostTurn = 4e3;

/// The bound of a path's departure from the cubic in the middle of a step, relative to the
/// displacement scale. The path contains the departure, and the error falls with its power 3/2 in
/// smooth motion and with its power 1 where stops open and close. Below
/// kProportional only impacts contribute to the error, and the bound is proportional to the
/// tolerance. Calibrated on beams and oscillators: tests/models/exponential_test.cpp.
double middle_tolerance(double tolerance) {
  constexpr double kMiddle = 0.12, kProportional = 1e-4;
  return kMiddle * std::min(std::pow(tolerance, 0.8), std::pow(kProportional, -0.2) * tolerance);
}

StepGoal step_goal(const ExponentialOptions& options) {
  return {middle_tolerance(options.tolerance), kOutputs * options.tolerance, options.tolerance, options.run_time};
}

void put_extras(State& state, const StepSizeControl::Memory& sizes, ContactScale scale, double end) {
  state.memory.tail(kExtras) << sizes.index, scale.displacement, scale.speed, sizes.is_contact_free, sizes.longer, end;
}

/// The scales of stops that do not move yet: a thousandth of the largest displacement and speed of their kind, or of
/// the root mean square of the modes' motion at the stops, which is a lower bound of the largest one in a run. A mode
/// of frequency omega moves at (v^2 + (a/omega)^2)^(1/2) after a start with the speed v and the acceleration a. Stops
/// may confine the motion to the smallest gap and to that of the frequency `closed` of a closed stop, rad/s.
ContactScale least_scale(dynamics::Dynamics& dynamics, const ModalSystem& modal, const State& state, double run_time,
                         double closed) {
  const ComponentScales scales(dynamics.system());
  Vector of_x(dynamics.size()), of_v(dynamics.size());
  scales.largest_of_kind(state.x.cwiseAbs(), of_x);
  scales.largest_of_kind(state.v.cwiseAbs(), of_v);
  Vector v(modal.size()), a(modal.size());
  modal.to_modal(state.v, v);
  modal.to_modal(state.a, a);
  const Eigen::ArrayXd time = modal.frequencies().inverse().min(run_time),
                       speed = (v.array().square() + (a.array() * time.min(1.0 / closed)).square()).sqrt(),
                       displacement = speed * time;
  const auto mean = [&modal](Index dof, const Eigen::ArrayXd& amplitude) {
    return std::sqrt(0.5) * (modal.shape_rows().col(dof).array() * amplitude).matrix().norm();
  };
  const dynamics::ElasticStops& stops = dynamics.stops();
  double gap = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < stops.size(); ++i) gap = std::min(gap, stops.play_of(i).gap);
  ContactScale least;
  for (Index i = 0; i < stops.size(); ++i)
    for (const Index dof : {stops.dof_a(i), stops.dof_b(i)})
      if (dof >= 0) {
        const double speed_there = mean(dof, speed), confined = std::max(0.0, gap) + speed_there / closed;
        least = {std::max({least.displacement, of_x[dof], std::min(confined, mean(dof, displacement))}),
                 std::max({least.speed, of_v[dof], speed_there})};
      }
  return {ContactScales::kFloor * least.displacement, ContactScales::kFloor * least.speed};
}

}  // namespace

template <class Step>
Exponential<Step>::Exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options)
    : Integrator(dynamics),
      options_(options),
      modal_(dynamics.modal(options.modes)),
      load_kinks_(dynamics.load_discontinuities()),
      step_(dynamics, modal_, step_goal(options), kMacroStep),
      sizes_(first_index()) {}

template <class Step>
double Exponential<Step>::longest_without_stops(const State& from, double wanted) const {
  const Eigen::ArrayXd &omega = modal_.frequencies(), &delta = modal_.decay();
  double fastest = 0.0;
  for (const dynamics::ModalHarmonic& load : modal_.harmonics())
    fastest = std::max(fastest, std::abs(load.angular_frequency));
  if (std::max(fastest, omega.maxCoeff()) * wanted <= kMostTurn) return wanted;
  // The speeds of free motion, and of that which harmonic loads start.
  const Index n = modal_.size();
  const auto q = from.memory.head(n).array(), v = from.memory.segment(n, n).array();
  Eigen::ArrayXd speed = -omega.square() * q - 2.0 * delta * v;
  modal_.add_load(from.t, speed);
  speed = (omega > 0.0).select((v.square() + (speed / omega).square()).sqrt(), v.abs());
  for (const dynamics::ModalHarmonic& load : modal_.harmonics()) {
    const double turn = std::abs(load.angular_frequency);
    if (turn > 0.0) speed += (load.cosine.abs() + load.sine.abs()) * turn / omega.max(turn).square();
  }
  const double least = options_.tolerance * speed.maxCoeff();
  for (Index k = 0; k < n; ++k)
    if (speed[k] > least && delta[k] < omega[k]) fastest = std::max(fastest, omega[k]);
  return fastest * wanted > kMostTurn ? kMostTurn / fastest : wanted;
}

template <class Step>
int Exponential<Step>::first_index() const {
  if (!step_.has_stops()) return 0;
  const double frequency = contact_frequency(modal_, dynamics().stops()),
               h = std::pow(options_.tolerance, 0.25) * 4.0 / frequency;
  // At most the time scale of the slowest motion.
  const double lowest = modal_.frequencies().minCoeff();
  const double most = std::min(1.0 / frequency, lowest > 0.0 ? 1.0 / lowest : h);
  return static_cast<int>(std::floor(2.0 * std::log2(std::min(h, most))));
}

template <class Step>
double Exponential<Step>::first_step(const State&) const {
  return step_.has_stops() ? kMacroStep * ModalSystem::grid_step(sizes_.first())
                           : std::numeric_limits<double>::infinity();
}

template <class Step>
void Exponential<Step>::do_start(State& state) {
  const Index n = modal_.size();
  state.memory.resize(step_.memory_size() + kExtras);
  modal_.to_modal(state.x, state.memory.head(n));
  modal_.to_modal(state.v, state.memory.segment(n, n));
  step_.complete(state.t, state.memory.data());
  ContactScale scale;
  if (step_.has_stops()) {
    Vector w(modal_.stop_count()), speed(modal_.stop_count());
    modal_.stop_shapes().displacement(state.memory.data(), w.data());
    modal_.stop_shapes().displacement(state.memory.data() + n, speed.data());
    const double closed = contact_frequency(modal_, dynamics().stops());
    const ContactScale floor = least_scale(dynamics(), modal_, state, options_.run_time, closed);
    scale = {std::max(floor.displacement, w.lpNorm<Eigen::Infinity>()),
             std::max(floor.speed, speed.lpNorm<Eigen::Infinity>())};
    scale.speed = std::max(scale.speed, ContactScales::kLeastSpeed * closed * scale.displacement);
  }
  put_extras(state, sizes_.start(), scale, state.t);
  if (modal_.is_complete()) return;
  Vector kept(state.x.size());
  for (const Vector* given : {&state.x, &state.v}) {
    modal_.to_physical(state.memory.data() + (given == &state.v ? n : 0), kept);
    if ((kept - *given).norm() > options_.tolerance * given->norm())
      throw InputError(
          "integrator.modes: " + std::to_string(n) +
          " modes do not represent the initial displacements and velocities within the tolerance; take more modes");
  }
}

template <class Step>
StepReport Exponential<Step>::do_step(const State& from, const time::Step& step, State& to) {
  StepReport report = follow(from, step.t_end, step.single ? 1 : kMacroStep, std::numeric_limits<double>::infinity());
  if (report.status != StepStatus::ok) return report;
  to.t = step_.t();
  step_.save(to.memory.data());
  put_extras(to, sizes_.save(), step_.scale(), step.t_end);
  modal_.to_physical(step_.q(), to.x);
  modal_.to_physical(step_.v(), to.v);
  if constexpr (std::is_same_v<Step, ExponentialStep>)
    if (step_.rests_in_middle() && std::binary_search(load_kinks_.begin(), load_kinks_.end(), to.t)) leave_middle(to);
  dynamics().acceleration(to.t, to.x, to.v, to.a);
  report.error = step_.has_stops() ? kMacroStep * ModalSystem::grid_step(sizes_.contact_index())
                                   : std::numeric_limits<double>::infinity();
  return report;
}

template <class Step>
void Exponential<Step>::leave_middle(State& state) const {
  if constexpr (std::is_same_v<Step, ExponentialStep>) {
    const Vector before = state.x;
    if (!time::leave_middle(dynamics(), state)) return;
    Vector q(modal_.size());
    modal_.to_modal(state.x - before, q);
    state.memory.head(modal_.size()) += q;
    step_.find_stops(state.memory.data());
  }
}

template <class Step>
StepReport Exponential<Step>::follow(const State& from, double end, int most, double until) {
  const auto extras = from.memory.tail(kExtras);
  begin_t_ = from.t;
  end_t_ = std::numeric_limits<double>::quiet_NaN();
  begin_memory_ = from.memory;
  step_.begin(from.t, from.memory.data(), {extras[1], extras[2]});
  sizes_.load({extras[0], extras[3], extras[4]});
  if constexpr (std::is_same_v<Step, ExponentialStep>) {
    // A load that begins drives it out of the middle.
    if (step_.rests_in_middle()) end = std::min(end, next_load_discontinuity(from.t));
  }
  if (!step_.has_stops()) end = std::min(end, from.t + longest_without_stops(from, end - from.t));
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
  const double t = step_.t(), jump = next_load_discontinuity(t), last = std::min(end, jump);
  int index = sizes_.next_index();
  // A step without contact ends before the next contact, since a longer attempt would be rejected.
  if (index > sizes_.contact_index()) index = sizes_.next_index(step_.time_to_contact());
  bool expects_motion = false;
  while (true) {
    const double h = ModalSystem::grid_step(index);
    if (!(t + h > t)) {
      report.status = StepStatus::not_finite;
      return false;
    }
    const bool fits = step_.has_stops() && t + h <= last;
    // If no whole step fits into the rest of a macro step, the next macro step covers it with whole
    // steps.
    if (!fits && jump >= end && report.inner_steps > 0) return false;
    const Trial trial = fits ? step_.attempt_index(index) : step_.attempt_until(last);
    const StepSizeControl::Outcome outcome = step_.outcome();
    if (trial == Trial::accepted) {
      step_.accept(fits ? t + h : last);
      ++report.inner_steps;
      sizes_.accept(outcome, fits);
      return true;
    }
    if (trial == Trial::not_finite || sizes_.is_shortest(index)) {
      report.status = StepStatus::not_finite;
      return false;
    }
    ++report.inner_rejected;
    const StepSizeControl::Retry retry = sizes_.reject(outcome, index, fits, last - t);
    index = retry.index;
    if (retry.was_contact && !expects_motion && sizes_.is_start_from_rest(index)) {
      step_.expect_motion(sizes_.first());
      expects_motion = true;
    }
  }
}

template <class Step>
double Exponential<Step>::next_load_discontinuity(double t) const {
  const auto next = std::upper_bound(load_kinks_.begin(), load_kinks_.end(), t);
  return next == load_kinks_.end() ? std::numeric_limits<double>::infinity() : *next;
}

template <class Step>
bool Exponential<Step>::holds(const State& from, double t_end) const {
  return from.t == begin_t_ && t_end == end_t_ && from.memory.size() == begin_memory_.size() &&
         std::memcmp(from.memory.data(), begin_memory_.data(),
                     static_cast<std::size_t>(begin_memory_.size()) * sizeof(double)) == 0;
}

template <class Step>
std::span<const double> Exponential<Step>::breakpoints(const State& from, const State& to, time::Detail) {
  return recall(from, to).breakpoints();
}

template <class Step>
Step& Exponential<Step>::recall(const State& from, const State& to) {
  if (!holds(from, to.t)) follow(from, to.memory.tail(1)[0], kMacroStep, to.t);
  return step_;
}

template <class Step>
std::span<const time::EnergyAt> Exponential<Step>::energies(const State& from, const State& to,
                                                            std::span<const double> instants) {
  return recall(from, to).energies(instants);
}

template <class Step>
void Exponential<Step>::departure(const State& from, const State& to, double begin, double end,
                                  std::span<const Index> dofs, time::Interpolated out) {
  if constexpr (std::is_same_v<Step, ExponentialStep>) recall(from, to).departure(begin, end, dofs, out);
}

template <class Step>
void Exponential<Step>::interpolate_all(const State& from, const State& to, std::span<const double> times,
                                        std::span<const Index> dofs, time::Interpolated out) {
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

}  // namespace butee::integrators
