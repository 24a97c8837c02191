#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <butee/export.hpp>

namespace butee::config {

/// The origin of a value: `source` indexes Document::sources, `line` counts from 1 (0: the whole
/// source).
struct Location {
  std::int32_t source = 0;
  std::int32_t line = 0;
};

class Value;
using Array = std::vector<Value>;

/// A table that keeps the order of the file.
class BUTEE_EXPORT Table {
 public:
  using Entry = std::pair<std::string, Value>;

  const Value* find(std::string_view key) const;
  Value* find(std::string_view key);
  /// The value of `key`; a missing key is created with an empty table.
  Value& operator[](std::string_view key);

  std::vector<Entry> entries;
};

/// One TOML value with its location.
class BUTEE_EXPORT Value {
 public:
  using Data = std::variant<bool, std::int64_t, double, std::string, Array, Table>;

  Value() : data(Table{}) {}
  Value(Data given, Location where = {}) : data(std::move(given)), at(where) {}

  const Table* table() const { return std::get_if<Table>(&data); }
  Table* table() { return std::get_if<Table>(&data); }
  const Array* array() const { return std::get_if<Array>(&data); }
  Array* array() { return std::get_if<Array>(&data); }
  const std::string* text() const { return std::get_if<std::string>(&data); }

  /// "a number", "an integer", "a table" ... for messages.
  const char* kind() const;

  Data data;
  Location at;
};

inline const Value* Table::find(std::string_view key) const {
  for (const Entry& entry : entries)
    if (entry.first == key) return &entry.second;
  return nullptr;
}
inline Value* Table::find(std::string_view key) {
  for (Entry& entry : entries)
    if (entry.first == key) return &entry.second;
  return nullptr;
}

/// A parsed scene file with the overrides applied. sources[0] is the file's path, the others are
/// overrides.
struct Document {
  std::vector<std::string> sources;
  Value root;
};

/// "file:line" or "--set key=value".
BUTEE_EXPORT std::string describe(const Document& document, Location at);

}  // namespace butee::config
