#include "frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "../gnuplot.hpp"

namespace butee::app::plot {
namespace {

/// Drawn length of the largest displacement, as a fraction of the structure's size.
constexpr double kDrawn = 0.1;
constexpr std::size_t kMostRecords = 2000;

using Points = std::vector<std::array<double, 3>>;

/// Displacements at a record, and the largest displacement.
class Displacements {
 public:
  explicit Displacements(model::FieldReader& fields) : fields_(fields), values_(fields.layout().nodes.size()) {
    const auto& names = fields.layout().fields;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < names.size(); ++i)
        if (const auto kind = dof_named(names[i].name); kind && *kind == displacement_along(static_cast<int>(axis)))
          field_[axis] = static_cast<std::ptrdiff_t>(i);
  }
  bool any() const {
    return std::any_of(field_.begin(), field_.end(), [](std::ptrdiff_t field) { return field >= 0; });
  }
  Points at(std::size_t record) {
    Points points(values_.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (field_[axis] < 0) continue;
      fields_.read(record, static_cast<std::size_t>(field_[axis]), values_);
      for (std::size_t i = 0; i < values_.size(); ++i) points[i][axis] = values_[i];
    }
    return points;
  }

 private:
  model::FieldReader& fields_;
  std::vector<double> values_;
  std::array<std::ptrdiff_t, 3> field_ = {-1, -1, -1};
};

double largest_in(const Points& points) {
  double largest = 0.0;
  for (const auto& [x, y, z] : points) largest = std::max(largest, std::hypot(x, y, z));
  return largest;
}

/// gnuplot's data block of lines, separated from each other. Its vertical axis is the y axis of the scene.
std::string block(const char* name, const model::FieldLayout& layout, const Points& moved, double factor) {
  std::string text = std::string(name) + " << EOD\n";
  for (const model::FieldLine& line : layout.lines) {
    for (const Index node : line.nodes) {
      const auto i = static_cast<std::size_t>(node);
      for (const std::size_t axis : {2, 0, 1})
        text += short_number(layout.positions[i][axis] + (moved.empty() ? 0.0 : factor * moved[i][axis]), 6) + " ";
      text += "\n";
    }
    text += "\n\n";
  }
  return text + "EOD\n";
}

}  // namespace

std::vector<Picture> frame_pictures(const Result& result, model::FieldReader& fields, Window window, bool several) {
  const model::FieldLayout& layout = fields.layout();
  std::array<double, 3> least, most;
  least.fill(INFINITY);
  most.fill(-INFINITY);
  for (const auto& position : layout.positions)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], position[axis]);
      most[axis] = std::max(most[axis], position[axis]);
    }
  Displacements displacements(fields);
  // Beams along x lie side by side, not above each other.
  if (layout.lines.empty() || !displacements.any() || !(most[1] > least[1])) return {};
  std::size_t chosen = 0, seen = 0;
  double largest = -1.0;
  const std::size_t stride = fields.times().size() / kMostRecords + 1;
  for (std::size_t i = 0; i < fields.times().size(); i += stride) {
    if (fields.times()[i] < window.from || fields.times()[i] > window.to) continue;
    ++seen;
    if (const double size = largest_in(displacements.at(i)); size > largest) largest = size, chosen = i;
  }
  if (seen == 0) return {};
  const double length = std::hypot(most[0] - least[0], most[1] - least[1], most[2] - least[2]);
  const double factor = largest > 0.0 ? kDrawn * length / largest : 0.0;
  Picture picture;
  picture.name = several ? "frame-" + result.label : "frame";
  picture.data = block("$rest", layout, {}, 0.0) + block("$moved", layout, displacements.at(chosen), factor);
  const std::string moved = "at t = " + short_number(fields.times()[chosen], 5) + " s, drawn " +
                            short_number(factor, 3) + " times as large (" + short_number(largest, 4) + " m)";
  picture.set = "set title \"" + folded_title(result.title.empty() ? result.label : result.title) +
                "\" noenhanced\nset view 65, 35\nset view equal xyz\nset xyplane 0\nset xlabel 'z / m'\nset ylabel 'x "
                "/ m'\nset zlabel 'y / m'\n" +
                gnuplot::legend_below({"at rest", moved});
  picture.plot =
      "splot $rest with lines lw 1 lc rgb '#999999' title 'at rest', \\\n     $moved with lines lw 2 lc rgb '" +
      std::string(gnuplot::kColours.front()) + "' title " + gnuplot::quoted(moved);
  return {picture};
}

}  // namespace butee::app::plot
