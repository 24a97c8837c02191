#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "butee/record/checkpoint.hpp"
#include "butee/record/contact_recorder.hpp"
#include "butee/record/field_recorder.hpp"
#include "butee/record/history.hpp"
#include "butee/record/impacts.hpp"
#include "butee/record/progress.hpp"
#include "butee/record/slip_watch.hpp"
#include "butee/record/state_keeper.hpp"
#include "butee/record/summary.hpp"
#include "butee/run/checkpointer.hpp"
#include "butee/scene/assembly.hpp"

namespace butee::run {

/// Rows of a history within the shortest contact that are needed to show its time history.
inline constexpr double kRowsInContact = 4.0;

/// One integration of a scene from assembly to the end, with the output requested by [output]: in
/// files, in memory, or both.
class BUTEE_EXPORT Run {
 public:
  /// Assembles and computes the first factorization; nothing is written yet. Throws InputError if
  /// the scene cannot be run.
  Run(scene::Scene& scene, bool with_progress);

  /// Adds an observer of the integration, which must outlive this object. To be called before
  /// perform().
  void add(time::Observer& observer) { assembly_.simulation.add(observer); }
  /// Also writes the rows of the history, and those of the energies if [output] requests them, to
  /// these writers, which must outlive this object. To be called before perform().
  void also_to(model::FieldWriter& history, model::FieldWriter& energy) {
    other_history_ = &history;
    other_energy_ = &energy;
  }
  /// Sets a function that is called after every step and returns the cause of an interruption, such
  /// as "SIGINT", or nullptr. An interrupted run counts as failed; a checkpoint is written if the
  /// scene requests checkpoints.
  void interrupt_by(std::function<const char*()> interruption) { interruption_ = std::move(interruption); }
  /// Sets a function that is called after every step; if it returns true the run is left as it is,
  /// neither completed nor failed.
  void stop_when(std::function<bool()> is_enough) { is_enough_ = std::move(is_enough); }
  scene::Assembly& assembly() { return assembly_; }

  /// Integrates; files are written to `folder` if it is given. Continues from a checkpoint of the
  /// folder if `from` is given. The report in the summary gives the reason for an early end.
  record::Summary perform(const record::ResultFolder* folder, const record::Checkpoint* from = nullptr);
  /// Valid after perform(), in the order of t_in; empty if [output] does not request them.
  std::vector<record::Impact> impacts() const;
  /// The recorder of contacts in the plane, with dissipation or friction; null if the scene has
  /// none.
  const record::ContactRecorder* contacts() const { return contacts_ ? &*contacts_ : nullptr; }

 private:
  Run(scene::Scene& scene, bool with_progress, std::chrono::steady_clock::time_point begin);
  void attach_observers(const record::ResultFolder* folder, const record::Checkpoint* from);
  void add_fields(const record::ResultFolder& folder);
  void integrate();
  void summarize();
  /// Warns if the tolerance does not resolve the sense of friction.
  void look_at_slips();
  /// Warns of loads that change faster than fixed steps.
  void look_at_balance();
  void look_at_loads();
  /// Warns if fixed steps of a small system were longer than the critical one.
  void look_at_stability();
  /// Warns if a force was requested and rows are too far apart to show it.
  void look_at_rows();
  void write_files(const record::ResultFolder& folder);
  void fail(const std::string& reason);
  /// Does the work; an exception becomes the report of a failed run.
  template <class Work>
  void guarded(Work work);

  scene::Scene& scene_;
  bool with_progress_;
  scene::Assembly assembly_;
  std::function<bool()> is_enough_;
  std::function<const char*()> interruption_;
  model::FieldWriter* other_history_ = nullptr;
  model::FieldWriter* other_energy_ = nullptr;
  record::Summary summary_;
  std::optional<record::CsvWriter> writer_, energy_writer_;
  std::optional<record::HistoryRecorder> history_;
  std::optional<record::EnergyRecorder> energy_;
  std::optional<record::ImpactRecorder> impacts_;
  std::optional<record::ContactRecorder> contacts_;  ///< if the scene has obstacles
  std::optional<record::SlipWatch> slips_;           ///< if the scene has obstacles and a tolerance
  std::optional<record::Progress> progress_;
  std::optional<record::FieldRecorder> fields_;
  std::optional<record::StateKeeper> states_;
  std::optional<Checkpointer> checkpointer_;
};

}  // namespace butee::run
