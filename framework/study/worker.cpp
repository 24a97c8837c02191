#include "butee/study/worker.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <new>

#include "butee/config/file_reference.hpp"
#include "butee/config/override.hpp"
#include "butee/config/parameters.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/scene/assembly.hpp"
#include "butee/study/lyapunov.hpp"
#include "butee/study/steady.hpp"
#include "butee/time/contact_events.hpp"

namespace butee::study {
namespace {

using Clock = std::chrono::steady_clock;

std::string in_one_line(const std::string& text) {
  std::string line = printable(text, true);
  std::replace(line.begin(), line.end(), '\n', ';');
  return line;
}

/// Identifies the scene of a point by its varied keys and values. Files that it names are in the
/// identity of the study.
std::string hash_of(const config::Document& scene) {
  std::string text = config::write_toml(*scene.root.table());
  return config::checksum_text(text);
}

void set_end(scene::Scene& scene, double end) {
  scene.integrator.options.end_time = end;
  scene.integrator.parameters.set("end_time", config::Value(end), true);
}

/// Whole numbers of periods are floor(periods (1 + kRoundingOfPeriods)).
constexpr double kRoundingOfPeriods = 1e-12;

/// The periods that count, up to the end of the scene.
double whole_periods(const Counted& counted) {
  const double periods = (counted.end - counted.begin) / counted.period * (1.0 + kRoundingOfPeriods);
  if (!(periods <= Study::kMostPeriods))
    throw InputError("study.period: " + to_short_text(counted.period) + " s is too short: the run would have " +
                     to_short_text(periods) + " periods, but at most " + to_short_text(Study::kMostPeriods) +
                     " are counted");
  return periods;
}

/// The part of a run over which results are collected, and the end of the run.
Counted counted_of(const Study& study, const scene::Scene& scene) {
  Counted counted;
  const bool needs_period =
      study.settle > 0 || study.periods ||
      std::any_of(study.items.begin(), study.items.end(), [](const Item& i) { return i.needs_period(); });
  if (needs_period) counted.period = study.period ? *study.period : period_of(scene.model);
  if (scene.output.interval) counted.interval = *scene.output.interval;
  counted.begin = static_cast<double>(study.settle) * counted.period;
  counted.end = study.periods ? static_cast<double>(study.settle + *study.periods) * counted.period
                              : scene.integrator.options.end_time;
  if (!(counted.begin < counted.end))
    throw InputError("study.settle: " + std::to_string(study.settle) + " periods of " + to_short_text(counted.period) +
                     " s reach the end of the run, " + to_short_text(counted.end) +
                     " s; make end_time larger, or give `periods`, the number that counts after settling");
  if (const double step = scene.integrator.options.time_step; step > counted.end)
    throw InputError("integrator.time_step = " + to_text(step) + " s is longer than the run, which ends after " +
                     to_short_text(counted.end) + " s");
  if (study.periods)
    counted.periods = *study.periods;
  else if (counted.period > 0.0)
    counted.periods = static_cast<std::int64_t>(std::floor(whole_periods(counted)));
  return counted;
}

Motion motion_at(const time::State& state, dynamics::Dynamics& dynamics) {
  return {state.x, state.v, time::contact_memory(dynamics, state)};
}

void begin_with(const Motion& motion, dynamics::Dynamics& dynamics, time::Simulation& simulation) {
  const Index contacts = dynamics.obstacles() != nullptr ? dynamics.obstacles()->size() : 0;
  if (motion.contact.size() != 0 && motion.contact.size() != dynamics::Obstacles::kMemorySize * contacts)
    throw InputError("study.follow: the run before has other contacts than this one");
  simulation.begin_with(motion.x, motion.v, motion.contact);
}

}  // namespace

Worker::Worker(const Study& study, const Layout& layout)
    : study_(study),
      layout_(layout),
      bench_(study),
      first_value_(layout.find(kStatusColumn) - study.plan.axes().size()),
      first_result_(layout.find(kReasonColumn) + 1) {}

scene::Scene Worker::read(const std::vector<config::Value>& values, Counted& counted) {
  plugin::Catalogue catalogue = catalogue_ ? std::move(*catalogue_) : study_.catalogue;
  catalogue_.reset();
  scene::Scene scene = scene::read_scene(scene_at(study_, values), std::move(catalogue));
  if (scene.model.initial_motion && scene.model.initial_motion->time != 0.0)
    throw InputError("initial.keep_time: runs of a study begin at t = 0; remove keep_time");
  counted = counted_of(study_, scene);
  if (study_.periods) set_end(scene, counted.end);
  return scene;
}

std::optional<Row> Worker::perform(std::int64_t run, Motion& motion, const std::function<bool()>& goes_on) {
  return perform(run, study_.plan.values(study_.plan.run(run).point), motion, goes_on);
}

std::optional<Row> Worker::perform(std::int64_t run, const std::vector<config::Value>& values, Motion& motion,
                                   const std::function<bool()>& goes_on) {
  const auto begin = Clock::now();
  Row row(layout_);
  row.set_integer(layout_.find(kRunColumn), run);
  row.set_integer(layout_.find(kPointColumn), study_.plan.run(run).point);
  if (study_.plan.follow() != Follow::no)
    row.set_integer(layout_.find(kDirectionColumn), study_.plan.run(run).direction);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (layout_.columns()[first_value_ + i].type == Column::Type::text)
      row.set_text(first_value_ + i, values[i].text() != nullptr ? *values[i].text() : config::to_toml(values[i]));
    else
      row.set(first_value_ + i, config::as_number(values[i]).value_or(0.0));
  }
  std::string status = "failed", reason;
  try {
    Counted counted;
    auto scene = std::make_unique<scene::Scene>(read(values, counted));
    row.set_text(layout_.find(kSceneColumn), hash_of(scene->document));
    if (!integrate(std::move(scene), values, counted, motion, row, goes_on)) return std::nullopt;
    status = "completed";
  } catch (const InputError& error) {
    status = "refused";
    reason = error.what();
  } catch (const std::bad_alloc&) {
    reason = "out of memory";
  } catch (const std::exception& error) {
    reason = error.what();
  }
  row.set_text(layout_.find(kStatusColumn), status);
  row.set_text(layout_.find(kReasonColumn), in_one_line(reason));
  row.set(layout_.find(kSecondsColumn), std::chrono::duration<double>(Clock::now() - begin).count());
  return row;
}

