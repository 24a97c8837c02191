#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>
#include <butee/plugin/catalogue.hpp>
#include <butee/solve/frequencies.hpp>

namespace butee::stress {
namespace {

using test::SceneRun;

constexpr int kInstants = 200;
/// What is moved, in tolerances: as far as the errors of a few steps reach, which can fall to the other side
/// of a ridge.
constexpr double kMoved = 10.0;
/// Error at the end for such a difference before: that of many steps, and of more than one DOF.
constexpr double kReserve = 3.0;
/// How wrong a clock may be, in tolerances.
constexpr double kLate = 2.0;
/// Where that much error is allowed there is nothing left to compare.
constexpr double kHorizon = 0.1;
/// A motion so many times as large as the true one is no inaccuracy.
constexpr double kGrown = 1e3;
/// A series of order 30 is as many evaluations.
constexpr std::int64_t kReferenceWork = 25;
/// CPU seconds; a bound of work is reached long before.
constexpr double kHung = 20.0;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

std::vector<double> instants_of(const Scene& scene) {
  std::vector<double> instants;
  for (int i = 1; i <= kInstants; ++i) instants.push_back(scene.end_time * i / kInstants);
  return instants;
}

/// Takes all displacements at given instants, and the largest speed until then.
class Follower final : public time::Observer {
 public:
  Follower(Index size, std::vector<double> instants) : instants_(std::move(instants)), row_(size) {
    for (Index i = 0; i < size; ++i) all_.push_back(i);
  }
  void step(const time::AcceptedStep& step) override {
    largest = std::max(largest, step.to.x.lpNorm<Eigen::Infinity>());
    speed_ = std::max(speed_, step.to.v.lpNorm<Eigen::Infinity>());
    is_finite = is_finite && step.to.x.allFinite() && step.to.v.allFinite() && step.to.a.allFinite();
    while (rows.size() < instants_.size() && instants_[rows.size()] <= step.to.t) {
      step.integrator.interpolate(step.from, step.to, instants_[rows.size()], all_,
                                  {{row_.data(), static_cast<std::size_t>(row_.size())}, {}, {}});
      is_finite = is_finite && row_.allFinite();
      rows.push_back(row_);
      speeds.push_back(speed_);
    }
  }
  double next_instant(double t) const override {
    const auto next = std::upper_bound(instants_.begin(), instants_.end(), t);
    return next == instants_.end() ? std::numeric_limits<double>::infinity() : *next;
  }

  std::vector<Vector> rows;
  std::vector<double> speeds;
  double largest = 0.0;
  bool is_finite = true;

