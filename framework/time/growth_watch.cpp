#include "butee/time/growth_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "butee/core/text.hpp"
#include "butee/dynamics/frequencies.hpp"

namespace butee::time {
namespace {

constexpr std::int64_t kFirstLook = 16, kBetweenLooks = 256;
/// Logarithm of the energy growth not explained by loads that ends a run; growth below kNoGrowth is
/// rounding.
const double kTooMuch = std::log(100.0);
/// The same for explicit methods that choose their steps by an error in displacements alone: at the
/// border of stability rotations grow undetected until steps are reduced and they decay. For beam2
/// of the paper the energy grew up to some thousandfold, with good displacements at the end.
const double kTooMuchUnseen = std::log(1e5);
constexpr double kNoGrowth = 0.01;
/// Energy of the errors of a method that keeps its tolerance, relative to the largest energy: the square of the largest
/// tolerance. Motion that has decayed below it consists of errors.
constexpr double kOfErrors = 0.01;
/// Number of instants within a span at which loads are evaluated, in addition to their
/// discontinuities.
constexpr int kInstants = 16;
constexpr double kGoldenRatio = 0.6180339887498949;
/// The error of one step of the trapezoidal rule, relative to the largest displacement, at h
/// omega = 1.
constexpr double kCoarse = 0.08;
/// The error of one step at which a hundred steps are still accurate.
constexpr double kFine = 1e-4;
/// Strain energy below minus this part of the kinetic energy is that of a negative stiffness, which supplies energy to
/// the motion without bound.
constexpr double kFed = 0.01;
/// A distance from a stop at a check, as a fraction of the gap, at which contact between two checks
/// is assumed.
constexpr double kNear = 0.1;
/// h omega of a stop above which an impact lasts less than three steps.
constexpr double kCoarseImpact = 1.0;

/// The logarithm of energy over `explained`; 0 if nothing is explained, since rounding then
/// decides.
double excess_over(double explained, double energy) {
  return explained > 0.0 ? std::log(energy / explained) : 0.0;
}

/// Friction on a moving surface, cross terms of bearings, damping that turns and negative damping supply energy to the
/// motion without bound.
bool is_driven(const dynamics::Dynamics& dynamics) {
  const model::System& system = dynamics.system();
  for (const model::FreeObstacles& obstacles : system.obstacles)
    if (obstacles.group->friction.rule != model::Friction::Rule::none) return true;
  const bool is_negative = system.dashpots.size() > 0 && (Vector(system.dashpots.diagonal()).array() < 0.0).any();
  return !system.stiffness_is_symmetric || system.circulatory.size() > 0 || is_negative;
}

}  // namespace

GrowthWatch::GrowthWatch(dynamics::Dynamics& dynamics, const MethodLimits& limits, const Integrator& integrator)
    : dynamics_(dynamics),
      limits_(limits),
      has_fixed_steps_(integrator.controller() == nullptr),
      may_be_coarse_(has_fixed_steps_ ||
                     (!limits.keeps_tolerance && !integrator.traits().handles_load_discontinuities)),
      is_watching_((limits.is_bounded() || dynamics.stop_count() > 0) && !is_driven(dynamics)),
      too_much_(!has_fixed_steps_ && !limits.keeps_tolerance && limits.is_bounded() ? kTooMuchUnseen : kTooMuch) {}

void GrowthWatch::start(const State& state) {
  prepare();
  count_ = 0;
  excess_ = 0.0;
  next_look_ = is_watching_ || may_be_coarse_ ? kFirstLook : std::numeric_limits<std::int64_t>::max();
  last_time_ = begin_time_ = start_time_ = state.t;
  last_energy_ = begin_energy_ = start_energy_ = largest_energy_ = energy(state);
  sound_energy_ = 0.0;
  if (may_be_coarse_) contact_frequency_ = dynamics::contact_frequency(dynamics_.system(), dynamics_.stops());
}

void GrowthWatch::prepare() {
  work_ = zero_ = stored_ = Vector::Zero(dynamics_.size());
  stops_ = Vector::Zero(dynamics_.stop_count());
  load_norms_.reserve(dynamics_.system().loads.size());
  discontinuities_ = dynamics_.load_discontinuities();
}

void GrowthWatch::save(ByteWriter& to) const {
  for (const std::int64_t count : {count_, next_look_}) to.put(count);
  for (const double number :
       {last_time_, last_energy_, excess_, begin_time_, begin_energy_, start_time_, start_energy_, largest_energy_,
        largest_x_, coarseness_, coarse_step_, longest_step_, contact_frequency_})
    to.put(number);
  to.put(is_met_);
  to.put(is_fed_);
}

void GrowthWatch::restore(ByteReader& from) {
  prepare();
  sound_energy_ = 0.0;
  for (std::int64_t* count : {&count_, &next_look_}) from.take(*count);
  for (double* number :
       {&last_time_, &last_energy_, &excess_, &begin_time_, &begin_energy_, &start_time_, &start_energy_,
        &largest_energy_, &largest_x_, &coarseness_, &coarse_step_, &longest_step_, &contact_frequency_})
    from.take(*number);
  from.take(is_met_);
  from.take(is_fed_);
}

double GrowthWatch::energy(const State& state) {
  dynamics_.inertia_force(state.v, work_);
  double sum = 0.5 * state.v.dot(work_);
  dynamics_.elastic_force(state.x, work_);
  const double strain = 0.5 * state.x.dot(work_);
  is_fed_ = is_fed_ || strain < -kFed * sum;
  sum += strain;
  if (dynamics_.obstacles() != nullptr) sum += dynamics_.obstacles()->energy(state.t, state.x, state.v);
  if (stops_.size() == 0) return sum;
  const dynamics::ElasticStops& contact = dynamics_.stops();
  contact.displacement(state.x, stops_);
  contact.penetration(stops_, stops_);
  for (Index i = 0; i < stops_.size(); ++i) {
    sum += contact.law_of(i).energy(stops_[i]);
    is_met_ = is_met_ || stops_[i] >= -kNear * contact.play_of(i).gap;
  }
  return sum;
}

void GrowthWatch::find_load_norms() {
  for (const model::FreeLoad& load : dynamics_.system().loads) {
    work_.setZero();
    for (std::size_t i = 0; i < load.dofs.size(); ++i) work_[load.dofs[i]] += load.weights[i];
    dynamics_.solve_acceleration(zero_, zero_, work_);
    double square = 0.0;
    for (std::size_t i = 0; i < load.dofs.size(); ++i) square += load.weights[i] * work_[load.dofs[i]];
    load_norms_.push_back(std::sqrt(std::max(0.0, square)));
  }
}

double GrowthWatch::push(double from, double to) {
  const auto& loads = dynamics_.system().loads;
  if (load_norms_.size() < loads.size()) find_load_norms();
  const auto at = [&](double t) {
    double sum = 0.0;
    for (std::size_t i = 0; i < loads.size(); ++i) sum += load_norms_[i] * std::abs(loads[i].in_time->value(t));
    return sum;
  };
  double largest = std::max(at(from), at(to));
  // Not equidistant, since such instants could coincide with the zeros of a harmonic load; and
  // between any two discontinuities, since a pulse may lie there.
  const auto look_between = [&](double begin, double end) {
    for (int i = 1; i <= kInstants; ++i) {
      const double turns = kGoldenRatio * i;
      largest = std::max(largest, at(begin + (turns - std::floor(turns)) * (end - begin)));
    }
  };
  look_between(from, to);
  double begin = from;
  for (auto jump = std::lower_bound(discontinuities_.begin(), discontinuities_.end(), from);
       jump != discontinuities_.end() && *jump <= to; ++jump) {
    largest = std::max({largest, at(*jump), at(std::nextafter(*jump, from))});
    look_between(begin, *jump);
    begin = *jump;
  }
  return largest * (to - from) / std::sqrt(2.0);
}

bool GrowthWatch::look(const State& from, const State& to, double h) {
  if (work_.size() == 0 || from.t < last_time_) start(from);  // restored, or returned to an earlier state
  next_look_ = count_ + (count_ < kBetweenLooks ? count_ : kBetweenLooks);
  if (may_be_coarse_) note_coarseness(from, to, h);
  if (!is_watching_) return false;
  const double now = energy(to);
  if (is_fed_) return false;
  const double of_errors = limits_.keeps_tolerance ? kOfErrors * largest_energy_ : 0.0,
               before = std::max(last_energy_, of_errors);
  const double growth = now > before ? excess_over(explained(before, last_time_, to.t), now) : 0.0;
  if (growth > kNoGrowth) {
    excess_ += growth;
  } else if (std::isfinite(now)) {
    excess_ = 0.0;
    begin_time_ = to.t;
    begin_energy_ = now;
  } else {
    excess_ = std::numeric_limits<double>::infinity();
  }
  last_time_ = to.t;
  last_energy_ = now;
  if (std::isfinite(now)) largest_energy_ = std::max(largest_energy_, now);
  return excess_ > too_much_ || has_grown_since_start(to.t, now);
}

bool GrowthWatch::has_grown_since_start(double t, double now) {
  if (!(now > sound_energy_)) return false;
  // The explained energy only increases, so that it is evaluated only a few times in a run.
  const double from_loads = explained(start_energy_, start_time_, t);
  sound_energy_ = from_loads * std::exp(too_much_);
  if (!(now > sound_energy_) || !(from_loads > 0.0)) return false;
  excess_ = excess_over(from_loads, now);
  begin_time_ = start_time_;
  begin_energy_ = start_energy_;
  return true;
}

double GrowthWatch::explained(double energy, double since, double t) {
  const double root = std::sqrt(std::max(0.0, energy)) + push(since, t);
  return root * root;
}

std::string GrowthWatch::describe(const State& state, double h) const {
  return "the motion grows without a physical cause: from t = " + to_short_text(begin_time_) + " s to " +
         to_short_text(state.t) + " s its energy rose from " + to_short_text(begin_energy_) + " J to " +
         (std::isfinite(last_energy_)
              ? to_short_text(last_energy_) + " J, at least " + to_short_text(std::exp(excess_)) +
                    " times the energy possible with these loads"
              : "a value beyond the range of numbers") +
         ". It moves fastest in " + fastest_dof(dynamics_, state) + ". " +
         (!limits_.keeps_tolerance      ? describe_remedy(dynamics_, limits_, h)
          : std::isfinite(last_energy_) ? "Tighten the tolerance of " + limits_.name
                                        : "Loads or the initial motion are too large: check their units");
}

void GrowthWatch::note_coarseness(const State& from, const State& to, double h) {
  const auto norm = [this](ConstVectorRef y) {
    dynamics_.inertia_force(y, work_);
    return std::sqrt(std::max(0.0, y.dot(work_)));
  };
  largest_x_ = std::max(largest_x_, norm(to.x));
  if (!(largest_x_ > 0.0)) return;
  stored_ = to.a - from.a;
  const double error = h * h / 12.0 * norm(stored_) / largest_x_;
  longest_step_ = std::max(longest_step_, h);
  if (!(error > coarseness_)) return;
  coarseness_ = error;
  coarse_step_ = h;
}

std::vector<std::string> GrowthWatch::warnings() const {
  std::vector<std::string> all;
  if (!may_be_coarse_) return all;
  const bool is_coarse = coarseness_ > kCoarse,
             misses_impacts = is_met_ && longest_step_ * contact_frequency_ > kCoarseImpact;
  double advised = std::numeric_limits<double>::infinity();
  if (is_coarse) advised = coarse_step_ * std::cbrt(kFine / coarseness_);
  if (misses_impacts) advised = std::min(advised, 0.1 / contact_frequency_);
  const std::string advice = has_fixed_steps_ ? ". Take a time_step of " + to_short_text(advised) +
                                                    " s or less, or a method with error control, such as auto"
                                              : ". Tighten its control, so that steps come down to " +
                                                    to_short_text(advised) + " s, or take auto";
  const std::string prefix = limits_.name + ": ";
  // The last of equal steps may be shorter.
  const double step = has_fixed_steps_ ? longest_step_ : coarse_step_;
  if (is_coarse)
    all.push_back(prefix + "steps of " + to_short_text(step) +
                  " s are too long for this motion; the error of a single step was up to " +
                  to_short_text(coarseness_) + " of the largest displacement" + advice);
  if (misses_impacts)
    all.push_back(prefix + "an impact can be as short as " +
                  to_short_text(dynamics::shortest_impact(dynamics_.system())) + " s, so that steps of " +
                  to_short_text(longest_step_) + " s do not resolve its force" + advice);
  return all;
}

}  // namespace butee::time
