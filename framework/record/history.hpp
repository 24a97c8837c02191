#pragma once

#include <map>

#include "butee/model/field_format.hpp"
#include "butee/record/csv_writer.hpp"
#include "butee/record/output_times.hpp"
#include "butee/record/peaks.hpp"
#include "butee/record/probes.hpp"
#include "butee/record/sampled_peaks.hpp"

namespace butee::record {

/// Samples the probes at the output times, independent of the steps, and records their peaks over
/// the whole motion.
///
/// A row at time t is interpolated in the accepted step (t_n, t_n+1] that contains it, the row at
/// t = 0 in the first step.
class BUTEE_EXPORT HistoryRecorder final : public time::Observer {
 public:
  /// Rows are written to `writer`, unless it is nullptr. All arguments must outlive the recorder.
  HistoryRecorder(const model::OutputRequest& request, double end_time, dynamics::Dynamics& dynamics,
                  CsvWriter* writer);

  /// Also writes rows to `writer`, which must outlive the recorder's last row. To be called before
  /// the first step.
  void also_to(model::FieldWriter& writer) { writers_.push_back(&writer); }

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  void finish() override;
  double next_instant(double t) const override { return times_.next_instant(t); }
  bool watches_every_step() const override { return times_.counts_steps(); }
  void save(ByteWriter& to) const override;
  void restore(ByteReader& from) override;
  double file_seconds() const override { return seconds_ + (writer_ != nullptr ? writer_->seconds() : 0.0); }

  /// "t", the probes' columns, "h"
  static std::vector<std::string> columns(const model::OutputRequest& request);
  /// The same with their units; without a model contact_force has that of a force.
  static std::vector<model::Field> columns_with_units(const model::OutputRequest& request, const model::Model* model);

  /// Largest |value| by column: over the whole motion (Peaks, SampledPeaks) and the rows; for
  /// forces of elements over the rows only. u of every probe is always included.
  std::map<std::string, double> peaks() const;

 private:
  void write_due(const time::AcceptedStep& step);
  void take_largest();
  void write_row(double t, double h);

  OutputTimes times_;
  Probes probes_;
  Peaks peaks_;
  SampledPeaks contact_peaks_, framed_peaks_;
  CsvWriter* writer_;
  std::vector<model::FieldWriter*> writers_;
  double seconds_ = 0.0;  ///< s, spent in writers_
  double start_time_ = 0.0;
  std::vector<double> row_, first_row_;
  std::vector<double> due_;               ///< instants of rows within a step
  std::vector<double> values_, largest_;  ///< of probes_, in a row and the largest of all rows
};

}  // namespace butee::record
