#pragma once

#include <string>

#include "layout.hpp"

namespace butee::app::check {

/// The scene as SVG: beams, supports, stops with their gaps to a common transverse scale, springs, masses, loads.
std::string picture_svg(const Layout& layout);

/// True if a beam does not lie along x from the origin.
bool is_in_space(const model::Model& model);

/// A scene in space as SVG in an oblique view: beams, supports with the names of the held DOFs, stops,
/// springs, masses, and loads along their axes.
std::string picture_in_space(const model::Model& model, const Survey& survey);

/// The beams of a scene in space with the coordinates of their ends, one line each.
std::string list_in_space(const model::Model& model);

/// Any scene as a few lines of text of at most `width` columns, with box-drawing characters if `utf8`.
std::string picture_text(const Layout& layout, int width, bool utf8);

/// True if the locale of the environment (LC_ALL, LC_CTYPE, LANG) is UTF-8.
bool locale_is_utf8();

}  // namespace butee::app::check
