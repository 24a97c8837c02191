#pragma once

#include <chrono>

#include "history_rows.hpp"
#include "xdmf.hpp"

namespace butee::plugins::hdf5 {

/// Writes fields.h5, with the rows of history.csv, and fields.xdmf.
///
/// Records wait in memory until they fill a chunk of about a megabyte for each field (a single record where that is
/// more), or for two seconds and as many as the chunk on disk holds already. They then go to disk data first, metadata
/// last and at once: space is never used twice and nothing of what describes the file is written in between, so that a
/// run that is killed leaves a file that can be read.
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
  /// Puts the waiting records on disk.
  void commit();
  void flush();

  std::size_t nodes_, fields_, rows_;  ///< of a chunk
  Handle file_, time_;
  std::vector<Handle> sets_;
  HistoryRows history_;
  XdmfFile xdmf_;
  std::size_t records_ = 0;              ///< on disk
  std::vector<double> times_, waiting_;  ///< field by field, each with rows_ records
  Clock::time_point committed_ = Clock::now(), flushed_ = committed_;
};

}  // namespace butee::plugins::hdf5
