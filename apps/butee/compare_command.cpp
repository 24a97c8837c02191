#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <butee/config/file_reference.hpp>
#include <butee/config/override.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/target.hpp>
#include <butee/core/text.hpp>
#include <butee/dynamics/frequencies.hpp>
#include <butee/plugin/module.hpp>
#include <butee/record/result_folder.hpp>
#include <butee/version.hpp>

#include "commands.hpp"
#include "compare/report.hpp"
#include "interruption.hpp"

namespace butee::app {
namespace {

using namespace compare;

/// A sweep continues while errors are above this fraction of the smallest target.
constexpr double kFineEnough = 0.3;
/// Assumed ratio of a run's time to that of the run before it; runs expected to exceed the time limit are skipped.
constexpr double kGrowth = 2.0;
/// Begins the outcome of a run that its method refused.
constexpr const char* kRefused = "refused: ";

/// The reference as an input of a row: its origin, and the bits of its values.
std::string text_of(const Reference& reference) {
  std::string text = reference.origin + to_text(reference.horizon);
  for (const std::vector<double>& column : reference.values)
    text.append(reinterpret_cast<const char*>(column.data()), column.size() * sizeof(double));
  return text;
}

/// The names of scenes: those of their files, with a number behind a name that was there before.
std::vector<std::string> names_of(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const std::string stem = std::filesystem::path(file).stem().string();
    std::string name = stem;
    for (int number = 2; std::find(names.begin(), names.end(), name) != names.end(); ++number)
      name = stem + "-" + std::to_string(number);
    names.push_back(std::move(name));
  }
  return names;
}

struct CompareArguments {
  ModelArguments model;  ///< a model or a study
  std::string folder;    ///< empty: "<stem>-compare"
  bool fresh = false;    ///< repeats all runs
};

class Comparison {
 public:
  Comparison(const CompareArguments& arguments, Study study)
      : arguments_(arguments), study_(std::move(study)), folder_(arguments.folder) {
    if (folder_.empty()) folder_ = std::filesystem::path(arguments.model.model).stem().string() + "-compare";
  }

  int perform() {
    const record::ResultFolder folder(folder_);
    folder.check_holds_no_run();
    std::vector<Prepared> scenes;
    const std::vector<std::string> names = names_of(study_.scenes);
    for (std::size_t i = 0; i < study_.scenes.size(); ++i) {
      scenes.push_back(prepare(i));
      scenes.back().name = names[i];
    }
    const record::FolderLock lock = folder.lock();
    const std::string runs = folder.file("runs.csv");
    if (!arguments_.fresh) kept_ = read_csv(runs);
    folder.prepare("# the scenes of a comparison are named in report.md\n");
    watch_for_interruption();
    std::vector<SceneResult> results;
    for (Prepared& scene : scenes) {
      if (interruption() != nullptr) break;
      results.push_back(compare_scene(scene));
      write(results);
    }
    const auto has_run = [](const SceneResult& result) {
      return std::any_of(result.rows.begin(), result.rows.end(),
                         [](const Row& row) { return !row.outcome.starts_with(kRefused); });
    };
    if (interruption() == nullptr) {
      if (std::any_of(results.begin(), results.end(), has_run)) return kDone;
      log::warning("no method could run; the reasons are in " + runs);
      return kFailed;
    }
    log::warning("interrupted; completed runs are in " + folder_ + "; the same command continues from there");
    return kFailed;
  }

 private:
  struct Prepared {
    std::string name;
    config::Document document;
    scene::Scene session;
    Question question;
    std::vector<Sweep> sweeps;
  };

  Prepared prepare(std::size_t scene) {
    config::Document document = config::load_toml(study_.scenes[scene]);
    for (const std::string& assignment : study_.overrides) config::apply_override(document, assignment);
    if (study_.end_time) config::apply_override(document, "integrator.end_time=" + to_text(*study_.end_time));
    if (!study_.end_times.empty())
      config::apply_override(document, "integrator.end_time=" + to_text(study_.end_times[scene]));
    scene::Scene session = scene::read_scene(document, plugin::Catalogue::with_plugins(arguments_.model.plugins));
    for (const std::string& warning : session.warnings) log::warning(warning);
    document = session.document;
    Question question = question_of(session, study_.quantities);
    const model::System system = assemble(session.model);
    const auto range = frequency_range(system, dynamics::StopState::closed);
    auto sweeps =
        complete_sweeps(study_, session.catalogue, range ? range->highest : 0.0, session.integrator.options.end_time);
    return {"", std::move(document), std::move(session), std::move(question), std::move(sweeps)};
  }

