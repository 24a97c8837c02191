#pragma once

#include <string>
#include <vector>

#include "butee/config/value.hpp"

namespace butee::config {

/// Takes long arrays of plain numbers out of a TOML text before its parser sees them, which needs microseconds for
/// every number, and gives them back afterwards.
///
/// An array is taken where it follows a `=` and holds nothing but decimal integers and floats of at least kShortest
/// characters; any other is left to the parser and its messages. In its place stands an array of one text, with the
/// same line breaks.
class NumberArrays {
 public:
  static constexpr std::size_t kShortest = 512;

  /// The text without them.
  std::string take_out(const std::string& text);
  /// The array that the only text of an array stands for, or nullptr.
  Array* find(const std::string& text);

 private:
  std::vector<Array> taken_;
};

}  // namespace butee::config
