#include "butee/study/points.hpp"

#include <sstream>
#include <string_view>

#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/study/table.hpp"

namespace butee::study {
namespace {

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t\r");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

}  // namespace

PointTable read_points(const std::string& text) {
  PointTable table;
  // Excel begins a CSV file in UTF-8 with a byte-order mark.
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  std::istringstream lines(text.starts_with(kMark) ? text.substr(kMark.size()) : text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    std::vector<std::string> cells = cells_of(line);
    for (std::string& cell : cells) cell = trimmed(cell);
    if (table.names.empty()) {
      if (cells.size() == 1 && line.find(';') != std::string::npos)
        throw InputError("line " + std::to_string(number) + " separates names by semicolons; use commas, and points in "
                         "numbers");
      table.names = std::move(cells);
      continue;
    }
    if (cells.size() != table.names.size())
      throw InputError("line " + std::to_string(number) + " needs a cell for each of the " +
                       std::to_string(table.names.size()) + " columns that the first line names; it has " +
                       std::to_string(cells.size()));
    table.rows.push_back(std::move(cells));
    table.lines.push_back(number);
  }
  return table;
}

config::Value value_of(const std::string& cell) {
  const std::string text = trimmed(cell);
  return config::parse_toml_value(text).value_or(config::Value(text));
}

}  // namespace butee::study
