#pragma once

#include <chrono>

#include "butee/record/checkpoint.hpp"
#include "butee/record/csv_writer.hpp"
#include "butee/scene/assembly.hpp"

namespace butee::run {

/// Throws InputError if [output] requests checkpoints of a method that cannot continue from them
/// bit for bit.
BUTEE_EXPORT void check_checkpoints(scene::Scene& scene);

/// Writes a checkpoint of a run after every [output] checkpoint steps.
class BUTEE_EXPORT Checkpointer final : public time::Observer {
 public:
  /// All arguments must outlive this object.
  Checkpointer(const scene::Scene& scene, scene::Assembly& assembly, const record::ResultFolder& folder,
               record::CsvWriter& history);

  /// Adds another file that must be on the device before a checkpoint refers to it; it must outlive
  /// this object.
  void also_sync(record::CsvWriter& writer) { other_ = &writer; }

  /// Takes over the costs of the run before it was continued from `checkpoint`.
  void go_on_from(const record::Checkpoint& checkpoint);
  void set_setup_seconds(double seconds) { next_.setup_seconds = seconds; }
  linalg::Counters counters() const;

  void step(const time::AcceptedStep&) override {}
  double file_seconds() const override { return seconds_; }

  /// Some methods take many steps between two states that a run can continue from.
  bool is_due() const { return assembly_.simulation.report().steps - written_at_ >= every_; }
  /// To be called between two steps.
  void write();
  /// To be called after the end of a run that will not be continued.
  void clear() const { folder_.clear(); }

 private:
  scene::Assembly& assembly_;
  record::CheckpointFolder folder_;
  record::CsvWriter& history_;
  record::CsvWriter* other_ = nullptr;
  std::int64_t every_, written_at_ = 0;  ///< steps
  record::Checkpoint next_;
  linalg::Counters before_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double seconds_ = 0.0;  ///< s, spent here
};

}  // namespace butee::run
