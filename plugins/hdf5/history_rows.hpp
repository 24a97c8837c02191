#pragma once

#include <span>

#include <butee/model/field_format.hpp>

#include "growing.hpp"

namespace butee::plugins::hdf5 {

/// The group /probes: a dataset for each column of history.csv, of the same name, with its unit.
///
/// Rows wait in memory until they fill a chunk, or for two seconds and as many as the chunk on disk holds already. They
/// are seen by others when the file is flushed next.
class HistoryRows {
 public:
  HistoryRows() = default;
  /// Makes the group and its datasets. `file` stays open longer.
  HistoryRows(hid_t file, const std::vector<model::Field>& columns);

  /// One value for each column. True where rows were handed to the library.
  bool append(std::span<const double> values);
  /// Hands the waiting rows to the library.
  void commit();
  /// False where that failed.
  bool close();

 private:
  using Clock = std::chrono::steady_clock;

  std::vector<Handle> sets_;
  std::size_t rows_ = 0, waiting_rows_ = 0;  ///< handed over, in memory
  std::vector<double> waiting_;              ///< column by column
  Clock::time_point committed_ = Clock::now();
};

}  // namespace butee::plugins::hdf5
