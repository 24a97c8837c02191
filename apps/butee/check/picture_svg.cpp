#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <butee/core/text.hpp>

#include "picture.hpp"
#include "svg.hpp"

namespace butee::app::check {
namespace {

constexpr double kWidth = 960.0, kMargin = 126.0, kRowHeight = 170.0, kTop = 60.0;
constexpr double kLargestGap = 34.0;  ///< px, distance of the widest gap from its node
constexpr std::size_t kMostMarks = 400;
constexpr const char* kBeam = "#1f3b57";
constexpr const char* kSupport = "#555555";
constexpr const char* kLoad = "#c0392b";
constexpr const char* kSpring = "#2e7d32";
constexpr std::array<const char*, 6> kStops = {"#d17a00", "#7b3fa0", "#00838f", "#ad1457", "#5d6d1e", "#37474f"};

class Drawing {
 public:
  explicit Drawing(const Layout& layout)
      : layout_(layout), svg_(kWidth, kTop + kRowHeight * layout.rows + 30.0 + 18.0 * legend_lines(layout)) {
    for (const StopMark& stop : layout.stops) widest_gap_ = std::max(widest_gap_, stop.gap);
  }

  std::string draw() {
    svg_.text(20.0, 26.0, layout_.title.empty() ? "(without a title)" : layout_.title, "start", 16.0);
    for (const SpringMark& spring : layout_.springs) draw(spring);
    for (const Body& body : layout_.bodies) draw(body);
    for (const SupportMark& support : layout_.supports) draw(support);
    const std::size_t stride = layout_.stops.size() / kMostMarks + 1;
    for (std::size_t i = 0; i < layout_.stops.size(); i += stride) draw(layout_.stops[i]);
    for (const MassMark& mass : layout_.masses) draw(mass);
    for (const LoadMark& load : layout_.loads) draw(load);
    draw_legend();
    return svg_.finish();
  }

 private:
  static double legend_lines(const Layout& layout) { return static_cast<double>(layout.stop_labels.size()) + 1.0; }

  double x(double along) const {
    const double span = layout_.right - layout_.left;
    if (!(span > 0.0)) return 0.5 * kWidth;
    return kMargin + (kWidth - 2.0 * kMargin) * (along - layout_.left) / span;
  }
  static double y(int row) { return kTop + kRowHeight * (row + 0.5); }
  double depth(double gap) const { return widest_gap_ > 0.0 ? 6.0 + kLargestGap * gap / widest_gap_ : 6.0; }

  void draw(const Body& body) {
    const double height = y(body.row);
    if (body.lone) {
      svg_.circle(x(body.begin), height, 5.0, kBeam);
      svg_.text(x(body.begin) + 14.0, height - 8.0, body.name);
      return;
    }
    svg_.line(x(body.begin), height, x(body.end), height, kBeam, 4.0);
    if (body.nodes.size() <= 80)
      for (const double node : body.nodes) svg_.circle(x(node), height, 2.6, kBeam);
    const std::string length =
        to_short_text(body.end - body.begin) + " m, " + std::to_string(body.nodes.size() - 1) + " elements";
    svg_.text(0.5 * (x(body.begin) + x(body.end)), height + 72.0, body.name + ": " + length, "middle");
    svg_.line(x(body.begin), height + 56.0, x(body.end), height + 56.0, "#999999");
    for (const double end : {x(body.begin), x(body.end)}) svg_.line(end, height + 51.0, end, height + 61.0, "#999999");
  }

  void draw(const SupportMark& support) {
    const double place = x(support.at.x), height = y(support.at.row);
    if (support.u)
      svg_.polygon({{place, height + 3.0}, {place - 9.0, height + 18.0}, {place + 9.0, height + 18.0}}, kSupport);
    if (support.theta) svg_.line(place, height - 14.0, place, height + 14.0, kSupport, 5.0);
  }

  void draw(const StopMark& stop) {
    const char* colour = kStops[static_cast<std::size_t>(stop.group) % kStops.size()];
    const double place = x(stop.at.x), height = y(stop.at.row), gap = depth(stop.gap);
    if (stop.other) {
      const double other = y(stop.other->row), middle = 0.5 * (height + other);
      const double half = std::min(0.5 * gap, 0.4 * std::abs(other - height));
      const double sign = other > height ? 1.0 : -1.0;
      svg_.line(place, height, place, middle - sign * half, colour, 1.4);
      svg_.line(x(stop.other->x), other, x(stop.other->x), middle + sign * half, colour, 1.4);
      for (const double end : {middle - half, middle + half})
        svg_.line(place - 5.0, end, place + 5.0, end, colour, 1.6);
      return;
    }
    const auto wedge = [&](double direction) {
      const double tip = height + direction * gap;
      svg_.polygon({{place, tip}, {place - 5.0, tip + direction * 9.0}, {place + 5.0, tip + direction * 9.0}}, colour);
    };
    if (stop.positive) wedge(-1.0);
    if (stop.negative) wedge(1.0);
  }

