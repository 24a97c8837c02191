#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <butee/core/text.hpp>

#include "picture.hpp"
#include "svg.hpp"

namespace butee::app::check {
namespace in_space {
namespace {

using model::NodeGroup;
using model::NodeId;
using Point = std::array<double, 3>;

constexpr double kSide = 760.0, kMargin = 90.0, kTop = 60.0;
constexpr const char* kBeam = "#1f3b57";
constexpr const char* kSupport = "#555555";
constexpr const char* kLoad = "#c0392b";
constexpr const char* kSpring = "#2e7d32";
constexpr const char* kStop = "#d17a00";
constexpr const char* kFaint = "#777777";
constexpr std::size_t kMostNodes = 400, kMostLoads = 60;

bool is_along_x(const NodeGroup& group) {
  return group.direction == Point{1.0, 0.0, 0.0} && group.origin == Point{0.0, 0.0, 0.0};
}

/// Projection: y upwards, x to the right, z towards the lower left; the angles keep neighbours from covering
/// each other.
std::array<double, 2> projected(const Point& p) {
  return {0.94 * p[0] - 0.5 * p[2], -p[1] + 0.2 * p[0] + 0.36 * p[2]};
}

class Drawing {
 public:
  explicit Drawing(const model::Model& model) : model_(model), nodes_(model.nodes) {
    find_points();
    for (const auto& [node, point] : points_) {
      const auto [x, y] = projected(point);
      left_ = std::min(left_, x), right_ = std::max(right_, x);
      upper_ = std::min(upper_, y), lower_ = std::max(lower_, y);
    }
    const double span = std::max(right_ - left_, lower_ - upper_);
    scale_ = span > 0.0 ? (kSide - 2.0 * kMargin) / span : 1.0;
  }

  std::string draw(const Survey& survey) {
    Svg svg(kSide, kTop + height() + 90.0);
    svg.text(20.0, 26.0, model_.title.empty() ? "(without a title)" : model_.title, "start", 16.0);
    for (const SpringPlace& spring : survey.springs) draw(spring, svg);
    for (const std::string& name : nodes_.group_names()) draw(*nodes_.find(name), svg);
    draw_supports(svg);
    draw_stops(svg);
    draw_loads(svg);
    for (const MassPlace& mass : survey.masses) {
      const auto [x, y] = at(mass.node);
      svg.circle(x, y, 6.5, kBeam);
      svg.text(x + 12.0, y + 14.0, to_short_text(mass.mass) + " kg", "start", 11.0);
    }
    draw_axes(svg);
    return svg.finish();
  }

 private:
  double height() const { return scale_ * (lower_ - upper_) + 2.0 * kMargin; }

  void find_points() {
    for (const std::string& name : nodes_.group_names()) {
      const NodeGroup& group = *nodes_.find(name);
      for (NodeId i = 0; i < group.size() && !group.lone(); ++i) {
        Point point = group.origin;
        for (std::size_t k = 0; k < 3; ++k)
          point[k] += group.coordinates[static_cast<std::size_t>(i)] * group.direction[k];
        points_.emplace(nodes_.canonical(group.first + i), point);
      }
    }
  }

  /// Position of a node in the picture; nodes without coordinates are drawn in a row below.
  std::array<double, 2> at(NodeId node) {
    const NodeId wanted = nodes_.canonical(node);
    const auto found = points_.find(wanted);
    if (found == points_.end()) {
      const auto [place, is_new] = lone_.emplace(wanted, lone_.size());
      return {kMargin + 90.0 * static_cast<double>(place->second), kTop + height()};
    }
    const auto [x, y] = projected(found->second);
    return {kMargin + scale_ * (x - left_), kTop + kMargin + scale_ * (y - upper_)};
  }

  void draw(const NodeGroup& group, Svg& svg) {
    const auto [x1, y1] = at(group.first);
    if (group.lone()) {
      if (points_.contains(nodes_.canonical(group.first))) return;
      svg.circle(x1, y1, 4.0, kBeam);
      return svg.text(x1 + 10.0, y1 - 6.0, group.name);
    }
    const auto [x2, y2] = at(group.first + group.size() - 1);
    svg.line(x1, y1, x2, y2, kBeam, 3.0);
    if (static_cast<std::size_t>(group.size()) <= kMostNodes)
      for (NodeId i = 0; i < group.size(); ++i) {
        const auto [x, y] = at(group.first + i);
        svg.circle(x, y, 2.0, kBeam);
      }
    svg.text(0.5 * (x1 + x2) + 8.0, 0.5 * (y1 + y2) - 8.0, group.name);
  }

  void draw(const SpringPlace& spring, Svg& svg) {
    const auto [x1, y1] = at(spring.a);
    if (spring.b >= 0) {
      const auto [x2, y2] = at(spring.b);
      return svg.line(x1, y1, x2, y2, kSpring, 1.5);
    }
    svg.path({{x1, y1}, {x1 + 5.0, y1 + 6.0}, {x1 - 5.0, y1 + 12.0}, {x1 + 5.0, y1 + 18.0}, {x1, y1 + 24.0}}, kSpring,
             1.5);
    svg.line(x1 - 9.0, y1 + 24.0, x1 + 9.0, y1 + 24.0, kSpring, 2.5);
  }

