#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace butee::config {

/// A text whose lines were put into another order.
struct OrderedText {
  std::string text;
  std::vector<std::int32_t>
      lines;  ///< for each line of it, its number in the original, from 1; empty: nothing was moved

  /// The number in the original of a line of it, both from 1.
  std::int32_t original(std::int32_t line) const;
};

/// Puts every [table] that comes after its sub-tables before the first of them, in which TOML sees no difference:
/// toml11 3.7 refuses [output] below [[output.probe]].
OrderedText tables_before_their_parts(const std::string& text);

}  // namespace butee::config
