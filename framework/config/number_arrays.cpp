#include "butee/config/number_arrays.hpp"

#include <algorithm>
#include <optional>

#include "butee/config/toml_limits.hpp"
#include "butee/core/text.hpp"

namespace butee::config {
namespace {

constexpr char kMark = '\x01';  ///< written as an escape sequence, which no scene contains

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Reads an array of plain numbers, character by character.
class ArrayReader {
 public:
  ArrayReader(const std::string& text, std::size_t begin, std::int32_t line)
      : text_(text), at_(begin + 1), begin_(begin), line_(line) {}

  /// The position after its closing bracket, or nothing for any other array or a short one.
  std::optional<std::size_t> read() {
    skip_blanks();
    while (at() != ']') {
      if (!read_number()) return std::nullopt;
      skip_blanks();
      if (at() != ',' && at() != ']') return std::nullopt;
      if (at() == ',') ++at_;
      skip_blanks();
    }
    if (++at_ - begin_ < NumberArrays::kShortest) return std::nullopt;
    return at_;
  }

  Array numbers;

 private:
  char at() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void skip_blanks() {
    for (;; ++at_) {
      if (at() == '#') at_ = std::min(text_.find('\n', at_), text_.size());
      if (at() == '\n') ++line_;
      if (at() != ' ' && at() != '\t' && at() != '\r' && at() != '\n') return;
    }
  }

  bool skip_digits() {
    const std::size_t first = at_;
    while (is_digit(at())) ++at_;
    return at_ > first;
  }

  /// [+-] (0 | 1-9 digits) [. digits] [e [+-] digits]
  bool read_number() {
    const std::size_t sign = at() == '+' || at() == '-' ? 1 : 0, first = at_ + (at() == '+' ? 1 : 0);
    const std::size_t whole = at_ += sign;
    if (!skip_digits() || (text_[whole] == '0' && at_ > whole + 1)) return false;
    bool is_integer = true;
    if (at() == '.') {
      ++at_;
      is_integer = false;
      if (!skip_digits()) return false;
    }
    if (at() == 'e' || at() == 'E') {
      ++at_;
      is_integer = false;
      if (at() == '+' || at() == '-') ++at_;
      if (!skip_digits()) return false;
    }
    return is_integer ? take<std::int64_t>(first) : take<double>(first);
  }

  template <class Number>
  bool take(std::size_t first) {
    Number number{};
    const auto read = std::from_chars(text_.data() + first, text_.data() + at_, number);
    if (read.ec != std::errc()) return false;
    numbers.emplace_back(number, Location{0, line_});
    return true;
  }

  const std::string& text_;
  std::size_t at_, begin_;
  std::int32_t line_;
};

/// True if the last non-blank character is the `=` of a key.
bool follows_a_key(const std::string& text, std::size_t at) {
  while (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '\t')) --at;
  return at > 0 && text[at - 1] == '=';
}

}  // namespace

std::string NumberArrays::take_out(const std::string& text) {
  std::string rest;
  std::size_t copied = 0;
  std::int32_t line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t next = std::min(text.find_first_of("\"'#[\n", at), text.size());
    if (next == text.size()) break;
    at = next + 1;
    if (text[next] == '\n') {
      ++line;
    } else if (text[next] == '#') {
      at = std::min(text.find('\n', next), text.size());
    } else if (text[next] != '[') {
      at = end_of_string(text, next);
      line += static_cast<std::int32_t>(
          std::count(text.begin() + std::ptrdiff_t(next), text.begin() + std::ptrdiff_t(at), '\n'));
    } else if (follows_a_key(text, next)) {
      ArrayReader reader(text, next, line);
      const auto end = reader.read();
      if (!end) continue;
      const auto breaks = std::count(text.begin() + std::ptrdiff_t(next), text.begin() + std::ptrdiff_t(*end), '\n');
      rest.append(text, copied, next - copied);
      rest += "[\"\\u0001" + std::to_string(taken_.size()) + "\"" +
              std::string(static_cast<std::size_t>(breaks), '\n') + "]";
      taken_.push_back(std::move(reader.numbers));
      line += static_cast<std::int32_t>(breaks);
      copied = at = *end;
    }
  }
  if (copied == 0) return text;
  return rest.append(text, copied);
}

Array* NumberArrays::find(const std::string& text) {
  if (text.size() < 2 || text.front() != kMark) return nullptr;
  const auto place = whole_number<std::size_t>(std::string_view(text).substr(1));
  return place && *place < taken_.size() ? &taken_[*place] : nullptr;
}

}  // namespace butee::config
