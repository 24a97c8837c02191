#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <butee/export.hpp>

namespace butee {

/// The entry of `known` nearest to `given` in edit distance, or "" if none is near.
BUTEE_EXPORT std::string closest_name(std::string_view given, const std::vector<std::string>& known);

/// ` (did you mean "x"?)` if a near name is known, else "".
BUTEE_EXPORT std::string suggestion(std::string_view given, const std::vector<std::string>& known);

/// "a, b, c"
BUTEE_EXPORT std::string join(const std::vector<std::string>& parts, std::string_view separator = ", ");

/// The shortest decimal that reads back as the same double, always a TOML float: "1.0", "2.5e-06".
BUTEE_EXPORT std::string to_text(double value);

/// `value` with some significant digits, for messages.
BUTEE_EXPORT std::string to_short_text(double value, int digits = 6);

/// The text without control characters, which a terminal would interpret: a line break is kept if
/// `with_lines`, all others become "?".
BUTEE_EXPORT std::string printable(std::string_view text, bool with_lines = false);

/// The number that all of the text is, in decimal notation whatever the locale.
template <class Number>
std::optional<Number> whole_number(std::string_view text) {
  Number number{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  return number;
}
/// The same; a plus sign may precede it.
BUTEE_EXPORT std::optional<double> number_of(std::string_view text);

/// True for a non-empty text of [A-Za-z0-9_-] only.
BUTEE_EXPORT bool is_plain_name(std::string_view text);

}  // namespace butee
