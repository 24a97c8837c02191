#pragma once

#include <string>

namespace butee::config {

/// Refuses a text that is larger, deeper or wider than any scene, before it is parsed: the parser recurses for every
/// bracket, and its time grows with the square of the parts of a key and of the length of a line. One that is no UTF-8
/// too, since toml11 3.7 reads beyond a literal string with such bytes. Throws InputError (":line: what is wrong").
void check_limits(const std::string& text);

}  // namespace butee::config
