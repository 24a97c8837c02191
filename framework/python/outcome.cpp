#include "butee/python/outcome.hpp"

#include <cmath>
#include <filesystem>
#include <optional>

#include "butee/config/file_reference.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/record/result_folder.hpp"
#include "butee/run/check_start.hpp"
#include "butee/run/run.hpp"

namespace butee::python {
namespace {

/// The largest number of rows for which memory is reserved in advance.
constexpr double kMostReserved = 1e6;

void reserve(Columns& columns, const scene::Scene& scene) {
  if (!scene.output.interval) return;
  const double rows = scene.integrator.options.end_time / *scene.output.interval + 2.0;
  if (!(rows < kMostReserved)) return;
  for (auto& column : columns.values) column.reserve(static_cast<std::size_t>(rows));
}

std::string wear_of(const record::ContactRecorder* contacts) {
  if (contacts == nullptr) return "";
  std::string text = join(record::ContactRecorder::wear_columns(), ",") + "\n";
  for (const record::ContactWear& wear : contacts->wear()) text += contacts->wear_line(wear) + "\n";
  return text;
}

/// The folder of a run, locked and with its model.toml.
class Files {
 public:
  Files(const scene::Scene& scene, const RunOptions& options) : folder_(options.folder), lock_(folder_.lock()) {
    const std::string model = config::write_toml(config::with_files_found_from(scene.document, folder_.path()));
    if (options.resumes && std::filesystem::exists(folder_.file("model.toml"))) {
      if (!config::read_text(folder_.file("model.toml")).ends_with("\n" + model))
        throw InputError(folder_.path() +
                         ": the run in this folder is of another scene and cannot be resumed with this one");
      checkpoint_ = record::CheckpointFolder(folder_).newest();
    }
    if (!checkpoint_) folder_.prepare(model);
  }

  const record::ResultFolder& folder() const { return folder_; }
  const record::Checkpoint* checkpoint() const { return checkpoint_ ? &*checkpoint_ : nullptr; }

  void finish(const Outcome& outcome) const {
    folder_.write("summary.json", outcome.summary);
    if (outcome.completed) record::CheckpointFolder(folder_).clear();
  }

 private:
  record::ResultFolder folder_;
  record::FolderLock lock_;
  std::optional<record::Checkpoint> checkpoint_;
};

}  // namespace

std::shared_ptr<Outcome> perform(scene::Scene& scene, const RunOptions& options, Watch& watch) {
  auto outcome = std::make_shared<Outcome>();
  outcome->title = scene.model.title;
  outcome->history = Columns(record::HistoryRecorder::columns(scene.output));
  outcome->energy = Columns(record::EnergyRecorder::columns());
  reserve(outcome->history, scene);
  if (!options.folder.empty()) {
    run::check_checkpoints(scene);
    run::check_start(scene, record::ResultFolder(options.folder));
  }
  run::Run run(scene, options.progress_bar);
  run.also_to(outcome->history, outcome->energy);
  const time::Simulation& simulation = run.assembly().simulation;
  run.interrupt_by([&] { return watch.look(simulation.state().t); });
  std::optional<Files> files;
  if (!options.folder.empty()) files.emplace(scene, options);
  const record::Summary summary =
      run.perform(files ? &files->folder() : nullptr, files ? files->checkpoint() : nullptr);
  outcome->completed = summary.report.completed;
  outcome->message = summary.report.message;
  outcome->warnings = summary.report.warnings;
  outcome->impacts = run.impacts();
  outcome->wear = wear_of(run.contacts());
  outcome->summary = record::to_json(summary);
  if (files) files->finish(*outcome);
  return outcome;
}

}  // namespace butee::python
