#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace butee::config {

/// A text whose lines were reordered.
struct OrderedText {
  std::string text;
  std::vector<std::int32_t> lines;  ///< original line number of each line, from 1; empty: nothing was moved

  /// The original line number of a line, both from 1.
  std::int32_t original(std::int32_t line) const;
};

/// Moves every [table] that follows its sub-tables before the first of them, which does not change
/// the meaning of the TOML text: toml11 3.7 rejects [output] below [[output.probe]].
OrderedText tables_before_their_parts(const std::string& text);

}  // namespace butee::config
