#include "butee/config/override.hpp"

#include <algorithm>
#include <charconv>

#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::config {
namespace {

/// The largest number of characters of a value that a message shows.
constexpr std::size_t kLongest = 60;

struct Step {
  std::string key;
  std::vector<std::size_t> indices;
};

[[noreturn]] void refuse(const std::string& source, const std::string& reason) {
  throw InputError(source + ": " + reason);
}

/// "contact[0]" -> {contact, [0]}
Step parse_step(const std::string& text, const std::string& source) {
  const auto bracket = text.find('[');
  Step step{text.substr(0, bracket), {}};
  if (!is_plain_name(step.key)) refuse(source, "write KEY=VALUE with a dotted key, such as integrator.time_step=1e-6");
  for (auto open = bracket; open != std::string::npos;) {
    const auto close = text.find(']', open);
    std::size_t index = 0;
    const char* const end = text.data() + std::min(close, text.size());
    const auto parsed = std::from_chars(text.data() + open + 1, end, index);
    if (close == std::string::npos || parsed.ec != std::errc() || parsed.ptr != end)
      refuse(source, "an index is a whole number in brackets, such as contact[0]");
    step.indices.push_back(index);
    open = close + 1 < text.size() ? close + 1 : std::string::npos;
    if (open != std::string::npos && text[open] != '[') refuse(source, "a dot is missing after ]");
  }
  return step;
}

std::vector<Step> parse_path(const std::string& path, const std::string& source) {
  std::vector<Step> steps;
  for (std::size_t begin = 0; begin <= path.size();) {
    const auto dot = std::min(path.find('.', begin), path.size());
    steps.push_back(parse_step(path.substr(begin, dot - begin), source));
    begin = dot + 1;
  }
  return steps;
}

Value& descend(Value& from, const Step& step, const std::string& source) {
  Table* table = from.table();
  if (table == nullptr)
    refuse(source, "\"" + step.key + "\" cannot be set inside " + from.kind() +
                       (from.array() != nullptr ? "; name one of its entries, such as contact[0]" : ""));
  Value* value = &(*table)[step.key];
  for (const std::size_t index : step.indices) {
    Array* array = value->array();
    const std::size_t size = array != nullptr ? array->size() : 0;
    if (index >= size)
      refuse(source, "there is no " + step.key + "[" + std::to_string(index) + "]; the file has " +
                         std::to_string(size) + " of them, counted from 0");
    value = &(*array)[index];
  }
  return *value;
}

void remove(Value& root, std::vector<Step> path, const std::string& source) {
  const Step last = std::move(path.back());
  path.pop_back();
  Value* parent = &root;
  for (const Step& step : path) parent = &descend(*parent, step, source);
  Table* table = parent->table();
  if (table == nullptr || table->find(last.key) == nullptr || !last.indices.empty())
    refuse(source, "there is no such key to remove; an empty string is written KEY=\"\"");
  std::erase_if(table->entries, [&](const Table::Entry& entry) { return entry.first == last.key; });
}

const Value* follow(const Value& from, const Step& step) {
  const Table* table = from.table();
  const Value* value = table != nullptr ? table->find(step.key) : nullptr;
  for (const std::size_t index : step.indices) {
    const Array* array = value != nullptr ? value->array() : nullptr;
    if (array == nullptr || index >= array->size()) return nullptr;
    value = &(*array)[index];
  }
  return value;
}

void relocate(Value& value, Location at) {
  value.at = at;
  if (Array* array = value.array())
    for (Value& item : *array) relocate(item, at);
  if (Table* table = value.table())
    for (auto& entry : table->entries) relocate(entry.second, at);
}

void set(Document& document, const std::string& key, const std::string& source, Value given) {
  const std::vector<Step> path = parse_path(key, source);
  document.sources.push_back(source);
  const Location at{static_cast<std::int32_t>(document.sources.size() - 1), 0};
  relocate(given, at);
  Value* target = &document.root;
  for (const Step& step : path) {
    target = &descend(*target, step, source);
    if (const Table* table = target->table(); table != nullptr && table->entries.empty()) target->at = at;
  }
  *target = std::move(given);
}

}  // namespace

void apply_override(Document& document, const std::string& assignment, const std::string& origin) {
  const std::string source = origin + " " + assignment;
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) refuse(source, "write KEY=VALUE, such as integrator.time_step=1e-6");
  const std::string key = assignment.substr(0, equals), text = assignment.substr(equals + 1);
  if (text.empty()) return remove(document.root, parse_path(key, source), source);
  set(document, key, source, parse_toml_value(text).value_or(Value(text)));
}

void apply_override(Document& document, const std::string& key, Value value) {
  std::string text = to_toml(value);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  set(document, key, "--set " + key + "=" + text, std::move(value));
}

const Value* find_value(const Document& document, const std::string& key) {
  const Value* value = &document.root;
  for (const Step& step : parse_path(key, key + "=")) {
    value = follow(*value, step);
    if (value == nullptr) return nullptr;
  }
  return value;
}

}  // namespace butee::config
