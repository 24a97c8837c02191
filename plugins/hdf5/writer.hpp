#pragma once

#include <chrono>

#include "history_rows.hpp"
#include "xdmf.hpp"

namespace butee::plugins::hdf5 {

/// Writes fields.h5, with the rows of history.csv, and fields.xdmf.
///
/// Records are buffered in memory until they fill a chunk of about a megabyte for each field (or
/// one record if it is larger), or until two seconds have passed and there are as many of them as
/// the last chunk on disk holds already. All metadata follow at once, at most twice per second, and
/// fields.xdmf after them. Space is never reused, and no metadata are written in between, so that a
/// run that is killed leaves a readable file, unless it is killed while the metadata are written.
class FieldFile final : public model::FieldWriter {
 public:
  FieldFile(const std::string& folder, const model::FieldLayout& layout);

  void append(double t, std::span<const double> values) override;
  void append_row(std::span<const double> values) override;
  void finish() override;

 private:
  using Clock = std::chrono::steady_clock;

  void write_layout(const model::FieldLayout& layout);
  void make_datasets(const model::FieldLayout& layout);
  /// Hands the buffered records to the library.
  void commit();
  /// Writes the metadata of all that was committed.
  void flush();
  /// flush() and fields.xdmf, if there is something new and the last time is long enough ago.
  void flush_if_due();

  std::size_t nodes_, fields_, rows_;  ///< rows_: records per chunk
  Handle file_, time_;
  std::vector<Handle> sets_;
  HistoryRows history_;
  XdmfFile xdmf_;
  std::size_t records_ = 0;              ///< number of records committed
  std::vector<double> times_, waiting_;  ///< waiting_: one field after another, each with rows_ records
  Clock::time_point committed_ = Clock::now(), flushed_ = committed_;
  bool is_flushed_ = true;
};

}  // namespace butee::plugins::hdf5
