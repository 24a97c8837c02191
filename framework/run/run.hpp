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

/// Rows of a history within the shortest contact that show its course.
inline constexpr double kRowsInContact = 4.0;

/// One integration of a scene from assembly to the end, with what [output] asks for: in files, in memory, or both.
class BUTEE_EXPORT Run {
 public:
  /// Assembles and takes the first factorization; nothing is written yet. Throws InputError where the scene cannot be
  /// run.
  Run(scene::Scene& scene, bool with_progress);

  /// Watches the integration too; must outlive it. Before perform().
  void add(time::Observer& observer) { assembly_.simulation.add(observer); }
  /// The rows of the history go there too, and those of the energies where [output] asks for them; writers must outlive
  /// it. Before perform().
  void also_to(model::FieldWriter& history, model::FieldWriter& energy) {
    other_history_ = &history;
    other_energy_ = &energy;
  }
  /// Asked after every step for what interrupts the run, such as "SIGINT"; nullptr where nothing does. The run then
  /// counts as failed, and a checkpoint is written where the scene asks for them.
  void interrupt_by(std::function<const char*()> interruption) { interruption_ = std::move(interruption); }
  /// Asked after every step whether to leave the run as it stands, neither completed nor failed.
  void stop_when(std::function<bool()> is_enough) { is_enough_ = std::move(is_enough); }
  scene::Assembly& assembly() { return assembly_; }

  /// Integrates; the files go to `folder` where one is given. Goes on from a checkpoint of the folder where one is
  /// given. Whatever ends the integration early is told by the summary's report.
  record::Summary perform(const record::ResultFolder* folder, const record::Checkpoint* from = nullptr);
  /// After perform(), in the order of t_in; none where [output] does not ask for them.
  std::vector<record::Impact> impacts() const;
  /// What followed contacts in the plane, with dissipation or friction; null where the scene has none.
  const record::ContactRecorder* contacts() const { return contacts_ ? &*contacts_ : nullptr; }

 private:
  Run(scene::Scene& scene, bool with_progress, std::chrono::steady_clock::time_point begin);
  void attach_observers(const record::ResultFolder* folder, const record::Checkpoint* from);
  void add_fields(const record::ResultFolder& folder);
  void integrate();
  void summarize();
  /// Warns where the tolerance does not resolve the sense of friction.
  void look_at_slips();
  /// Warns where a force was asked for and rows are too far apart to show it.
  void look_at_rows();
  void write_files(const record::ResultFolder& folder);
  void fail(const std::string& reason);
  /// Does the work; what it throws becomes the report of a failed run.
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
  std::optional<record::ContactRecorder> contacts_;  ///< where the scene has obstacles
  std::optional<record::SlipWatch> slips_;           ///< there, where a tolerance is kept
  std::optional<record::Progress> progress_;
  std::optional<record::FieldRecorder> fields_;
  std::optional<record::StateKeeper> states_;
  std::optional<Checkpointer> checkpointer_;
};

}  // namespace butee::run
