#pragma once

#include <string>
#include <vector>

#include "butee/config/value.hpp"

namespace butee::config {

/// Removes long arrays of plain numbers from a TOML text before it is parsed, since the parser
/// needs microseconds for each number, and provides them afterwards.
///
/// An array is removed if it follows a `=` and holds only decimal integers and floats of at least
/// kShortest characters; any other array is left to the parser and its messages. It is replaced by
/// an array of one text, with the same line breaks.
class NumberArrays {
 public:
  static constexpr std::size_t kShortest = 512;

  /// The text without these arrays.
  std::string take_out(const std::string& text);
  /// The array represented by the only text of an array, or nullptr.
  Array* find(const std::string& text);

 private:
  std::vector<Array> taken_;
};

}  // namespace butee::config