bool Worker::integrate(std::unique_ptr<scene::Scene> owned, const std::vector<config::Value>& values,
                       const Counted& counted, Motion& motion, Row& row, const std::function<bool()>& goes_on) {
  scene::Scene& scene = *owned;
  if (!motion.is_empty()) {
    scene.model.initial_motion = model::InitialMotion{motion.x, motion.v, 0.0};
    scene.model.initial_displacement.clear();
    scene.model.initial_velocity.clear();
    scene.model.starts_static = false;
    if (number_dofs(scene.model).free_count() != motion.x.size())
      throw InputError("study.follow: the run before has other degrees of freedom than this one");
  }
  struct CatalogueKeeper {
    std::optional<plugin::Catalogue>& to;
    scene::Scene& scene;
    ~CatalogueKeeper() { to = std::move(scene.catalogue); }
  };
  bench_.take(std::move(owned), values);
  const CatalogueKeeper keeper{catalogue_, scene};
  time::Simulation& simulation = bench_.simulation();
  Collector collector(study_.items, scene, bench_.dynamics(), counted);
  simulation.add(collector);
  std::optional<SteadyWatch> watch;
  if (study_.steady && study_.settle > 0)
    simulation.add(watch.emplace(bench_.dynamics(), counted.period, *study_.steady));
  bool is_stopped = false;
  const auto run = [&] {
    const time::RunReport& report = simulation.run([&] {
      is_stopped = !goes_on();
      return !is_stopped && !(watch && watch->has_news());
    });
    if (!report.message.empty()) throw RunError(report.message);
    return !is_stopped;
  };
  const auto finish = [&] {
    row.set_integer(layout_.find(kStepsColumn), simulation.report().steps);
    row.set_integer(layout_.find(kFactorizationsColumn), bench_.counters().factorizations);
    row.set_integer(layout_.find(kSolvesColumn), bench_.counters().solves);
    row.set_integer(layout_.find(kAssembliesColumn), bench_.assemblies());
  };
  Motion settled;
  try {
    if (!motion.is_empty()) begin_with(motion, bench_.dynamics(), simulation);
    simulation.start();
    if (!simulation.report().message.empty()) throw RunError(simulation.report().message);
    std::int64_t settle = study_.settle;
    if (counted.begin > 0.0) {
      simulation.set_end_time(counted.begin);
      if (!run()) return false;
      const bool is_steady = watch && watch->has_news();
      // The periods that count are all computed, whenever the motion becomes steady.
      if (watch) watch->close();
      if (is_steady) {
        settle = watch->next_alike(simulation.state().t, study_.settle);
        simulation.set_end_time(std::max(simulation.state().t, static_cast<double>(settle) * counted.period));
        if (!run()) return false;
      }
    }
    if (study_.steady) row.set_integer(layout_.find(kSettledColumn), settle);
    collector.open(simulation.state());
    settled = motion_at(simulation.state(), bench_.dynamics());
    simulation.set_end_time(settle == study_.settle ? counted.end : simulation.state().t + counted.end - counted.begin);
    if (!run()) return false;
  } catch (...) {
    finish();
    throw;
  }
  finish();
  if (const auto trust = std::find_if(study_.items.begin(), study_.items.end(),
                                      [](const Item& item) { return item.kind == Item::Kind::trust; });
      trust != study_.items.end()) {
    const auto until = horizon(scene, counted.end);
    if (!until || !goes_on()) return false;
    row.set(first_result_ + static_cast<std::size_t>(trust - study_.items.begin()), *until);
  }
  for (std::size_t i = 0; i < study_.items.size(); ++i) {
    std::vector<double> entries = collector.values(i);
    if (study_.items[i].kind == Item::Kind::lyapunov) {
      const auto exponent = lyapunov_exponent(scene, bench_.dynamics(), settled, counted, goes_on);
      if (!goes_on()) return false;
      entries = {exponent.value_or(std::nan(""))};
    }
    for (std::size_t k = 0; k < entries.size(); ++k) row.set(first_result_ + i, entries[k], k);
  }
  if (study_.plan.follow() != Follow::no) motion = motion_at(simulation.state(), bench_.dynamics());
  return true;
}

