#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scale.hpp"

namespace butee::app::plot {

/// A picture, as a script of gnuplot.
struct Picture {
  std::string name;  ///< of its files, without an ending
  std::string data;  ///< the script's data, in blocks
  std::string set;   ///< its settings
  std::string plot;  ///< the command that draws

  /// The whole script, which draws into each of `formats`.
  std::string script(const std::vector<std::string>& formats) const;
};

/// Points to be joined, in units of SI.
struct Curve {
  std::string title;
  std::vector<double> x, y;
  std::size_t colour = 0;
  bool points = false;  ///< are not to be joined
  bool wide = false;    ///< another one is drawn over it
  bool path = false;    ///< x goes to and fro: a curve in the plane
  bool dashed = false;  ///< the edge of something that does not move
};

/// A dashed line across the picture, in units of SI.
struct Mark {
  double at;
  std::string title;  ///< "" in the legend of another one
};

/// Curves over an axis.
struct Chart {
  std::string name, title;
  std::string x_name, x_unit, y_name, y_unit;
  bool log_y = false;
  bool from_zero = false;  ///< the y axis
  bool in_plane = false;   ///< x and y are drawn to one scale
  std::vector<Curve> curves;
  std::vector<Mark> levels;    ///< of y
  std::vector<Mark> uprights;  ///< of x
  std::optional<double> x_begin, x_end, y_begin;

  Picture picture() const;
};

/// A title in one or two lines, none longer than a picture is wide, to stand in double quotes of gnuplot.
std::string folded_title(std::string title);

}  // namespace butee::app::plot
