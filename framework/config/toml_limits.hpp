#pragma once

#include <cstddef>
#include <string>

namespace butee::config {

/// The size of the largest text that is read, bytes.
constexpr std::size_t kLargestText = std::size_t{1} << 26U;

/// ":1: the file is larger than 64 MB"
std::string too_large();

/// Refuses a text that is larger or deeper than any scene, before it is parsed: the parser recurses for every bracket,
/// and its time grows with the square of the parts of a key. One that is no UTF-8 too, since toml11 3.7 reads beyond a
/// literal string with such bytes. Throws InputError (":line: what is wrong").
void check_limits(const std::string& text);

/// Refuses a text with a line that is wider than any scene's: the parser's time grows with the square of its length.
void check_lines(const std::string& text);

/// The place behind the string of TOML whose first quote is at `at`; of one that is not closed, where its line ends.
std::size_t end_of_string(const std::string& text, std::size_t at);

}  // namespace butee::config
