#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scale.hpp"

namespace butee::app::plot {

/// A picture, as a script of gnuplot.
struct Picture {
  std::string name;  ///< base name of its files
  std::string data;  ///< the script's data, in blocks
  std::string set;   ///< its settings
  std::string plot;  ///< the command that draws

  /// The whole script; it draws into each of `formats`.
  std::string script(const std::vector<std::string>& formats) const;
};

/// Points joined by lines, in SI units.
struct Curve {
  std::string title;
  std::vector<double> x, y;
  std::size_t colour = 0;
  bool points = false;  ///< draw separate points instead of a line
  bool wide = false;    ///< draw a wide line, because another curve is drawn over it
  bool path = false;    ///< x is not monotonic: a curve in the plane
  bool dashed = false;  ///< dashed: the edge of a fixed obstacle
};

/// A dashed line across the picture, in SI units.
struct Mark {
  double at;
  std::string title;  ///< "" if another mark's legend entry covers it
};

/// Curves over a common x axis.
struct Chart {
  std::string name, title;
  std::string x_name, x_unit, y_name, y_unit;
  bool log_y = false;
  bool from_zero = false;  ///< the y axis starts at zero
  bool in_plane = false;   ///< x and y have the same scale
  std::vector<Curve> curves;
  std::vector<Mark> levels;    ///< horizontal lines, values of y
  std::vector<Mark> uprights;  ///< vertical lines, values of x
  std::optional<double> x_begin, x_end, y_begin;

  Picture picture() const;
};

/// Characters that fit above the picture.
inline constexpr std::size_t kTitleWidth = 80;

/// A title in one or two lines, each no longer than `width` characters, escaped for double quotes of gnuplot.
std::string folded_title(std::string title, std::size_t width = kTitleWidth);

}  // namespace butee::app::plot