  void draw(const SpringMark& spring) {
    // Springs to ground are drawn beside the node, because a stop may be drawn below it.
    const double begin = y(spring.a.row), side = spring.along_z ? 1.0 : -1.0;
    const double place = x(spring.a.x) + (spring.b ? 0.0 : 18.0 * side);
    if (!spring.b) svg_.line(x(spring.a.x), begin, place, begin, kSpring, 1.5);
    const double last = spring.b ? x(spring.b->x) : place, end = spring.b ? y(spring.b->row) : begin + 48.0;
    std::vector<std::pair<double, double>> points = {{place, begin}};
    constexpr int kTurns = 8;
    for (int i = 1; i < kTurns; ++i) {
      const double s = static_cast<double>(i) / kTurns;
      points.emplace_back(place + s * (last - place) + (i % 2 == 0 ? -6.0 : 6.0), begin + s * (end - begin));
    }
    points.emplace_back(last, end);
    svg_.path(points, kSpring, 1.5);
    if (!spring.b) svg_.line(place - 10.0, end, place + 10.0, end, kSpring, 2.5);
    if (layout_.springs.size() <= 12)
      svg_.text(place + (spring.b ? 10.0 : 10.0 * side), begin + 0.6 * (end - begin),
                to_short_text(spring.stiffness) + " N/m" + (spring.along_z ? " (z)" : ""),
                spring.b || spring.along_z ? "start" : "end", 10.0, kSpring);
  }

  void draw(const MassMark& mass) {
    svg_.circle(x(mass.at.x), y(mass.at.row), 8.0, kBeam);
    svg_.text(x(mass.at.x) + 14.0, y(mass.at.row) + 14.0, to_short_text(mass.mass) + " kg", "start", 11.0);
  }

  void draw(const LoadMark& load) {
    const std::size_t stride = load.at.size() / 40 + 1;
    const double length = load.at.size() == 1 ? 54.0 : 16.0;
    for (std::size_t i = 0; i < load.at.size(); i += stride) {
      const double place = x(load.at[i].x) + (load.aside ? 12.0 : 0.0), tip = y(load.at[i].row) - 5.0;
      if (load.moment) {
        svg_.path({{place - 10.0, tip}, {place - 7.0, tip - 9.0}, {place + 7.0, tip - 9.0}, {place + 10.0, tip}}, kLoad,
                  2.0);
        continue;
      }
      // Arrowheads at both ends of a load that changes its sign.
      svg_.line(place, tip - length + 4.0, place, tip - 4.0, kLoad, 2.0);
      if (load.sign <= 0) svg_.polygon({{place, tip}, {place - 4.5, tip - 8.0}, {place + 4.5, tip - 8.0}}, kLoad);
      if (load.sign >= 0)
        svg_.polygon({{place, tip - length}, {place - 4.5, tip - length + 8.0}, {place + 4.5, tip - length + 8.0}},
                     kLoad);
    }
    const Place& first = load.at[load.at.size() / 2];
    const int before = labels_[first.row]++;
    svg_.text(x(first.x) + (load.aside ? 20.0 : 8.0), y(first.row) - 58.0 - 13.0 * (before % 3), load.label, "start",
              12.0, kLoad);
  }

  void draw_legend() {
    double line = kTop + kRowHeight * layout_.rows + 12.0;
    for (std::size_t i = 0; i < layout_.stop_labels.size(); ++i, line += 18.0) {
      svg_.polygon({{26.0, line - 9.0}, {21.0, line}, {31.0, line}}, kStops[i % kStops.size()]);
      svg_.text(40.0, line, "stops: " + layout_.stop_labels[i]);
    }
    if (layout_.stops.empty() || !(widest_gap_ > 0.0)) return;
    svg_.text(40.0, line, "gaps are not to scale", "start", 11.0, "#777777");
  }

  const Layout& layout_;
  Svg svg_;
  double widest_gap_ = 0.0;
  std::map<int, int> labels_;  ///< number of load labels in each row
};

}  // namespace

std::string picture_svg(const Layout& layout) {
  return Drawing(layout).draw();
}

}  // namespace butee::app::check
