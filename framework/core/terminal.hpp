#pragma once

#include <cstdio>

#include <butee/export.hpp>

namespace butee {

/// True where `stream` goes to a terminal.
BUTEE_EXPORT bool is_terminal(std::FILE* stream);

/// The columns of the terminal that `stream` goes to; `fallback` where it is none or does not say.
BUTEE_EXPORT int terminal_width(std::FILE* stream, int fallback = 80);

/// True where colours may be written to `stream`: a terminal that is not dumb, and no NO_COLOR (https://no-color.org).
BUTEE_EXPORT bool takes_colour(std::FILE* stream);

}  // namespace butee
