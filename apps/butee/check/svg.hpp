#pragma once

#include <string>
#include <utility>
#include <vector>

namespace butee::app::check {

/// A picture in SVG, built shape by shape; lengths in pixels, y downwards.
class Svg {
 public:
  Svg(double width, double height);

  void line(double x1, double y1, double x2, double y2, const std::string& colour, double width = 1.0);
  void path(const std::vector<std::pair<double, double>>& points, const std::string& colour, double width = 1.0);
  void polygon(const std::vector<std::pair<double, double>>& points, const std::string& fill);
  void circle(double x, double y, double radius, const std::string& fill);
  /// `anchor` is start, middle or end; `text` is escaped, and moved into the picture if it would begin or end outside.
  /// Texts lie above all shapes, with a white border.
  void text(double x, double y, const std::string& text, const std::string& anchor = "start", double size = 12.0,
            const std::string& colour = "#222222");

  std::string finish() const { return shapes_ + labels_ + "</svg>\n"; }

 private:
  double width_;
  std::string shapes_, labels_;
};

}  // namespace butee::app::check
