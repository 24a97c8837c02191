#pragma once

#include <limits>
#include <string>
#include <vector>

namespace butee::app::plot {

/// Time window of a run, s.
struct Window {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

/// Named columns of numbers; the first is t in s.
class Table {
 public:
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  const std::vector<double>& times() const { return columns.front(); }
  /// nullptr if there is no column of that name.
  const std::vector<double>* find(const std::string& name) const;
};

/// Reads the rows of a CSV file within the window. An incomplete last line and rows with an empty cell are
/// skipped. Throws InputError if the file cannot be read or is not such a table.
Table read_table(const std::string& path, Window window);

}  // namespace butee::app::plot
