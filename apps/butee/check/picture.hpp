#pragma once

#include <string>

#include "layout.hpp"

namespace butee::app::check {

/// The scene as SVG: beams, supports, stops with their gaps to a common transverse scale, springs, masses, loads.
std::string picture_svg(const Layout& layout);

/// True where a beam does not lie along x from the origin.
bool is_in_space(const model::Model& model);

/// Such a scene as SVG, seen from above its front: beams where they stand, supports with the names of what they hold,
/// stops, springs, masses, loads along their axes.
std::string picture_in_space(const model::Model& model, const Survey& survey);

/// The beams of such a scene with their ends, a line each.
std::string list_in_space(const model::Model& model);

/// Any scene as a few lines of text of at most `width` columns, with box-drawing characters where `utf8`.
std::string picture_text(const Layout& layout, int width, bool utf8);

/// True where the locale of the environment (LC_ALL, LC_CTYPE, LANG) is UTF-8.
bool locale_is_utf8();

}  // namespace butee::app::check
