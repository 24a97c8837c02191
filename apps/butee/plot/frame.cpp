#include "frame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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

/// The projection of space onto the picture.
struct View {
  std::array<double, 3> right, up;
  const char *right_name = nullptr, *up_name = nullptr;  ///< of the axes; nullptr if they are no axes of the scene
};

/// A structure and motion in one plane of the axes are seen from in front, others along an oblique direction.
View view_of(const model::FieldLayout& layout, const Points& moved) {
  constexpr double kOutOfPlane = 0.1;  // of the largest displacement
  const double allowed = kOutOfPlane * largest_in(moved);
  const auto is_flat = [&](std::size_t axis) {
    const auto& positions = layout.positions;
    return std::all_of(positions.begin(), positions.end(),
                       [&](const auto& position) { return position[axis] == positions.front()[axis]; }) &&
           std::all_of(moved.begin(), moved.end(), [&](const auto& u) { return std::abs(u[axis]) <= allowed; });
  };
  if (is_flat(2)) return {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, "x", "y"};
  if (is_flat(0)) return {{0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, "z", "y"};
  // From 35 degrees to the right of the z axis and 25 degrees above the horizontal plane.
  const double turn = 35.0 * std::numbers::pi / 180.0, tilt = 25.0 * std::numbers::pi / 180.0;
  return {{std::cos(turn), 0.0, -std::sin(turn)},
          {-std::sin(turn) * std::sin(tilt), std::cos(tilt), -std::cos(turn) * std::sin(tilt)}};
}

double along(const std::array<double, 3>& direction, const std::array<double, 3>& point) {
  return direction[0] * point[0] + direction[1] * point[1] + direction[2] * point[2];
}

/// gnuplot's data block of lines, separated from each other.
std::string block(const char* name, const model::FieldLayout& layout, const View& view, const Points& moved,
                  double factor) {
  std::string text = std::string(name) + " << EOD\n";
  for (const model::FieldLine& line : layout.lines) {
    for (const Index node : line.nodes) {
      const auto i = static_cast<std::size_t>(node);
      std::array<double, 3> point = layout.positions[i];
      for (std::size_t axis = 0; axis < 3; ++axis) point[axis] += factor * moved[i][axis];
      text += short_number(along(view.right, point), 6) + " " + short_number(along(view.up, point), 6) + "\n";
    }
    text += "\n";
  }
  return text + "EOD\n";
}

/// Axes of the picture, or arrows along x, y and z in its lower left corner.
std::string axes_of(const View& view) {
  if (view.right_name != nullptr)
    return std::string("set xlabel '") + view.right_name + " / m'\nset ylabel '" + view.up_name + " / m'\n";
  std::string text = "unset border\nunset tics\n";
  constexpr double kArrow = 0.09;  // of the picture's height
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  const auto at = [&](std::size_t axis, double size) {
    return "screen " + short_number(0.09 + gnuplot::kFlat * kArrow * size * view.right[axis]) + ", screen " +
           short_number(0.3 + kArrow * size * view.up[axis]);
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    text += "set arrow from " + at(axis, 0.0) + " to " + at(axis, 1.0) + " lw 1 lc rgb '#444444'\nset label '" +
            kNames[axis] + "' at " + at(axis, 1.3) + " center\n";
  return text;
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
  const Points moved = displacements.at(chosen);
  const View view = view_of(layout, moved);
  Picture picture;
  picture.name = several ? "frame-" + result.label : "frame";
  picture.data = block("$rest", layout, view, moved, 0.0) + block("$moved", layout, view, moved, factor);
  const std::string text = "at t = " + short_number(fields.times()[chosen], 5) + " s, drawn " +
                           short_number(factor, 3) + " times as large (" + short_number(largest, 4) + " m)";
  picture.set = "set title \"" + folded_title(result.title.empty() ? result.label : result.title) +
                "\" noenhanced\nset size ratio -1\nset offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\n" +
                axes_of(view) + gnuplot::legend_below({"at rest", text});
  picture.plot =
      "plot $rest with lines lw 1 lc rgb '#999999' title 'at rest', \\\n     $moved with lines lw 2 lc rgb '" +
      std::string(gnuplot::kColours.front()) + "' title " + gnuplot::quoted(text);
  return {picture};
}

}  // namespace butee::app::plot
