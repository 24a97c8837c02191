#include "butee/config/toml_limits.hpp"

#include <algorithm>

#include "butee/core/error.hpp"

namespace butee::config {
namespace {

constexpr int kDeepest = 100;
constexpr std::size_t kLongestLine = 65536;

/// The length of the UTF-8 sequence that begins at a byte, 0 if it is invalid: RFC 3629, section 4.
std::size_t sequence_at(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) -> unsigned { return at + i < text.size() ? text[at + i] & 0xffU : 0U; };
  const auto goes_on = [&](std::size_t i) { return (byte(i) & 0xc0U) == 0x80U; };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80U) return 1;
  if (first >= 0xc2U && first <= 0xdfU) return goes_on(1) ? 2 : 0;
  if (first >= 0xe0U && first <= 0xefU) {
    const bool is_short = first == 0xe0U && second < 0xa0U, is_surrogate = first == 0xedU && second > 0x9fU;
    return goes_on(1) && goes_on(2) && !is_short && !is_surrogate ? 3 : 0;
  }
  if (first < 0xf0U || first > 0xf4U) return 0;
  const bool is_short = first == 0xf0U && second < 0x90U, is_beyond = first == 0xf4U && second > 0x8fU;
  return goes_on(1) && goes_on(2) && goes_on(3) && !is_short && !is_beyond ? 4 : 0;
}

void check_encoding(const std::string& text) {
  std::size_t line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = sequence_at(text, at);
    if (length == 0)
      throw InputError(":" + std::to_string(line) + ": byte " + std::to_string(at + 1) +
                       " of the file is not UTF-8, the encoding of TOML; save the file in UTF-8");
    if (text[at] == '\n') ++line;
    at += length;
  }
}

/// Scans a text token by token; strings and comments are single tokens.
class LimitScanner {
 public:
  explicit LimitScanner(const std::string& text) : text_(text) {}

  void scan() {
    while (at_ < text_.size()) step();
  }

 private:
  void step() {
    switch (text_[at_]) {
      case '"':
      case '\'':
        at_ = end_of_string(text_, at_);
        return;
      case '#':
        at_ = std::min(text_.find('\n', at_), text_.size());
        return;
      case '[':
      case '{':
        dots_ = 0;
        if (++depth_ > kDeepest) refuse("brackets stand in one another");
        break;
      case ']':
      case '}':
        dots_ = 0;
        depth_ = std::max(depth_ - 1, 0);
        break;
      case '.':
        if (++dots_ >= kDeepest) refuse("parts make one dotted key");
        break;
      case '\n':
      case '=':
      case ',':
        dots_ = 0;
        break;
      default:
        break;
    }
    ++at_;
  }

  [[noreturn]] void refuse(const char* what) const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(at_);
    throw InputError(":" + std::to_string(1 + std::count(text_.begin(), end, '\n')) + ": more than " +
                     std::to_string(kDeepest) + " " + what);
  }

  const std::string& text_;
  std::size_t at_ = 0;
  int depth_ = 0, dots_ = 0;
};

}  // namespace

std::string too_large() {
  return ":1: the file is larger than " + std::to_string(kLargestText >> 20U) + " MB";
}

void check_lines(const std::string& text) {
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > kLongestLine)
      throw InputError(":" + std::to_string(line) + ": the line is longer than " + std::to_string(kLongestLine) +
                       " characters; an array may span several lines");
    begin = end + 1;
  }
}

std::size_t end_of_string(const std::string& text, std::size_t at) {
  const char quote = text[at];
  const auto three = [&] { return text.compare(at, 3, std::string(3, quote)) == 0; };
  const bool is_long = three();
  at += is_long ? 3 : 1;
  for (; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (!is_long && text[at] == '\n') {
      return at;
    } else if (!is_long && text[at] == quote) {
      return at + 1;
    } else if (is_long && three()) {
      // Up to two more quotes belong to the string.
      for (int i = 0; i < 5 && at < text.size() && text[at] == quote; ++i) ++at;
      return at;
    }
  }
  return std::min(at, text.size());
}

void check_limits(const std::string& text) {
  if (text.size() > kLargestText) throw InputError(too_large());
  check_encoding(text);
  LimitScanner(text).scan();
}

}  // namespace butee::config
