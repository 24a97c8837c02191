#pragma once

#include <cstdio>

#include <butee/export.hpp>

namespace butee {

/// True if `stream` is a terminal.
BUTEE_EXPORT bool is_terminal(std::FILE* stream);

/// The number of columns of the terminal of `stream`; `fallback` if it is not a terminal or the
/// width is unknown.
BUTEE_EXPORT int terminal_width(std::FILE* stream, int fallback = 80);

/// True if colours may be written to `stream`: a terminal that is not dumb, and no NO_COLOR
/// (https://no-color.org).
BUTEE_EXPORT bool takes_colour(std::FILE* stream);

}  // namespace butee
