#include "butee/run/checkpointer.hpp"

#include <algorithm>
#include <chrono>

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"
#include "butee/core/text.hpp"

namespace butee::run {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

}  // namespace

void check_checkpoints(scene::Scene& scene) {
  if (scene.output.checkpoint == 0) return;
  const time::IntegratorType& type = scene.catalogue.load(scene.integrator.name);
  const config::Value& given = *scene.document.root.table()->find("output")->table()->find("checkpoint");
  const std::string key = describe(scene.document, given.at) + ": output.checkpoint: ";
  if (!scene.output.fields.formats.empty())
    throw InputError(key + "a run that writes fields (output.formats: " + join(scene.output.fields.formats) +
                     ") cannot resume from a checkpoint; remove one of the two");
  if (type.restarts_exactly) return;
  throw InputError(key + type.name +
                   " has an internal history that checkpoints do not contain, so a resumed run would not be identical "
                   "to the last bit; remove checkpoint, or use another method");
}

Checkpointer::Checkpointer(const scene::Scene& scene, scene::Assembly& assembly, const record::ResultFolder& folder,
                           record::CsvWriter& history)
    : assembly_(assembly), folder_(folder), history_(history), every_(scene.output.checkpoint) {
  next_.method = scene.integrator.name;
  next_.model = folder.checksum_of("model.toml");
}

void Checkpointer::go_on_from(const record::Checkpoint& checkpoint) {
  before_ = checkpoint.counters;
  next_.setup_seconds += checkpoint.setup_seconds;
  written_at_ = checkpoint.snapshot.report.steps;
}

linalg::Counters Checkpointer::counters() const {
  return before_ + assembly_.dynamics.counters();
}

void Checkpointer::write() {
  const auto begin = Clock::now();
  const auto file_seconds = [this] { return history_.seconds() + (other_ != nullptr ? other_->seconds() : 0.0); };
  const double file_seconds_before = file_seconds();
  written_at_ = assembly_.simulation.report().steps;
  history_.sync();
  if (other_ != nullptr) other_->sync();
  next_.history = history_.position();
  next_.counters = counters();
  assembly_.simulation.take_snapshot(next_.snapshot);
  next_.snapshot.report.wall_seconds += seconds_since(begin_) - seconds_ - file_seconds();
  try {
    folder_.write(next_);
  } catch (const RunError& error) {
    log::warning(std::string(error.what()) + "; the run goes on, and the checkpoint before this one is kept");
  }
  // The time of the writers is counted by their own recorders.
  seconds_ += seconds_since(begin) - (file_seconds() - file_seconds_before);
}

}  // namespace butee::run