  void draw_supports(Svg& svg) {
    std::map<NodeId, std::string> held;
    for (const model::NodalDof& dof : model_.fixed) {
      std::string& names = held[nodes_.canonical(dof.node)];
      names += (names.empty() ? "" : " ") + std::string(name_of(dof.kind));
    }
    for (const auto& [node, names] : held) {
      const auto [x, y] = at(node);
      svg.polygon({{x, y + 3.0}, {x - 9.0, y + 17.0}, {x + 9.0, y + 17.0}}, kSupport);
      svg.text(x, y + 30.0, names, "middle", 10.0, kFaint);
    }
  }

  void draw_stops(Svg& svg) {
    for (const model::StopGroup& group : model_.stops)
      draw_group(svg, group, group.play.has_both(), group.play.has_positive());
    // Rings and planes surround their node or lie to one side of it; both are drawn as stops on two sides.
    for (const model::ObstacleGroup& group : model_.obstacles)
      if (group.shape != nullptr) draw_group(svg, group, true, true);
  }

  template <class Group>
  void draw_group(Svg& svg, const Group& group, bool has_both, bool has_positive) {
    for (std::size_t i = 0; i < group.a.size(); ++i) {
      const auto [x, y] = at(group.a[i]);
      if (!group.b.empty()) {
        const auto [u, v] = at(group.b[i]);
        svg.line(x, y, u, v, kStop, 1.4);
        continue;
      }
      for (const double side : {-1.0, 1.0}) {
        if (!has_both && has_positive != (side < 0.0)) continue;  // The picture's y axis points down.
        const double tip = y + side * 8.0;
        svg.polygon({{x, tip}, {x - 5.0, tip + side * 8.0}, {x + 5.0, tip + side * 8.0}}, kStop);
      }
    }
  }

  void draw_loads(Svg& svg) {
    for (const model::Load& load : model_.loads) {
      if (!load.acceleration.isZero(0.0)) continue;
      const std::size_t stride = load.pattern.size() / kMostLoads + 1;
      for (std::size_t i = 0; i < load.pattern.size(); i += stride) {
        const model::NodalDof dof = load.pattern[i].dof;
        Point axis{};
        axis[static_cast<std::size_t>(axis_of(dof.kind))] = 1.0;
        const auto [dx, dy] = projected(axis);
        const auto [x, y] = at(dof.node);
        const double length = (load.pattern.size() == 1 ? 44.0 : 16.0) / std::hypot(dx, dy);
        svg.line(x - length * dx, y - length * dy, x, y, kLoad, is_rotation(dof.kind) ? 4.0 : 2.0);
        svg.circle(x, y, 3.5, kLoad);
        if (load.pattern.size() == 1)
          svg.text(x - length * dx + 6.0, y - length * dy - 4.0,
                   describe(*load.in_time, load.pattern[i].value, is_rotation(dof.kind) ? "N m" : "N"), "start", 11.0,
                   kLoad);
      }
    }
  }

  void draw_axes(Svg& svg) {
    const double x = 46.0, y = kTop + height() + 50.0;
    for (int axis = 0; axis < 3; ++axis) {
      Point unit{};
      unit[static_cast<std::size_t>(axis)] = 1.0;
      const auto [dx, dy] = projected(unit);
      svg.line(x, y, x + 34.0 * dx, y + 34.0 * dy, kFaint, 1.5);
      svg.text(x + 44.0 * dx, y + 44.0 * dy + 4.0, std::string(1, "xyz"[axis]), "middle", 12.0, kFaint);
    }
  }

  const model::Model& model_;
  const model::NodeTable& nodes_;
  std::map<NodeId, Point> points_;  ///< of the nodes of beams, by canonical node
  std::map<NodeId, std::size_t> lone_;
  double left_ = INFINITY, right_ = -INFINITY, upper_ = INFINITY, lower_ = -INFINITY, scale_ = 1.0;
};

}  // namespace
}  // namespace in_space

bool is_in_space(const model::Model& model) {
  const auto names = model.nodes.group_names();
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return !in_space::is_along_x(*model.nodes.find(name)); });
}

std::string list_in_space(const model::Model& model) {
  using model::NodeGroup;
  const auto place = [](const NodeGroup& group, double coordinate) {
    std::string text = "(";
    for (std::size_t k = 0; k < 3; ++k)
      text += (k > 0 ? ", " : "") + to_short_text(group.origin[k] + coordinate * group.direction[k]);
    return text + ")";
  };
  std::size_t width = 0;
  for (const std::string& name : model.nodes.group_names()) width = std::max(width, name.size());
  std::string text;
  for (const std::string& name : model.nodes.group_names()) {
    const NodeGroup& group = *model.nodes.find(name);
    text += name + std::string(width - name.size(), ' ');
    if (group.lone())
      text += "  a node\n";
    else
      text += "  from " + place(group, group.coordinates.front()) + " to " + place(group, group.coordinates.back()) +
              " m, " + std::to_string(group.size() - 1) + " elements\n";
  }
  return text + "--picture FILE.svg draws it in space\n";
}

std::string picture_in_space(const model::Model& model, const Survey& survey) {
  return in_space::Drawing(model).draw(survey);
}

}  // namespace butee::app::check