 private:
  std::vector<double> instants_;
  std::vector<Index> all_;
  Vector row_;
  double speed_ = 0.0;
};

std::int64_t work_of(const solve::Counters& c) {
  return c.force_evaluations + c.contact_evaluations + c.solves + c.factorizations;
}

enum class End { over, cut, hung };

End advance(SceneRun& run, std::int64_t work) {
  const double begin = cpu_seconds();
  for (std::int64_t i = 0; i < work; ++i) {
    if (!run.simulation().advance()) return End::over;
    if (work_of(run.dynamics().counters()) > work) return End::cut;
    if (i % 64 == 0 && cpu_seconds() - begin > kHung) return End::hung;
  }
  return End::cut;
}

std::string integrator(const Scene& scene, const std::string& keys) {
  return "[integrator]\n" + keys + "end_time = " + to_text(scene.end_time) + "\n";
}

/// Moves the motion by `size` and `speed`, differently in every DOF, at an instant.
struct Shift {
  double size = 0.0, speed = 0.0, at = 0.0;
};

struct Course {
  std::vector<Vector> rows;
  std::vector<double> speeds;
};

void move(time::Simulation& simulation, const Shift& shift) {
  Vector x = simulation.state().x, v = simulation.state().v;
  for (Index i = 0; i < x.size(); ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    x[i] += sign * shift.size;
    v[i] += sign * shift.speed;
  }
  simulation.set_motion(x, v);
}

Course exact_course(const Scene& scene, const Shift& shift, std::int64_t work) {
  SceneRun run(scene.toml +
               integrator(scene, "type = \"exact\"\ntime_step = " + to_text(1e-3 * scene.end_time) + "\n"));
  time::Simulation& simulation = run.simulation();
  Follower follower(run.dynamics().size(), instants_of(scene));
  simulation.add(follower);
  bool is_moved = shift.size == 0.0;
  for (std::int64_t i = 0; i < work && work_of(run.dynamics().counters()) < work; ++i) {
    if (!is_moved && simulation.state().t >= shift.at) {
      move(simulation, shift);
      is_moved = true;
    }
    if (!simulation.advance()) break;
  }
  if (!follower.is_finite) return {};
  return {std::move(follower.rows), std::move(follower.speeds)};
}

std::string settings(const Scene& scene, const Method& method, double critical_step) {
  const std::string type = "type = \"" + method.name + "\"\n";
  const double step = std::min(scene.step_factor * critical_step, 0.2 * scene.end_time);
  const std::string time_step = "time_step = " + to_text(step) + "\n";
  if (method.is_controlled || method.is_foreign) return type + "tolerance = " + to_text(scene.tolerance) + "\n";
  if (method.name == "rk4_fixed_factors")
    return type + time_step + "shrink = 1.3\ngrow = 1.5\ntolerance = " + to_text(scene.tolerance * scene.size) + "\n";
  if (method.name == "rk4_error_scaled")
    return type + time_step + "safety = 0.8\ntolerance = " + to_text(scene.tolerance * scene.size) + "\n";
  std::string keys = type + time_step;
  if (method.name == "newmark" || method.name == "newmark_adaptive")
    keys += "residual_tolerance = 1e-9\nincrement_tolerance = 1e-9\nmax_iterations = 30\n";
  if (method.name == "newmark_adaptive" || method.name == "newmark_modified_adaptive")
    keys += "target_error = " + to_text(0.1 * scene.tolerance) + "\n";
  return keys;
}

Outcome judge(const Method& method, const Reference& reference, const Follower& follower, Outcome outcome) {
  if (!follower.is_finite) {
    outcome.verdict = Verdict::not_finite;
    return outcome;
  }
  if (!reference.exists()) return outcome;
  double largest_allowed = 0.0;
  for (std::size_t i = 0; i < std::min(reference.instants().size(), follower.rows.size()); ++i) {
    const double error = (follower.rows[i] - reference.at(i)).lpNorm<Eigen::Infinity>() / reference.peak();
    outcome.error = std::max(outcome.error, error);
    if (error > outcome.excess * reference.allowed(i)) {
      outcome.excess = error / reference.allowed(i);
      largest_allowed = reference.allowed(i);
    }
  }
  outcome.allowed = largest_allowed;
  if (follower.largest > kGrown * reference.peak() && !outcome.has_warned)
    outcome.verdict = Verdict::grown;
  else if (outcome.excess <= 1.0)
    outcome.verdict = Verdict::correct;
  else
    outcome.verdict = method.is_controlled ? Verdict::wrong : Verdict::inaccurate;
  return outcome;
}

}  // namespace

const char* name_of(Verdict verdict) {
  const char* const names[] = {"correct", "inaccurate", "diagnosed",  "refused", "unjudged",
                               "wrong",   "grown",      "not finite", "silent",  "hung"};
  return names[static_cast<int>(verdict)];
}

bool is_failure(Verdict verdict) {
  return static_cast<int>(verdict) >= static_cast<int>(Verdict::wrong);
}

std::vector<Method> methods() {
  plugin::Catalogue catalogue;
  catalogue.add(BUTEE_TEST_PLUGINS);
  std::vector<Method> all;
  for (const auto& entry : catalogue.integrators()) {
    const auto& type = entry.declaration;
    if (type.name == "exact") continue;
    // The ones that need no first step are those whose tolerance is relative and kept. That of SUNDIALS is one of each
    // component and step: it is there to compare with, and its errors are recorded.
    const bool is_foreign = entry.module.find("sundials") != std::string::npos;
    all.push_back({type.name, type.finds_first_step && !is_foreign, is_foreign});
  }
  return all;
}

Reference::Reference(const Scene& scene, std::int64_t work) {
  work *= kReferenceWork;
  {
    SceneRun run(scene.toml + integrator(scene, "type = \"exact\"\ntime_step = " + to_text(scene.end_time) + "\n"));
    const auto range = solve::frequency_range(run.system(), solve::StopState::closed);
    critical_step_ = range && range->highest > 0.0 ? 2.0 / range->highest : scene.end_time;
  }
  const Course course = exact_course(scene, {}, work);
  for (const Vector& row : course.rows) peak_ = std::max(peak_, row.lpNorm<Eigen::Infinity>());
  if (!(peak_ > 0.0)) return;
  const double speed = course.speeds.back();
  std::vector<Course> others;
  const double moved = kMoved * scene.tolerance;
  for (const double in_place : {moved, -moved})
    for (const double in_speed : {moved, -moved})
      others.push_back(exact_course(scene, {in_place * peak_, in_speed * speed, 0.0}, work));
  // What is damped away before the motion begins in earnest says nothing of what comes then.
  for (const double part : {0.3, 0.6})
    for (const double size : {moved, -moved})
      others.push_back(exact_course(scene, {size * peak_, size * speed, part * scene.end_time}, work));
  const std::vector<double> instants = instants_of(scene);
  double apart = moved;
  for (std::size_t i = 0; i < course.rows.size(); ++i) {
    for (const Course& other : others) {
      if (i >= other.rows.size()) return;
      apart = std::max(apart, (other.rows[i] - course.rows[i]).lpNorm<Eigen::Infinity>() / peak_);
    }
    const double late = kLate * scene.tolerance * course.speeds[i] * instants[i] / peak_;
    const double allowed = kReserve * apart + late;
    if (allowed > kHorizon) return;
    instants_.push_back(instants[i]);
    motion_.push_back(course.rows[i]);
    allowed_.push_back(allowed);
  }
}

Outcome run(const Scene& scene, const Method& method, const Reference& reference, std::int64_t work) {
  Outcome outcome;
  const log::WithoutWarnings quiet;
  const double begin = cpu_seconds();
  try {
    SceneRun run(scene.toml + integrator(scene, settings(scene, method, reference.critical_step())));
    Follower follower(run.dynamics().size(), instants_of(scene));
    run.simulation().add(follower);
    const End end = advance(run, work);
    outcome.seconds = cpu_seconds() - begin;
    outcome.was_cut = end == End::cut;
    const time::RunReport& report = run.simulation().report();
    outcome.message = report.message;
    outcome.has_warned = !report.warnings.empty();
    outcome = judge(method, reference, follower, std::move(outcome));
    if (end == End::hung) outcome.verdict = Verdict::hung;
    const bool stopped = end == End::over && !report.completed;
    if (stopped && outcome.verdict != Verdict::not_finite)
      outcome.verdict = outcome.message.find("t = ") != std::string::npos ? Verdict::diagnosed : Verdict::silent;
  } catch (const InputError& error) {
    outcome.verdict = Verdict::refused;
    outcome.message = error.what();
  }
  return outcome;
}

}  // namespace butee::stress