  SceneResult compare_scene(Prepared& scene) {
    SceneResult result;
    result.scene = scene.name;
    result.title = scene.session.model.title;
    result.column = join(scene.question.columns);
    result.end_time = scene.session.integrator.options.end_time;
    log::info(result.scene + ": reference");
    result.reference = find_reference(study_, scene.document, scene.session.catalogue, scene.question);
    const Reference& reference = result.reference;
    log::info(result.scene + ": reference by " + reference.origin +
              (reference.method.empty() ? "" : ", uncertainty " + to_short_text(reference.uncertainty)) +
              (reference.parted ? ", trusted to t = " + to_short_text(reference.horizon) + " s" : ""));
    for (std::size_t i = 0; i < reference.values.size(); ++i)
      if (!reference.values[i].empty() &&
          std::all_of(reference.values[i].begin(), reference.values[i].end(), [](double y) { return y == 0.0; }))
        log::warning(result.scene + ": " + scene.question.columns[i] +
                     " is zero throughout the reference: there is no relative error of it, and a run that differs "
                     "has an infinite one");
    if (!reference.is_usable()) {
      log::warning(result.scene +
                   ": two computations of the reference differ from the start on, so that no error can be "
                   "measured; compare other columns ([study] quantity), or give a reference as a file");
      return result;
    }
    reference_text_ = text_of(reference);
    for (const Sweep& sweep : scene.sweeps) run_sweep(scene, sweep, result);
    return result;
  }

  void run_sweep(Prepared& scene, const Sweep& sweep, SceneResult& result) {
    const double finest = *std::min_element(study_.targets.begin(), study_.targets.end()) * kFineEnough;
    const double floor = std::max(finest, result.reference.uncertainty);
    double last_seconds = 0.0;
    for (const double value : sweep.values) {
      if (interruption() != nullptr || last_seconds * kGrowth > study_.time_limit) return;
      Row row;
      try {
        row = run(scene, sweep, value, result);
      } catch (const InputError& error) {
        const bool is_first = value == sweep.values.front();
        const std::string says = name_of(result.scene, sweep.method, sweep.knob, value) + ": " + error.what();
        // Some of all installed methods do not suit a scene; one that the study names should.
        if (study_.sweeps.empty())
          log::info(says);
        else
          log::warning(says);
        // Later values are below the smallest one of the method for this scene.
        if (is_first) result.rows.push_back(refused(result.scene, sweep, value, error.what()));
        return;
      }
      if (row.outcome == "interrupted") return;
      log::info(describe(row));
      last_seconds = row.outcome == "too slow" ? study_.time_limit : row.seconds;
      const bool fine = row.completed() && row.error.rms <= floor;
      result.rows.push_back(std::move(row));
      if (!fine) continue;
      if (const auto skipped = sweep.values.end() - std::find(sweep.values.begin(), sweep.values.end(), value) - 1;
          skipped > 0)
        log::info(result.scene + ": " + sweep.method + ": " + std::to_string(skipped) +
                  " finer values are not run, as this error is below what the targets need");
      return;
    }
  }

  static Row refused(const std::string& scene, const Sweep& sweep, double value, const std::string& reason) {
    Row row;
    row.scene = scene;
    row.method = sweep.method;
    row.knob = sweep.knob;
    row.value = value;
    row.outcome = kRefused + reason;
    return row;
  }

