#pragma once

#include <cstddef>
#include <string>

namespace butee::config {

/// The size limit of a text, bytes.
constexpr std::size_t kLargestText = std::size_t{1} << 26U;

/// ":1: the file is larger than 64 MB"
std::string too_large();

/// Rejects a text that is larger or more deeply nested than any scene before it is parsed, since
/// the parser recurses for every bracket and its time grows with the square of the number of parts
/// of a key. Also rejects a text that is not UTF-8, since toml11 3.7 reads beyond the end of a
/// literal string with such bytes. Throws InputError (":line: what is wrong").
void check_limits(const std::string& text);

/// Rejects a text with a line longer than any in a scene, since the parser's time grows with the
/// square of its length.
void check_lines(const std::string& text);

/// The position after the TOML string whose first quote is at `at`; for an unclosed string, the end
/// of its line.
std::size_t end_of_string(const std::string& text, std::size_t at);

}  // namespace butee::config
