#include "butee/config/toml.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include <toml.hpp>

#include "butee/core/error.hpp"

namespace butee::config {
namespace {

using Parsed = toml::basic_value<toml::discard_comments, std::map, std::vector>;

/// toml11 counts lines from the start of the text for every location asked for, so long arrays share their array's.
constexpr std::size_t kLongArray = 256;

Value convert(const Parsed& from, const Location* shared);

Location location_of(const Parsed& value) {
  return {0, static_cast<std::int32_t>(value.location().line())};
}

Table convert_table(const Parsed& from) {
  struct Placed {
    std::uint_least32_t line, column;
    Table::Entry entry;
  };
  std::vector<Placed> placed;
  for (const auto& [key, value] : from.as_table()) {
    const auto where = value.location();
    placed.push_back({where.line(), where.column(), {key, convert(value, nullptr)}});
  }
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.line != b.line ? a.line < b.line : a.column < b.column;
  });
  Table table;
  for (Placed& item : placed) table.entries.push_back(std::move(item.entry));
  return table;
}

Value convert(const Parsed& from, const Location* shared) {
  const Location at = shared != nullptr ? *shared : location_of(from);
  switch (from.type()) {
    case toml::value_t::boolean:
      return {from.as_boolean(), at};
    case toml::value_t::integer:
      return {std::int64_t{from.as_integer()}, at};
    case toml::value_t::floating:
      return {double{from.as_floating()}, at};
    case toml::value_t::string:
      return {std::string(from.as_string().str), at};
    case toml::value_t::array: {
      Array array;
      const Location* same = from.as_array().size() > kLongArray ? &at : nullptr;
      for (const Parsed& item : from.as_array()) array.push_back(convert(item, same));
      return {std::move(array), at};
    }
    case toml::value_t::table:
      return {convert_table(from), at};
    default:
      throw InputError("line " + std::to_string(at.line) + ": dates and times have no place in a model file");
  }
}

/// toml11's messages are drawings of several lines with " --> file" and "line | text"; this keeps sentence and line.
std::string shorten(const std::string& what, const std::string& name) {
  std::string sentence = what.substr(0, what.find('\n'));
  if (const auto bracket = sentence.find("] "); sentence.rfind("[error]", 0) == 0 && bracket != std::string::npos)
    sentence = sentence.substr(bracket + 2);
  if (const auto colon = sentence.find(": "); sentence.rfind("toml::", 0) == 0 && colon != std::string::npos)
    sentence = sentence.substr(colon + 2);
  std::string line;
  std::istringstream rows(what);
  for (std::string row; std::getline(rows, row);) {
    const auto bar = row.find(" | ");
    const auto digits = row.find_first_not_of(' ');
    if (bar == std::string::npos || digits >= bar) continue;
    const std::string number = row.substr(digits, bar - digits);
    if (number.find_first_not_of("0123456789") == std::string::npos) line = number;
    if (!line.empty()) break;
  }
  return name + ":" + (line.empty() ? "1" : line) + ": not valid TOML: " + sentence;
}

Parsed parse(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  return toml::parse<toml::discard_comments, std::map, std::vector>(stream, name);
}

}  // namespace

Document parse_toml(const std::string& text, const std::string& name) {
  try {
    const Parsed parsed = text.empty() ? Parsed(toml::table{}) : parse(text, name);
    return {{name}, {convert_table(parsed), {0, 0}}};
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  } catch (const std::exception& error) {
    throw InputError(shorten(error.what(), name));
  }
}

Document load_toml(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf()))
    if (!file || file.peek() != std::ifstream::traits_type::eof())
      throw InputError(path + ": cannot be read; check the name and its permissions");
  return parse_toml(text.str(), path);
}

std::optional<Value> parse_toml_value(const std::string& text) {
  if (text.find('\n') != std::string::npos) return std::nullopt;
  try {
    const Parsed parsed = parse("value = " + text + "\n", "value");
    return convert(parsed.at("value"), nullptr);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace butee::config
