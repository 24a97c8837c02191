#include "butee/config/number_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "butee/config/file_reference.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::config {
namespace {

constexpr std::size_t kLongestShown = 40;

/// Throws InputError with the line of an error in a file, ":17: ..."
[[noreturn]] void refuse(std::size_t line, const std::string& complaint) {
  throw InputError(":" + std::to_string(line) + ": " + complaint);
}

std::string shown(std::string_view text) {
  return "\"" + printable(text.substr(0, kLongestShown)) + (text.size() > kLongestShown ? "..." : "") + "\"";
}

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Iterates over the lines of a text that contain numbers or names.
class Lines {
 public:
  Lines(std::string_view text, Index skip) : rest_(text) {
    if (rest_.substr(0, 3) == "\xEF\xBB\xBF") rest_.remove_prefix(3);
    for (; skip > 0 && !rest_.empty(); --skip) take();
  }

  /// False at the end.
  bool next() {
    while (!rest_.empty()) {
      line = trimmed(take());
      if (!line.empty() && line.front() != '#' && line.front() != '%') return true;
    }
    return false;
  }

  std::string_view line;
  std::size_t number = 0;  ///< counted from 1

 private:
  std::string_view take() {
    const auto end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view taken = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number;
    return taken;
  }

  std::string_view rest_;
};

/// Reads the fields of a line from its beginning.
class Fields {
 public:
  Fields(std::string_view line, char separator) : rest_(line), separator_(separator) {}

  bool next() {
    if (done_) return false;
    std::size_t end = 0;
    while (end < rest_.size() && rest_[end] != separator_ && !is_blank(rest_[end])) ++end;
    field = rest_.substr(0, end);
    rest_.remove_prefix(end);
    const std::size_t before = rest_.size();
    while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
    if (rest_.empty()) {
      done_ = true;
    } else if (rest_.front() == separator_) {
      ends_at_separator = true;
      rest_.remove_prefix(1);
      while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
    } else if (rest_.size() < before) {
      ends_at_blank = true;
    }
    return true;
  }

  std::string_view field;
  bool ends_at_separator = false, ends_at_blank = false;  ///< any field so far

 private:
  std::string_view rest_;
  char separator_;
  bool done_ = false;
};

/// The column names of a line: between separators, where it has any, so that names may contain blanks
/// ("Time (s),Force (N)"); otherwise between blanks. A separator within quotation marks is part of the name.
std::vector<std::string> column_names(std::string_view line, char separator) {
  const bool has_separator = line.find(separator) != std::string_view::npos;
  std::vector<std::string> names(1);
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') {
      is_quoted = !is_quoted;
    } else if (is_quoted || (has_separator ? c != separator : !is_blank(c))) {
      names.back() += c;
    } else if (has_separator || !names.back().empty()) {
      names.emplace_back();
    }
  }
  for (std::string& name : names) name = std::string(trimmed(name));
  return names;
}

class NumberFile {
 public:
  NumberFile(const Parameters& p, std::string_view text) : lines_(text, p.integer("skip")), scale_(p.number("scale")) {
    const Array* given = p.has("columns") ? p.value("columns").array() : nullptr;
    for (std::size_t i = 0; i < places_.size() && given != nullptr; ++i) {
      const Value& one = (*given)[i];
      if (const auto* place = std::get_if<std::int64_t>(&one.data)) places_[i] = static_cast<std::size_t>(*place) - 1;
      if (one.text() != nullptr) names_[i] = *one.text();
    }
  }

  NumberTable read() {
    bool any = lines_.next();
    separator_ = lines_.line.find(';') != std::string_view::npos ? ';' : ',';
    if (any && !begins_with_number()) {
      check_names();
      find_names();
      any = lines_.next();
    } else if (const auto name = std::find_if(names_.begin(), names_.end(), [](auto& n) { return !n.empty(); });
               any && name != names_.end()) {
      refuse(lines_.number,
             "has no column names, but columns requests \"" + *name + "\"; count columns from 1 instead");
    }
    if (!any) throw InputError(": holds no numbers");
    if (places_[0] == places_[1])
      refuse(lines_.number, "columns requests column " + std::to_string(places_[0] + 1) +
                                " twice; give one for the times and another one for the values");
    for (; any; any = lines_.next()) read_row();
    return std::move(table_);
  }

 private:
  bool begins_with_number() const {
    Fields fields(lines_.line, separator_);
    if (!fields.next()) return false;
    const std::size_t first = fields.field.find_first_not_of(" \t\"");
    // A number that cannot be read, such as 1e400, is no name.
    return number_of(fields.field).has_value() ||
           (first != std::string_view::npos &&
            std::string_view("0123456789+-.").find(fields.field[first]) != std::string_view::npos);
  }