  Row run(Prepared& scene, const Sweep& sweep, double value, const SceneResult& result) {
    const time::IntegratorType& type = scene.session.catalogue.load(sweep.method);
    config::Document document = with_method(scene.document, type, sweep, value);
    Row row;
    row.scene = result.scene;
    row.method = sweep.method;
    row.knob = sweep.knob;
    row.value = value;
    row.fingerprint = config::checksum_text(
        BUTEE_VERSION + target() + compiled_for() + build_of(*scene.session.catalogue.find(sweep.method)) +
        config::write_toml(config::with_files_found_from(document, ".")) + result.column + reference_text_);
    const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const Row& other) {
      return other.fingerprint == row.fingerprint && other.scene == row.scene && other.outcome != "too slow";
    });
    if (known != kept_.end()) return *known;
    scene::Scene session = scene::read_scene(std::move(document), scene.session.catalogue);
    const Answer answer = measure(session, scene.question, study_.time_limit);
    if (!answer.completed) row.outcome = answer.message;
    row.error = error_of(answer.values, result.reference);
    // For the reference's own method, the error is known only as the uncertainty.
    if (row.method == result.reference.method) {
      row.error.rms = std::max(row.error.rms, result.reference.uncertainty);
      row.error.largest = std::max(row.error.largest, result.reference.uncertainty);
    }
    row.seconds = answer.seconds;
    row.steps = answer.report.steps;
    row.rejected = answer.report.rejected;
    row.newton = answer.report.newton_iterations;
    row.factorizations = answer.counters.factorizations;
    row.solves = answer.counters.solves;
    row.contact_evaluations = answer.counters.contact_evaluations;
    row.force_evaluations = answer.counters.force_evaluations;
    return row;
  }

  /// The checksums of the library and of a method's module.
  static std::string build_of(const plugin::IntegratorEntry& entry) {
    std::string all;
    for (const std::string& file : {plugin::library_file(), entry.module})
      if (!file.empty() && std::filesystem::exists(file)) all += config::checksum_text(config::read_text(file));
    return all;
  }

  static std::string name_of(const std::string& scene, const std::string& method, const std::string& knob,
                             double value) {
    return scene + ": " + method + (knob.empty() ? "" : ", " + knob + " = " + to_short_text(value));
  }

  static std::string describe(const Row& row) {
    const std::string name = name_of(row.scene, row.method, row.knob, row.value) + ": ";
    if (!row.completed()) return name + row.outcome;
    return name + "error " + to_short_text(row.error.rms) + ", " + to_short_text(row.seconds * 1e3) + " ms";
  }

  void write(const std::vector<SceneResult>& results) {
    const record::ResultFolder folder(folder_);
    std::string csv = csv_header() + "\n";
    for (const SceneResult& result : results)
      for (const Row& row : result.rows) csv += csv_line(row) + "\n";
    // Rows of an earlier call that this one has not reached are kept for the next.
    const auto is_new = [&](const Row& row) {
      return std::any_of(results.begin(), results.end(), [&](const SceneResult& result) {
        return std::any_of(result.rows.begin(), result.rows.end(), [&](const Row& other) {
          return other.scene == row.scene && other.method == row.method && other.knob == row.knob &&
                 other.value == row.value;
        });
      });
    };
    for (const Row& row : kept_)
      if (!is_new(row)) csv += csv_line(row) + "\n";
    folder.write("runs.csv", csv);
    bool drawn = true;
    for (const SceneResult& result : results) drawn = draw(result, folder_) && drawn;
    folder.write("report.md", markdown(study_, results, "butee compare " + arguments_.model.model));
    if (!drawn) log::warning("gnuplot could not draw; its scripts are in " + folder_ + " (Debian: gnuplot-nox)");
    for (const double target : study_.targets)
      if (const Row* best = fastest_beyond_doubt(results.back(), target))
        std::printf("error up to %s: %s\n", to_short_text(target).c_str(), describe(*best).c_str());
    std::printf("%s: report in %s/report.md\n", results.back().scene.c_str(), folder_.c_str());
  }

  const CompareArguments& arguments_;
  Study study_;
  std::string folder_;
  std::vector<Row> kept_;
  std::string reference_text_;  ///< of the scene that is compared
};

}  // namespace

Command add_compare_command(CLI::App& program) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* app = program.add_subcommand("compare", "run time against error of several integrators");
  add_model_arguments(*app, arguments->model);
  app->add_option("-o,--output", arguments->folder, "the folder for the results; default <stem>-compare")
      ->type_name("DIR");
  app->add_flag("--fresh", arguments->fresh, "run everything again, without the results of an earlier call");
  add_log_options(*app, false);
  return {app, [arguments] { return Comparison(*arguments, read_study(arguments->model)).perform(); }};
}

}  // namespace butee::app
