#include "parameter_table.hpp"

#include <algorithm>

#include <butee/config/toml.hpp>

namespace butee::app {
namespace {

std::string default_text(const config::Parameter& parameter) {
  if (parameter.fallback) return config::to_toml(*parameter.fallback);
  return parameter.required ? "required" : "optional";
}

}  // namespace

std::string parameter_table(const std::vector<config::Parameter>& parameters, bool headed) {
  std::vector<std::vector<std::string>> cells;
  if (headed) cells.push_back({"parameter", "unit", "default", "allowed", "meaning"});
  for (const config::Parameter& p : parameters)
    cells.push_back({p.name, p.unit, default_text(p), p.describe(), p.help});
  if (parameters.empty()) return "";
  std::vector<std::size_t> widths(cells[0].size());
  for (const auto& line : cells)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  std::string text;
  for (const auto& line : cells) {
    text += " ";
    for (std::size_t i = 0; i < line.size(); ++i)
      text += " " + line[i] + (i + 1 < line.size() ? std::string(widths[i] - line[i].size() + 1, ' ') : "");
    text += "\n";
  }
  return text;
}

}  // namespace butee::app
