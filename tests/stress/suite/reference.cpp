#include "reference.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <butee/dynamics/frequencies.hpp>

#include "work.hpp"

namespace butee::stress {
namespace {

/// Largest difference between two references, as a fraction of the tolerance; beyond it neither is valid.
constexpr double kCertain = 0.1;
/// Settings of the second reference: shorter series, so that its steps and its rounding differ.
constexpr const char* kOther = "order = 24\nseries_tolerance = 1e-18\n";
constexpr std::size_t kHardest = 3;
/// Lead time of a disturbance before an impact, as a fraction of the time since the previous contact change.
constexpr double kBefore = 0.1;
/// Number of instants before a wrong answer, and of disturbances at each, that are tried before the answer
/// counts as wrong.
constexpr int kDense = 30;
constexpr int kPatterns = 6;
/// If the reference of a scene exceeds its work limit, the scene is shortened to slightly less than the time
/// reached, to allow for the output instants. This is repeated if the shorter scene is still too expensive.
constexpr int kTrials = 4;
constexpr double kShorter = 0.9;
constexpr double kTurn = 6.283185307179586;
/// Largest number of periods of the slowest active mode for which the promised bound needs no allowance.
constexpr double kPeriods = 1000.0;

/// Tolerance of extrapolation8, used if exact refuses a law, as a fraction of the scene's tolerance; and its
/// lower limit due to rounding.
constexpr double kTighter = 1e-3, kTightest = 1e-12;

bool remembers_slip(const model::Model& model) {
  return std::any_of(model.obstacles.begin(), model.obstacles.end(), [](const model::ObstacleGroup& group) {
    return group.friction.rule == model::Friction::Rule::spring;
  });
}

/// 1, or the run's length in thousands of periods of the slowest active mode.
double allowance(const model::System& system, const dynamics::Modes& modes, const Trajectory& motion,
                 const Trajectory& largest, double end_time) {
  for (Index k = 0; k < modes.frequencies.size(); ++k) {
    const double periods = end_time * modes.frequencies[k] / kTurn;
    const Eigen::RowVectorXd amplitude = (system.mass * modes.shapes.col(k)).transpose() * motion.x;
    const Vector size = modes.shapes.col(k).cwiseAbs() * amplitude.cwiseAbs().maxCoeff();
    const auto last = largest.x.col(largest.x.cols() - 1).array();
    if ((size.array() > Promise::kFloor * last && last > 0.0).any()) return std::max(1.0, periods / kPeriods);
  }
  return 1.0;
}

/// A disturbance in all modes with random phases; each mode has e = 1, and the sum is scaled to e = 1. If
/// every component were disturbed independently, fast modes would vibrate with e = S_x omega/S_v, unlike the
/// errors of smooth motion.
void modal_pattern(const dynamics::Modes& modes, ConstVectorRef scale_x, ConstVectorRef scale_v, Random& random,
                   Vector& x, Vector& v) {
  x.setZero(scale_x.size());
  v.setZero(scale_v.size());
  for (Index k = 0; k < modes.frequencies.size(); ++k) {
    const double omega = modes.frequencies[k];
    const double in_place = (modes.shapes.col(k).array() / scale_x.array()).abs().maxCoeff();
    const double in_speed = (modes.shapes.col(k).array() / scale_v.array()).abs().maxCoeff();
    const double place = 1.0 / std::max(in_place, omega * in_speed);
    const double speed = 1.0 / std::max(in_speed, omega > 0.0 ? in_place / omega : 0.0);
    x += (random.chance(0.5) ? place : -place) * modes.shapes.col(k);
    v += (random.chance(0.5) ? speed : -speed) * modes.shapes.col(k);
  }
  const double size =
      std::max((x.array() / scale_x.array()).abs().maxCoeff(), (v.array() / scale_v.array()).abs().maxCoeff());
  x /= size;
  v /= size;
}

/// Disturbs every component by its own scale.
void any_pattern(ConstVectorRef scale_x, ConstVectorRef scale_v, Random& random, Vector& x, Vector& v) {
  x = scale_x;
  v = scale_v;
  for (Index i = 0; i < x.size(); ++i) {
    if (random.chance(0.5)) x[i] = -x[i];
    if (random.chance(0.5)) v[i] = -v[i];
  }
}

}  // namespace

Reference::Reference(const Scene& scene, std::int64_t work) : scene_(scene), work_(work), end_time_(scene.end_time) {
  try {
    solve();
    return;
  } catch (const InputError& error) {
    complaint_ = error.what();
  }
  // exact refuses some contact laws.
  is_exact_ = false;
  try {
    solve();
    complaint_.clear();
  } catch (const InputError&) {
  }
}

std::string Reference::toml(bool is_other) const {
  std::string method = "type = \"exact\"\n" + std::string(is_other ? kOther : "");
  if (!is_exact_)
    method = std::string("type = \"") + (is_other ? "dopri5" : "extrapolation8") +
             "\"\ntolerance = " + to_text(std::max(kTighter * scene_.tolerance, kTightest)) + "\n";
  return scene_.toml + "[integrator]\n" + method + "end_time = " + to_text(end_time_) + "\n";
}

void Reference::solve() {
  double reached = follow();
  for (int trial = 0; reached < end_time_; ++trial, reached = follow()) {
    if (!(reached > 0.0) || trial == kTrials) return;
    end_time_ = kShorter * reached;
  }
  peak_ = largest_.x.col(kRows - 1).maxCoeff();
  if (!(peak_ > 0.0) || !base_.is_finite) return;
  const model::System& system = run_->system();
  std::vector<bool> is_rotation;
  for (const model::NodalDof& dof : system.dofs.free()) is_rotation.push_back(butee::is_rotation(dof.kind));
  modes_ = dynamics::lowest_modes(system, system.size());
  if (!modes_) return;
  promise_.emplace(base_, largest_, is_rotation, scene_.tolerance,
                   allowance(system, *modes_, base_, largest_, end_time_));
  compare_with_another();
  add_disturbances(end_time_);
  measure();
}

void Reference::place_instants() {
  // Irregularly spaced, so that outputs do not repeatedly fall on the same phase.
  instants_ = {0.0};
  for (int i = 1; i < kRows; ++i) {
    const double jitter = i < kRows - 1 ? 0.8 * (std::fmod(0.6180339887498949 * i, 1.0) - 0.5) : 0.0;
    instants_.push_back(end_time_ * (i + jitter) / (kRows - 1));
  }
}

bool Reference::advance_to(double t) {
  time::Simulation& simulation = run_->simulation();
  simulation.set_end_time(t);
  const std::int64_t begin = work_of(run_->dynamics().counters());
  while (simulation.state().t < t) {
    if (work_of(run_->dynamics().counters()) - begin > work_) return false;
    if (!simulation.advance()) break;
  }
  return simulation.report().completed;
}

double Reference::follow() {
  place_instants();
  run_ = std::make_unique<test::SceneRun>(toml(false));
  const auto range = dynamics::frequency_range(run_->system(), dynamics::StopState::closed);
  critical_step_ = range && range->highest > 0.0 ? 2.0 / range->highest : end_time_;
  watch_ = std::make_unique<CourseWatch>(run_->dynamics());
  band_ = std::make_unique<VelocityBand>();
  follower_ = std::make_unique<Follower>(run_->dynamics().size(), instants_);
  time::Simulation& simulation = run_->simulation();
  simulation.add(*watch_);
  simulation.add(*band_);
  simulation.add(*follower_);
  simulation.start();
  const Index size = run_->dynamics().size();
  base_ = largest_ = Trajectory(size, instants_.size());
  base_.rows = largest_.rows = kRows;
  snapshots_.clear();
  const std::int64_t begin = work_of(run_->dynamics().counters());
  for (Index row = 0; row < kRows; ++row) {
    const double t = instants_[static_cast<std::size_t>(row)];
    if (row > 0 && (!advance_to(t) || work_of(run_->dynamics().counters()) - begin > work_))
      return std::min(simulation.state().t, kShorter * end_time_);
    base_.x.col(row) = simulation.state().x;
    base_.v.col(row) = simulation.state().v;
    base_.is_finite = base_.is_finite && simulation.state().x.allFinite() && simulation.state().v.allFinite();
    largest_.x.col(row) = watch_->largest_x;
    largest_.v.col(row) = watch_->largest_v;
    snapshots_.push_back(simulation.snapshot());
  }
  watch_->watches = CourseWatch::Watches::nothing;
  return end_time_;
}

void Reference::compare_with_another() {
  test::SceneRun run(toml(true));
  Follower follower(run.dynamics().size(), instants_);
  run.simulation().add(follower);
  while (run.simulation().advance() && work_of(run.dynamics().counters()) < 2 * work_) continue;
  other_ = std::move(follower.trajectory);
}

Index Reference::row_at(double t) const {
  return static_cast<Index>(std::upper_bound(instants_.begin(), instants_.end(), t) - instants_.begin()) - 1;
}

void Reference::disturb(double t, int pattern) {
  const Index before = row_at(t);
  if (before >= promise_->rows() || before + 1 >= kRows) return;
  time::Simulation& simulation = run_->simulation();
  simulation.restore(snapshots_[static_cast<std::size_t>(before)]);
  watch_->largest_x = promise_->scales().x.col(before);
  watch_->largest_v = promise_->scales().v.col(before);
  if (t > instants_[static_cast<std::size_t>(before)]) {
    watch_->watches = CourseWatch::Watches::largest;
    advance_to(t);
    watch_->watches = CourseWatch::Watches::nothing;
  }
  Vector x = simulation.state().x, v = simulation.state().v, change_x, change_v;
  // Patterns come in pairs of opposite sign; the first pair is a modal vibration.
  Random random(disturbed_.size() * 8U + static_cast<std::uint64_t>(pattern / 2));
  if (pattern < 2)
    modal_pattern(*modes_, watch_->largest_x, watch_->largest_v, random, change_x, change_v);
  else
    any_pattern(watch_->largest_x, watch_->largest_v, random, change_x, change_v);
  const double size = scene_.tolerance, sign = pattern % 2 == 0 ? size : -size;
  x += sign * change_x;
  v += sign * change_v;
  follower_->trajectory = Trajectory(x.size(), instants_.size());
  follower_->trajectory.rows = before + 1;
  // Nothing is compared beyond the horizon.
  const Index last = std::clamp<Index>(promise_->rows(), before + 1, kRows - 1);
  const double end = instants_[static_cast<std::size_t>(last)];
  simulation.set_end_time(end);
  set_motion(x, v);
  const bool is_over = advance_to(end);
  disturbed_.push_back({before + 1, size, is_over, follower_->trajectory});
  follower_->trajectory.rows = kRows;  // stops recording
}

void Reference::set_motion(const Vector& x, const Vector& v) {
  time::Simulation& simulation = run_->simulation();
  if (!remembers_slip(run_->model())) return simulation.set_motion(x, v);
  // start() would reset the memory of stick springs.
  time::Snapshot snapshot = simulation.snapshot();
  snapshot.state.x = x;
  snapshot.state.v = v;
  run_->dynamics().acceleration(snapshot.state.t, x, v, snapshot.state.a);
  simulation.restore(snapshot);
}

std::vector<double> Reference::before_hardest_impacts(double until) const {
  std::vector<std::pair<double, double>> impacts;
  const Vector& stiffness = watch_->closed_stiffness();
  double last = 0.0;
  for (const ContactChange& change : watch_->changes) {
    if (change.t > until) break;
    if (change.closes && change.t > last)
      impacts.emplace_back(-change.speed * std::sqrt(stiffness[change.contact]),
                           change.t - kBefore * (change.t - last));
    last = change.t;
  }
  std::sort(impacts.begin(), impacts.end());
  std::vector<double> times;
  for (std::size_t i = 0; i < std::min(kHardest, impacts.size()); ++i) times.push_back(impacts[i].second);
  return times;
}

void Reference::add_disturbances(double until) {
  std::vector<double> times = before_hardest_impacts(until);
  if (level_ == 0) {
    for (const int pattern : {0, 1}) disturb(0.0, pattern);
    for (const double part : {0.25, 0.5, 0.75}) disturb(part * end_time_, 0);
    if (!times.empty()) disturb(times.front(), 1);
    return;
  }
  const int places = level_ == 1 ? 10 : kDense;
  for (int i = 0; i < places; ++i) times.push_back(until * i / places);
  for (const double t : times)
    for (int pattern = 0; pattern < kPatterns; ++pattern) disturb(t, pattern);
}

void Reference::refine(Index until) {
  ++level_;
  add_disturbances(level_ == 1 ? end_time_ : instants_[static_cast<std::size_t>(std::max<Index>(until, 1))]);
  measure();
}

void Reference::measure() {
  promise_->clear_growth();
  promise_->clear_bands();
  for (const Disturbed& one : disturbed_) promise_->raise_growth(one.trajectory, one.row, one.size, one.is_over, false);
  const Index banded = place_bands();
  for (const Disturbed& one : disturbed_) promise_->raise_growth(one.trajectory, one.row, one.size, one.is_over, true);
  Index certain = 0;
  while (certain < other_.rows && promise_->error(other_, certain) <=
                                      kCertain * promise_->tolerance() * std::max(1.0, promise_->growth(certain)))
    ++certain;
  promise_->limit_rows(kRows);
  is_uncertain_ = certain < promise_->rows();
  promise_->limit_rows(std::min(certain, banded));
}

Index Reference::place_bands() {
  constexpr std::int64_t kMostLooks = 1000000;
  band_->looks = 0;
  time::Simulation& simulation = run_->simulation();
  for (Index row = 0; row < promise_->rows(); ++row) {
    const double t = instants_[static_cast<std::size_t>(row)];
    // A body near rest at its stop has margins of any length.
    const double margin =
        std::min(time_margin(watch_->changes, watch_->ends(), promise_->scales(), row, t, promise_->allowed(row)),
                 instants_.back());
    if (margin == 0.0) continue;
    const auto after = std::upper_bound(instants_.begin(), instants_.end(), t - margin);
    const Index from = std::max<Index>(0, after - instants_.begin() - 1);
    simulation.restore(snapshots_[static_cast<std::size_t>(from)]);
    band_->watch(t - margin, t + margin, base_.x.rows());
    advance_to(t + margin);
    band_->is_active = false;
    promise_->set_band(row, band_->low, band_->high);
    if (band_->looks > kMostLooks) return row + 1;
  }
  return promise_->rows();
}

std::string Reference::place(const Judgement& found) const {
  const auto& dofs = run_->system().dofs;
  return (found.in_velocity ? "velocity of " : "") + dofs.name(dofs.free()[static_cast<std::size_t>(found.component)]) +
         " at t = " + to_short_text(instants_[static_cast<std::size_t>(found.row)]);
}

}  // namespace butee::stress
