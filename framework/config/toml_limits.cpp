#include "butee/config/toml_limits.hpp"

#include <algorithm>

#include "butee/core/error.hpp"

namespace butee::config {
namespace {

constexpr int kDeepest = 100;
constexpr std::size_t kLongestLine = 65536;
constexpr std::size_t kLargest = std::size_t{1} << 26;

void check_lines(const std::string& text) {
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end - begin > kLongestLine)
      throw InputError(":" + std::to_string(line) + ": the line is longer than " + std::to_string(kLongestLine) +
                       " characters; an array may go over many lines");
    begin = end + 1;
  }
}

/// Goes through a text from token to token, strings and comments as a whole.
class LimitScanner {
 public:
  explicit LimitScanner(const std::string& text) : text_(text) {}

  void scan() {
    while (at_ < text_.size()) step();
  }

 private:
  void step() {
    switch (const char c = text_[at_]) {
      case '"':
      case '\'':
        return skip_string(c);
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

  bool three(char quote) const { return text_.compare(at_, 3, std::string(3, quote)) == 0; }

  void skip_string(char quote) {
    const bool is_long = three(quote);
    at_ += is_long ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\\' && quote == '"') {
        ++at_;
      } else if (!is_long && text_[at_] == '\n') {
        return;
      } else if (!is_long && text_[at_] == quote) {
        ++at_;
        return;
      } else if (is_long && three(quote)) {
        // Up to two more quotes belong to the string.
        for (int i = 0; i < 5 && at_ < text_.size() && text_[at_] == quote; ++i) ++at_;
        return;
      }
    }
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

void check_limits(const std::string& text) {
  if (text.size() > kLargest)
    throw InputError(":1: the file is larger than " + std::to_string(kLargest >> 20U) + " MB");
  check_lines(text);
  LimitScanner(text).scan();
}

}  // namespace butee::config
