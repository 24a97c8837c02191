#pragma once

#include <cstddef>
#include <string>

namespace butee::config {

/// The size of the largest text that is read, bytes.
constexpr std::size_t kLargestText = std::size_t{1} << 26U;

/// ":1: the file is larger than 64 MB"
std::string too_large();

/// The place behind the string, of one line or of several, whose first quote is at `at`; behind its line or the text
/// where it does not end.
std::size_t end_of_string(const std::string& text, std::size_t at);

/// Refuses a text that is larger, deeper or wider than any scene, before it is parsed: the parser recurses for every
/// bracket, and its time grows with the square of the parts of a key and of the length of a line. One that is no UTF-8
/// too, since toml11 3.7 reads beyond a literal string with such bytes. Throws InputError (":line: what is wrong").
void check_limits(const std::string& text);

}  // namespace butee::config