std::optional<double> Worker::horizon(const scene::Scene& scene, double end) const {
  config::Document document = scene.document;
  (*(*document.root.table())["integrator"].table())["end_time"] = config::Value(end);
  scene::Scene whole = scene::read_scene(std::move(document), scene.catalogue);
  try {
    return study_.horizon(whole);
  } catch (const RunError&) {
    return std::nan("");
  }
}

namespace {

/// The number of points that check_points() tries at most.
constexpr std::int64_t kTriedPoints = 16;

/// Reads and assembles the scene of a point. Throws InputError.
void check_point(const Study& study, const std::vector<config::Value>& values) {
  scene::Scene scene = scene::read_scene(scene_at(study, values), study.catalogue);
  const Counted counted = counted_of(study, scene);
  scene::Assembly assembly(scene);
  const Collector collector(study.items, scene, assembly.dynamics, counted);
}

}  // namespace

void check_points(const Study& study) {
  const std::int64_t points = study.plan.point_count(), tried = std::min(points, kTriedPoints);
  std::exception_ptr first;
  for (std::int64_t i = 0; i < tried; ++i) {
    try {
      return check_point(study, study.plan.values(tried == 1 ? 0 : i * (points - 1) / (tried - 1)));
    } catch (const InputError&) {
      if (!first) first = std::current_exception();
    }
  }
  if (first) std::rethrow_exception(first);
}

void check_streamed_points(const Study& study) {
  try {
    return check_points(study);
  } catch (const InputError&) {
    const auto& axes = study.plan.axes();
    if (!std::all_of(axes.begin(), axes.end(),
                     [&](const Axis& axis) { return config::find_value(study.scene, axis.key) != nullptr; }))
      throw;
    try {
      return check_point(study, {});
    } catch (const InputError&) {  // the error of the point names the value that was given
    }
    throw;
  }
}

}  // namespace butee::study
