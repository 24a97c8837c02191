#include "butee/config/parameter.hpp"

#include <algorithm>
#include <cmath>

#include "butee/config/parameters.hpp"
#include "butee/core/text.hpp"

namespace butee::config {
namespace {

Parameter declare(Parameter::Kind kind, std::string name, std::string unit, std::string help) {
  Parameter parameter;
  parameter.kind = kind;
  parameter.name = std::move(name);
  parameter.unit = std::move(unit);
  parameter.help = std::move(help);
  return parameter;
}

std::string bounds_text(const Parameter& parameter) {
  if (parameter.lower == parameter.upper) return " " + to_short_text(parameter.lower);
  std::string text;
  if (std::isfinite(parameter.lower)) text += (parameter.lower_open ? " > " : " >= ") + to_short_text(parameter.lower);
  if (std::isfinite(parameter.upper)) text += (text.empty() ? " <= " : " and <= ") + to_short_text(parameter.upper);
  return text;
}

std::string quoted_choices(const Parameter& parameter) {
  return "\"" + join(parameter.choices, "\", \"") + "\"";
}

bool begins_like_number(const std::string& word) {
  return !word.empty() && std::string("0123456789+-.").find(word.front()) != std::string::npos;
}

std::string number_complaint(const Parameter& parameter, const Value& value) {
  const auto number = as_number(value);
  const std::string* word = value.text();
  if (word != nullptr &&
      std::find(parameter.choices.begin(), parameter.choices.end(), *word) != parameter.choices.end())
    return "";
  if (!number)
    return "must be a number" + (parameter.choices.empty() ? "" : " or " + quoted_choices(parameter)) + ", not " +
           (word != nullptr && !parameter.choices.empty() ? "another string" : value.kind()) +
           (word != nullptr && begins_like_number(*word)
                ? "; write it with a decimal point, without a unit and without quotes"
                : "");
  const bool inside = std::isfinite(*number) && *number <= parameter.upper &&
                      (parameter.lower_open ? *number > parameter.lower : *number >= parameter.lower);
  if (inside) return "";
  const std::string unit = parameter.unit.empty() || parameter.unit == "1" ? "" : " (" + parameter.unit + ")";
  if (!std::isfinite(*number)) return "must be a finite number" + unit;
  return "must be" + bounds_text(parameter) + unit;
}

std::string text_complaint(const Parameter& parameter, const Value& value) {
  const std::string* text = value.text();
  if (text == nullptr) return std::string("must be a string, not ") + value.kind();
  if (parameter.choices.empty() ||
      std::find(parameter.choices.begin(), parameter.choices.end(), *text) != parameter.choices.end())
    return "";
  // A long list hides the suggestion.
  constexpr std::size_t kMost = 20, kShown = 8;
  if (parameter.choices.size() <= kMost)
    return "must be one of " + quoted_choices(parameter) + suggestion(*text, parameter.choices);
  const std::vector<std::string> first(parameter.choices.begin(), parameter.choices.begin() + kShown);
  return "must be one of \"" + join(first, "\", \"") + "\" and " + std::to_string(parameter.choices.size() - kShown) +
         " more (`butee help output` lists the " + parameter.name + ")" + suggestion(*text, parameter.choices);
}

template <class Complaint>
std::string array_complaint(const Parameter& parameter, const Value& value, const char* of, Complaint complaint) {
  const Array* array = value.array();
  if (array == nullptr)
    return "must be an array of " + (parameter.length ? std::to_string(*parameter.length) + " " : "") + of + ", not " +
           value.kind();
  if (parameter.length && array->size() != *parameter.length)
    return "must hold " + std::to_string(*parameter.length) + " values, not " + std::to_string(array->size());
  for (std::size_t i = 0; i < array->size(); ++i)
    if (const std::string wrong = complaint((*array)[i]); !wrong.empty())
      return "entry " + std::to_string(i) + " (counted from 0): " + wrong;
  return "";
}

std::string matrix_complaint(const Parameter& parameter, const Value& value) {
  const std::string shape = "must be " + std::to_string(*parameter.length) + " arrays of " +
                            std::to_string(*parameter.columns) + " numbers each";
  if (value.array() == nullptr || value.array()->size() != *parameter.length) return shape;
  Parameter row = parameter;
  row.length = parameter.columns;
  for (const Value& item : *value.array()) {
    if (item.array() == nullptr || item.array()->size() != *parameter.columns) return shape;
    const std::string wrong =
        array_complaint(row, item, "numbers", [&](const Value& entry) { return number_complaint(parameter, entry); });
    if (!wrong.empty()) return shape + ": " + wrong;
  }
  return "";
}

/// A column of a file: its number counted from 1, or its name.
constexpr const char* kColumn = "column";

std::string column_complaint(const Value& value) {
  if (value.text() != nullptr) return value.text()->empty() ? "must not be empty" : "";
  const auto* place = std::get_if<std::int64_t>(&value.data);
  if (place == nullptr) return std::string("must be an integer or a string, not ") + value.kind();
  return *place >= 1 && *place <= 1000000 ? "" : "must be 1 to 1000000; columns are counted from 1";
}

bool is_tables(const Value& value) {
  const Array* array = value.array();
  return value.table() != nullptr ||
         (array != nullptr &&
          std::all_of(array->begin(), array->end(), [](const Value& item) { return item.table() != nullptr; }));
}

std::string integer_complaint(const Parameter& parameter, const Value& value) {
  if (std::holds_alternative<std::int64_t>(value.data)) return number_complaint(parameter, value);
  const std::string complaint = std::string("must be an integer, not ") + value.kind();
  const double* const number = std::get_if<double>(&value.data);
  if (number == nullptr) return complaint;
  constexpr double kMost = 1e15;
  if (*number != std::floor(*number) || std::abs(*number) > kMost) return complaint;
  const auto integer = static_cast<std::int64_t>(*number);
  const std::string of_integer = number_complaint(parameter, Value(integer));
  return of_integer.empty() ? complaint + "; write it as " + std::to_string(integer) : of_integer;
}

}  // namespace

Parameter Parameter::at_least(double bound) const {
  Parameter copy = *this;
  copy.lower = bound;
  copy.lower_open = false;
  return copy;
}
Parameter Parameter::above(double bound) const {
  Parameter copy = *this;
  copy.lower = bound;
  copy.lower_open = true;
  return copy;
}
Parameter Parameter::at_most(double bound) const {
  Parameter copy = *this;
  copy.upper = bound;
  return copy;
}
Parameter Parameter::or_else(Value::Data value) const {
  Parameter copy = *this;
  copy.fallback = Value(std::move(value));
  copy.required = false;
  return copy;
}

Parameter Parameter::try_first(Value::Data value) const {
  Parameter changed = *this;
  changed.first_try = Value(std::move(value));
  return changed;
}

Parameter Parameter::sweep(double loose, double tight) const {
  Parameter changed = *this;
  changed.swept = {loose, tight};
  return changed;
}
Parameter Parameter::optional() const {
  Parameter copy = *this;
  copy.required = false;
  return copy;
}
Parameter Parameter::one_of(std::vector<std::string> names) const {
  Parameter copy = *this;
  copy.choices = std::move(names);
  return copy;
}
Parameter Parameter::of_length(std::size_t wanted) const {
  Parameter copy = *this;
  copy.length = wanted;
  return copy;
}

std::string Parameter::describe() const {
  switch (kind) {
    case Kind::number:
      return "number" + bounds_text(*this) + (choices.empty() ? "" : " or " + quoted_choices(*this));
    case Kind::integer:
      return "integer" + bounds_text(*this);
    case Kind::boolean:
      return "true or false";
    case Kind::text:
      return choices.empty() ? "text" : quoted_choices(*this);
    case Kind::numbers:
      return (length ? std::to_string(*length) + " numbers" : std::string("numbers")) + bounds_text(*this);
    case Kind::texts:
      if (unit == kColumn) return "list of numbers from 1, or of names";
      return choices.empty() ? "text or list of texts" : "list of " + quoted_choices(*this);
    case Kind::table:
      return "table";
    case Kind::matrix:
      return std::to_string(*length) + " x " + std::to_string(*columns) + " numbers" + bounds_text(*this);
  }
  return "";
}

std::string Parameter::complaint(const Value& value) const {
  switch (kind) {
    case Kind::number:
      return number_complaint(*this, value);
    case Kind::integer:
      return integer_complaint(*this, value);
    case Kind::boolean:
      return std::holds_alternative<bool>(value.data) ? "" : std::string("must be true or false, not ") + value.kind();
    case Kind::text:
      return text_complaint(*this, value);
    case Kind::numbers:
      return array_complaint(*this, value, "numbers",
                             [this](const Value& item) { return number_complaint(*this, item); });
    case Kind::texts:
      if (unit == kColumn) return array_complaint(*this, value, "columns", column_complaint);
      if (value.text() != nullptr) return text_complaint(*this, value);
      if (value.array() == nullptr) return std::string("must be a string or an array of strings, not ") + value.kind();
      return array_complaint(*this, value, "strings",
                             [this](const Value& item) { return text_complaint(*this, item); });
    case Kind::matrix:
      return matrix_complaint(*this, value);
    case Kind::table:
      if (is_tables(value)) return "";
      return std::string("must be a table, not ") + value.kind() + (help.empty() ? "" : "; give " + help);
  }
  return "";
}

Parameter number(std::string name, std::string unit, std::string help) {
  return declare(Parameter::Kind::number, std::move(name), std::move(unit), std::move(help));
}
Parameter integer(std::string name, std::string help) {
  return declare(Parameter::Kind::integer, std::move(name), "1", std::move(help));
}
Parameter boolean(std::string name, std::string help) {
  return declare(Parameter::Kind::boolean, std::move(name), "", std::move(help));
}
Parameter text(std::string name, std::string help) {
  return declare(Parameter::Kind::text, std::move(name), "", std::move(help));
}
Parameter numbers(std::string name, std::string unit, std::string help) {
  return declare(Parameter::Kind::numbers, std::move(name), std::move(unit), std::move(help));
}
Parameter matrix(std::string name, std::string unit, std::string help, std::size_t rows, std::size_t columns) {
  Parameter parameter = declare(Parameter::Kind::matrix, std::move(name), std::move(unit), std::move(help));
  parameter.length = rows;
  parameter.columns = columns;
  return parameter;
}
Parameter texts(std::string name, std::string help) {
  return declare(Parameter::Kind::texts, std::move(name), "", std::move(help));
}
Parameter table(std::string name, std::string help) {
  return declare(Parameter::Kind::table, std::move(name), "", std::move(help));
}

std::vector<std::string> names_of(const std::vector<Parameter>& parameters) {
  std::vector<std::string> names;
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  return names;
}

}  // namespace butee::config