  /// A row whose first number is mistyped is no line of names.
  void check_names() const {
    if (!names_[0].empty() || !names_[1].empty()) return;
    const std::vector<std::string> known = column_names(lines_.line, separator_);
    for (const std::size_t place : places_)
      if (place < known.size() && number_of(known[place]))
        refuse(lines_.number,
               "column 1: " + shown(known.front()) + " is not a number, but column " + std::to_string(place + 1) +
                   " is; if this line names the columns, skip it by skip = " + std::to_string(lines_.number));
  }

  void find_names() {
    const std::vector<std::string> known = column_names(lines_.line, separator_);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (names_[i].empty()) continue;
      const auto found = std::find(known.begin(), known.end(), names_[i]);
      if (found == known.end())
        refuse(lines_.number, "names no column \"" + names_[i] + "\"" + suggestion(names_[i], known) +
                                  "; it names: " + printable(join(known).substr(0, 400)));
      if (std::find(found + 1, known.end(), names_[i]) != known.end())
        refuse(lines_.number, "names two columns \"" + names_[i] + "\"; count columns from 1 instead");
      places_[i] = static_cast<std::size_t>(found - known.begin());
    }
  }

  void read_row() {
    std::array<double, 2> row{};
    const std::size_t last = std::max(places_[0], places_[1]);
    Fields fields(lines_.line, separator_);
    for (std::size_t place = 0; place <= last; ++place) {
      if (!fields.next())
        refuse(lines_.number,
               "has " + std::to_string(place) + " columns, but column " + std::to_string(last + 1) + " is requested");
      for (std::size_t i = 0; i < row.size(); ++i)
        if (places_[i] == place) row[i] = number_at(place, fields.field);
    }
    // With decimal commas between blanks, half of every number would be taken for the next column.
    if (fields.ends_at_separator && fields.ends_at_blank)
      refuse(lines_.number, std::string("separates columns both by blanks and by \"") + separator_ +
                                "\"; write decimals with a point, and separate columns in one way");
    if (!table_.arguments.empty() && !(row[0] > table_.arguments.back()))
      refuse(lines_.number, "column " + std::to_string(places_[0] + 1) + " must ascend, and " + to_short_text(row[0]) +
                                " follows " + to_short_text(table_.arguments.back()));
    table_.arguments.push_back(row[0]);
    table_.values.push_back(scale_ * row[1]);
  }

  double number_at(std::size_t place, std::string_view field) const {
    const auto number = number_of(field);
    const std::string where = "column " + std::to_string(place + 1) + ": ";
    if (!number)
      refuse(
          lines_.number,
          where + shown(field) + " is not a number" +
              (separator_ == ';' && field.find(',') != std::string_view::npos ? "; write decimals with a point" : "") +
              (field.find_first_of("dD") != std::string_view::npos ? "; write exponents with e" : ""));
    if (!std::isfinite(*number)) refuse(lines_.number, where + shown(field) + " is not finite");
    return *number;
  }

  Lines lines_;
  double scale_;
  char separator_ = ',';
  std::array<std::size_t, 2> places_ = {0, 1};
  std::array<std::string, 2> names_;
  NumberTable table_;
};

}  // namespace

std::vector<Parameter> number_file_parameters() {
  Parameter columns = texts("columns", "the two columns of the file, counted from 1 or by name; default [1, 2]");
  columns.unit = "column";
  return {text("file", "a text file of columns of numbers, relative to the scene, instead of the numbers").optional(),
          columns.of_length(2).optional(),
          integer("skip", "lines at the beginning of the file that are not read").at_least(0).or_else(std::int64_t{0}),
          number("scale", "1", "a factor on the values of the file").or_else(1.0),
          integer("size", "bytes of the file, as in model.toml; another file is refused").at_least(0).optional(),
          text("checksum", "CRC-64 of the file, likewise").optional()};
}

std::optional<NumberTable> read_number_file(const Parameters& p, Diagnostics& diagnostics) {
  const std::string& file = p.text("file");
  const auto complain = [&](const std::string& complaint) {
    p.complain(diagnostics, "file", complaint);
    return std::nullopt;
  };
  try {
    const std::string text = read_text(path_beside(diagnostics.document(), file));
    const std::string change =
        change_of(text, p.has("size") ? p.integer("size") : 0, p.has("checksum") ? p.text("checksum") : "");
    if (!change.empty()) return complain(change);
    return NumberFile(p, text).read();
  } catch (const InputError& error) {
    const std::string what = error.what();
    return complain(what.front() == ':' ? printable(std::filesystem::path(file).filename().string()) + what : what);
  }
}

}  // namespace butee::config
