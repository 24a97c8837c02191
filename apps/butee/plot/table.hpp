#pragma once

#include <limits>
#include <string>
#include <vector>

namespace butee::app::plot {

/// A part of a run, s.
struct Window {
  double from = -std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();
};

/// Columns of numbers by name, the first of them t in s.
class Table {
 public:
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
  const std::vector<double>& times() const { return columns.front(); }
  /// nullptr where there is none of that name.
  const std::vector<double>* find(const std::string& name) const;
};

/// Reads the rows of a CSV file within the window. A last line cut short, or a row with an empty cell, is left out.
/// Throws InputError where the file cannot be read or is no such table.
Table read_table(const std::string& path, Window window);

}  // namespace butee::app::plot
