#include <algorithm>
#include <cmath>
#include <cstdio>

#include "butee/config/toml.hpp"
#include "butee/core/text.hpp"

namespace butee::config {
namespace {

constexpr std::size_t kWidth = 110;

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04X", static_cast<unsigned>(static_cast<unsigned char>(c)));
      out += code;
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string key_text(const std::string& key) {
  return is_plain_name(key) ? key : quoted(key);
}

bool is_array_of_tables(const Value& value) {
  const Array* array = value.array();
  return array != nullptr && !array->empty() &&
         std::all_of(array->begin(), array->end(), [](const Value& item) { return item.table() != nullptr; });
}

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  return to_text(value);
}

/// As to_toml(), with long arrays broken over several lines.
std::string folded(const Value& value) {
  const auto width = [](const std::string& text) { return text.size() - (text.rfind('\n') + 1); };
  if (const Array* array = value.array()) {
    std::string text = to_toml(value);
    if (text.size() <= kWidth) return text;
    text = "[";
    for (const Value& item : *array) {
      const std::string part = folded(item) + ",";
      text += width(text) + part.size() > kWidth ? "\n  " : " ";
      text += part;
    }
    return text + "\n]";
  }
  const Table* table = value.table();
  if (table == nullptr || table->entries.empty()) return to_toml(value);
  std::vector<std::string> parts;
  for (const auto& [key, item] : table->entries) parts.push_back(key_text(key) + " = " + folded(item));
  return "{ " + join(parts) + " }";
}

void write_table(const Table& table, const std::string& path, std::string& out) {
  for (const auto& [key, value] : table.entries)
    if (value.table() == nullptr && !is_array_of_tables(value)) out += key_text(key) + " = " + folded(value) + "\n";
  for (const auto& [key, value] : table.entries) {
    const std::string inner = path.empty() ? key_text(key) : path + "." + key_text(key);
    if (const Table* sub = value.table()) {
      const bool only_tables =
          !sub->entries.empty() && std::all_of(sub->entries.begin(), sub->entries.end(), [](const Table::Entry& entry) {
            return entry.second.table() != nullptr || is_array_of_tables(entry.second);
          });
      if (!only_tables) out += "\n[" + inner + "]\n";
      write_table(*sub, inner, out);
    } else if (is_array_of_tables(value)) {
      for (const Value& item : *value.array()) {
        out += "\n[[" + inner + "]]\n";
        write_table(*item.table(), inner, out);
      }
    }
  }
}

}  // namespace

std::string to_toml(const Value& value) {
  if (const bool* flag = std::get_if<bool>(&value.data)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return std::to_string(*integer);
  if (const double* number = std::get_if<double>(&value.data)) return number_text(*number);
  if (const std::string* text = value.text()) return quoted(*text);
  std::vector<std::string> parts;
  if (const Array* array = value.array()) {
    for (const Value& item : *array) parts.push_back(to_toml(item));
    return "[" + join(parts) + "]";
  }
  for (const auto& [key, item] : value.table()->entries) parts.push_back(key_text(key) + " = " + to_toml(item));
  return parts.empty() ? "{}" : "{ " + join(parts) + " }";
}

std::string write_toml(const Table& root) {
  std::string out;
  write_table(root, "", out);
  return out;
}

}  // namespace butee::config
