#pragma once

#include <string>

#include "layout.hpp"

namespace butee::app::check {

/// The scene as SVG: beams, supports, stops with their gaps to a common transverse scale, springs, masses, loads.
std::string picture_svg(const Layout& layout);

/// The same as a few lines of text of at most `width` columns, with box-drawing characters where `utf8`.
std::string picture_text(const Layout& layout, int width, bool utf8);

/// True where the locale of the environment (LC_ALL, LC_CTYPE, LANG) is UTF-8.
bool locale_is_utf8();

}  // namespace butee::app::check
