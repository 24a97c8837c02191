#include "table.hpp"

#include <charconv>
#include <fstream>
#include <sstream>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/study/table.hpp>

namespace butee::app::plot {
namespace {

/// Reads exactly `row.size()` numbers; returns false if the line holds anything else.
bool parse(const std::string& line, std::vector<double>& row) {
  const char* at = line.data();
  const char* const end = at + line.size();
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, row[i]);
    if (error != std::errc()) return false;
    const bool last = i + 1 == row.size();
    if (last ? next != end : (next == end || *next != ',')) return false;
    at = next + 1;
  }
  return true;
}

}  // namespace

const std::vector<double>* Table::find(const std::string& name) const {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return &columns[i];
  return nullptr;
}

Table read_table(const std::string& path, Window window) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  Table table;
  if (!file || !std::getline(file, line)) throw InputError(path + ": cannot be read, or is empty");
  table.names = study::cells_of(line);
  if (table.names.empty() || table.names.front() != "t") throw InputError(path + ": its first column is not t");
  table.columns.resize(table.names.size());
  std::vector<double> row(table.names.size());
  std::int64_t number = 1, broken = 0, first_broken = 0;
  while (std::getline(file, line)) {
    if (file.eof()) break;  // incomplete last line
    ++number;
    if (!parse(line, row)) {
      if (++broken == 1) first_broken = number;
      continue;
    }
    if (row.front() < window.from || row.front() > window.to) continue;
    for (std::size_t i = 0; i < row.size(); ++i) table.columns[i].push_back(row[i]);
  }
  if (broken > 0)
    log::warning(path + ":" + std::to_string(first_broken) + ": is not a row of " + std::to_string(row.size()) +
                 " numbers; left out of the pictures" +
                 (broken > 1 ? " with " + std::to_string(broken - 1) + " more" : ""));
  return table;
}

}  // namespace butee::app::plot
