#pragma once

#include <string>

namespace butee::config {

/// Refuses a text whose brackets or dotted keys go deeper than any scene's, before it is parsed: the parser recurses
/// for every bracket, and its time grows with the square of the parts of a key. Throws InputError (":line: what is
/// wrong").
void check_depth(const std::string& text);

}  // namespace butee::config
