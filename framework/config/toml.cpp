#include "butee/config/toml.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>

#include <toml.hpp>

#include "butee/config/number_arrays.hpp"
#include "butee/config/toml_limits.hpp"
#include "butee/config/toml_order.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::config {
namespace {

using Parsed = toml::basic_value<toml::discard_comments, std::map, std::vector>;

/// The locations of values in a text. toml11's own location() counts the lines from the start of
/// the text for every value; here the starts of all lines are found once.
class Places {
 public:
  explicit Places(const OrderedText& text) : text_(text) {}

  /// Number of characters before the value; 0 for a value that was not read from a text.
  std::ptrdiff_t offset(const Parsed& value) {
    const toml::detail::region* region = region_of(value);
    return region != nullptr ? region->first() - region->begin() : 0;
  }

  Location location(const Parsed& value) {
    const toml::detail::region* region = region_of(value);
    if (region == nullptr) return {0, 1};
    if (line_begins_.empty()) find_lines(*region);
    const auto after = std::upper_bound(line_begins_.begin(), line_begins_.end(), offset(value));
    return {0, text_.original(static_cast<std::int32_t>(after - line_begins_.begin()))};
  }

 private:
  static const toml::detail::region* region_of(const Parsed& value) {
    return dynamic_cast<const toml::detail::region*>(toml::detail::get_region(value));
  }

  void find_lines(const toml::detail::region& region) {
    line_begins_.push_back(0);
    for (auto at = region.begin(); at != region.end(); ++at)
      if (*at == '\n') line_begins_.push_back(at + 1 - region.begin());
  }

  const OrderedText& text_;
  std::vector<std::ptrdiff_t> line_begins_;
};

/// Auxiliary data for reading a parsed text.
struct Source {
  Places places;
  NumberArrays arrays;
};

Value convert(const Parsed& from, const std::string& key, Source& source);

/// Rejects valid TOML that cannot be stored as a Value.
[[noreturn]] void refuse(const Parsed& value, const std::string& key, Places& places, const std::string& complaint) {
  const auto where = value.location();
  throw InputError(":" + std::to_string(places.location(value).line) + ": " + key + " = " +
                   where.line_str().substr(where.column() - 1, where.region()) + ": " + complaint);
}

/// toml11 replaces a number out of range by the largest one.
template <class Number>
Number fitting(Number number, const Parsed& from, const std::string& key, Places& places) {
  using Limits = std::numeric_limits<Number>;
  if (number == Limits::max() || number == Limits::lowest())
    refuse(from, key, places,
           std::string("is too large for ") + (Limits::is_integer ? "an integer of 64 bits" : "a number") +
               "; the magnitude must be below " + to_short_text(static_cast<double>(Limits::max())));
  return number;
}

/// toml11 reads numbers by the global locale of the program that uses this library, which may have a decimal comma.
double float_of(const Parsed& from) {
  const auto where = from.location();
  std::string text = where.line_str().substr(where.column() - 1, where.region());
  std::erase(text, '_');
  return number_of(text).value_or(from.as_floating());
}

Table convert_table(const Parsed& from, Source& source) {
  struct Placed {
    std::ptrdiff_t offset;
    Table::Entry entry;
  };
  std::vector<Placed> placed;
  for (const auto& [key, value] : from.as_table())
    placed.push_back({source.places.offset(value), {key, convert(value, key, source)}});
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.offset < b.offset; });
  Table table;
  for (Placed& item : placed) table.entries.push_back(std::move(item.entry));
  return table;
}

Value convert(const Parsed& from, const std::string& key, Source& source) {
  const Location at = source.places.location(from);
  switch (from.type()) {
    case toml::value_t::boolean:
      return {from.as_boolean(), at};
    case toml::value_t::integer:
      return {fitting(std::int64_t{from.as_integer()}, from, key, source.places), at};
    case toml::value_t::floating:
      return {fitting(float_of(from), from, key, source.places), at};
    case toml::value_t::string:
      return {std::string(from.as_string().str), at};
    case toml::value_t::array: {
      Array array;
      const auto& items = from.as_array();
      if (items.size() == 1 && items.front().is_string())
        if (Array* taken = source.arrays.find(items.front().as_string().str)) return {std::move(*taken), at};
      for (const Parsed& item : items) array.push_back(convert(item, key, source));
      return {std::move(array), at};
    }
    case toml::value_t::table:
      return {convert_table(from, source), at};
    default:
      refuse(from, key, source.places, "dates and times are not allowed in a model file");
  }
}

/// toml11's messages are drawings of several lines with " --> file" and "line | text"; this keeps
/// the sentence and the line, for two definitions that of the second.
std::string shorten(const std::string& what, const std::string& name, const OrderedText& text) {
  std::string sentence = what.substr(0, what.find('\n'));
  const bool defined_twice = sentence.find("insert_value") != std::string::npos;
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
    if (!line.empty() && !defined_twice) break;
  }
  if (sentence.find("invalid line format") != std::string::npos || sentence.rfind("bad ", 0) == 0)
    sentence +=
        "; numbers have a point with digits on both sides (0.5, 1.0e-4) and no unit, texts stand in double quotes, "
        "comments begin with #";
  const std::int32_t number = line.empty() ? 1 : static_cast<std::int32_t>(std::stol(line));
  return name + ":" + std::to_string(text.original(number)) + ": not valid TOML: " + sentence;
}

Parsed parse(const OrderedText& text, const std::string& name) {
  std::istringstream stream(text.text);
  return toml::parse<toml::discard_comments, std::map, std::vector>(stream, name);
}

}  // namespace

Document parse_toml(const std::string& given, const std::string& name) {
  OrderedText text;
  try {
    check_limits(given);
    NumberArrays arrays;
    const std::string short_text = arrays.take_out(given);
    check_lines(short_text);
    text = tables_before_their_parts(short_text);
    const Parsed parsed = given.empty() ? Parsed(toml::table{}) : parse(text, name);
    Source source{Places(text), std::move(arrays)};
    return {{name}, {convert_table(parsed, source), {0, 1}}};
  } catch (const InputError& error) {
    throw InputError(name + error.what());
  } catch (const std::exception& error) {
    throw InputError(shorten(error.what(), name, text));
  }
}

Document load_toml(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  file.peek();  // An empty file is good after this; a folder or other object that opens but cannot be read is not.
  if (std::error_code none; !file && std::filesystem::is_directory(path, none))
    throw InputError(path + ": is a folder; name the TOML file in it");
  if (!file) throw InputError(path + ": cannot be read; check the name and its permissions");
  std::string text;
  for (std::array<char, 65536> part{}; file.read(part.data(), part.size()), file.gcount() > 0;) {
    text.append(part.data(), static_cast<std::size_t>(file.gcount()));
    // Devices and pipes may be endless.
    if (text.size() > kLargestText) throw InputError(path + too_large());
  }
  if (file.bad()) throw InputError(path + ": cannot be read to its end");
  return parse_toml(text, path);
}

std::optional<Value> parse_toml_value(const std::string& text) {
  if (text.find('\n') != std::string::npos) return std::nullopt;
  try {
    const std::string whole = "value = " + text + "\n";
    check_limits(whole);
    NumberArrays arrays;
    const OrderedText line{arrays.take_out(whole), {}};
    check_lines(line.text);
    const Parsed parsed = parse(line, "value");
    Source source{Places(line), std::move(arrays)};
    return convert(parsed.at("value"), "value", source);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace butee::config
