#pragma once

#include <chrono>

#include "butee/record/checkpoint.hpp"
#include "butee/record/csv_writer.hpp"
#include "butee/scene/assembly.hpp"

namespace butee::run {

/// Throws InputError where [output] asks for checkpoints of a method that cannot go on from them bit for bit.
BUTEE_EXPORT void check_checkpoints(scene::Scene& scene);

/// Keeps a run on disk after every so manyth step.
class BUTEE_EXPORT Checkpointer final : public time::Observer {
 public:
  /// All must outlive it.
  Checkpointer(const scene::Scene& scene, scene::Assembly& assembly, const record::ResultFolder& folder,
               record::CsvWriter& history);

  /// Another file that has to be on the device before a checkpoint counts on it; it must outlive this.
  void also_sync(record::CsvWriter& writer) { other_ = &writer; }

  /// What the run had cost when it was taken up again, and has now.
  void go_on_from(const record::Checkpoint& checkpoint);
  void set_setup_seconds(double seconds) { next_.setup_seconds = seconds; }
  linalg::Counters counters() const;

  void step(const time::AcceptedStep&) override { ++since_; }
  double file_seconds() const override { return seconds_; }

  bool is_due() const { return since_ >= every_; }
  /// Between two steps.
  void write();
  /// After the end of a run that is not to go on.
  void clear() const { folder_.clear(); }

 private:
  scene::Assembly& assembly_;
  record::CheckpointFolder folder_;
  record::CsvWriter& history_;
  record::CsvWriter* other_ = nullptr;
  std::int64_t every_, since_ = 0;
  record::Checkpoint next_;
  linalg::Counters before_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double seconds_ = 0.0;  ///< spent here
};

}  // namespace butee::run
