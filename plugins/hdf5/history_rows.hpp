#pragma once

#include <span>

#include <butee/model/field_format.hpp>

#include "growing.hpp"

namespace butee::plugins::hdf5 {

/// The group /probes: one dataset for each column of history.csv, with the same name and its unit.
///
/// Rows are buffered in memory until they fill a chunk, or until two seconds have passed and there
/// are as many of them as the last chunk on disk holds already. Readers see them after the next
/// flush of the file.
class HistoryRows {
 public:
  HistoryRows() = default;
  /// Creates the group and its datasets. `file` must outlive it.
  HistoryRows(hid_t file, const std::vector<model::Field>& columns);

  /// Appends one value for each column. True if rows were passed to the library.
  bool append(std::span<const double> values);
  /// Passes the buffered rows to the library.
  void commit();
  /// Closes the datasets; false if that failed.
  bool close();

 private:
  using Clock = std::chrono::steady_clock;

  std::vector<Handle> sets_;
  std::size_t rows_ = 0, waiting_rows_ = 0;  ///< number of rows passed to the library, and of rows in memory
  std::vector<double> waiting_;              ///< column by column
  Clock::time_point committed_ = Clock::now();
};

}  // namespace butee::plugins::hdf5
