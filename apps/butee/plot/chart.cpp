#include "chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <butee/core/text.hpp>

#include "../gnuplot.hpp"
#include "thin.hpp"

namespace butee::app::plot {
namespace {

/// Characters that fit beside the picture.
constexpr std::size_t kLabelWidth = 50;
/// Levels above this multiple of the largest value are left out of the picture; they would flatten the
/// curves.
constexpr double kFarAway = 4.0;
/// Orbits flatter than this are drawn with different scales on their axes.
constexpr double kThin = 0.2;
constexpr const char* kMarkStyle = "dt 2 lw 1 lc rgb '#555555'";

constexpr double kMargin = 0.05;      ///< margin of an axis beyond its data, as a fraction of their range
constexpr double kSmallest = 1e-300;  ///< smallest length of an axis
/// Values that differ by less than this part of the largest count as constant; numbers have seven digits.
constexpr double kConstant = 1e-6;

std::string number(double value) {
  return short_number(value, 7);
}

struct Extent {
  double least = std::numeric_limits<double>::infinity(), most = -least;
  void take(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  double largest() const { return most < least ? 0.0 : std::max(std::abs(least), std::abs(most)); }
  /// The range of an axis: the given ends, otherwise the extent of the data plus a margin, which is a
  /// fraction of that extent.
  std::string range(std::optional<double> begin, std::optional<double> end, double margin, const Scale& scale) const {
    if (most < least) return "[*:*]";
    const double room = most - least > (margin > 0.0 ? kConstant * largest() : 0.0)
                            ? margin * (most - least)
                            : 0.5 * std::max(largest(), kSmallest);
    return "[" + number(begin.value_or(least - room) * scale.factor) + ":" +
           number(end.value_or(most + room) * scale.factor) + "]";
  }
};

std::string pen_of(const Curve& curve) {
  if (curve.points) return " with points pt 7 ps 0.6 lc rgb '#222222'";
  if (curve.dashed) return " with lines dt 2 lw 2 lc rgb '#222222'";
  const std::string colour = gnuplot::kColours[curve.colour % gnuplot::kColours.size()];
  return " with lines lw " + (curve.wide ? std::string("4.5") : std::string("1.3")) + " lc rgb '" + colour + "'";
}

/// One block of data for each curve.
std::string data_of(const std::vector<Curve>& curves, const Scale& x, const Scale& y) {
  std::string data;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Curve& curve = curves[i];
    const auto kept = curve.points ? every(curve.x.size()) : curve.path ? thin_path(curve.x, curve.y) : thin(curve.y);
    data += "# " + printable(curve.title) + "\n$curve" + std::to_string(i) + " << EOD\n";
    for (const std::size_t k : kept) data += number(curve.x[k] * x.factor) + " " + number(curve.y[k] * y.factor) + "\n";
    data += "EOD\n";
  }
  return data;
}

}  // namespace

std::string folded_title(std::string title, std::size_t width) {
  std::replace(title.begin(), title.end(), '"', '\'');
  std::replace(title.begin(), title.end(), '\\', '/');
  std::replace(title.begin(), title.end(), '`',
               '\'');  // gnuplot runs text between backquotes as a command, even within double quotes.
  std::replace_if(
      title.begin(), title.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  if (title.size() <= width) return title;
  std::size_t best = std::string::npos;
  for (std::size_t i = title.find(' '); i != std::string::npos && i <= width; i = title.find(' ', i + 1))
    if (best == std::string::npos || title[i - 1] == ',' || title[best - 1] != ',') best = i;
  if (best == std::string::npos) return title.substr(0, width);
  std::string rest = title.substr(best + 1);
  if (rest.size() > width) rest = rest.substr(0, rest.rfind(' ', width)) + " ...";
  return title.substr(0, best) + "\\n" + rest;
}

std::string Picture::script(const std::vector<std::string>& formats) const {
  return "# Made by butee plot. Change what you like and draw it again: gnuplot " + name + ".gp\n" + data + "\n" +
         gnuplot::style() + set + "\n" + gnuplot::draw_into(formats, name, plot);
}

Picture Chart::picture() const {
  Extent x, y;
  for (const Curve& curve : curves) {
    for (const double value : curve.x) x.take(value);
    for (const double value : curve.y) y.take(value);
  }
  const double y_largest = y.largest();
  const auto is_near = [&](const Mark& level) {
    return y_largest == 0.0 || std::abs(level.at) <= kFarAway * y_largest;
  };
  for (const Mark& level : levels)
    if (is_near(level)) y.take(level.at);
  const double x_size = x_end ? *x_end : x.largest(), y_size = y.largest(), both = std::max(x_size, y_size);
  const Scale x_scale = scale_for(in_plane ? both : x_size, x_unit),
              y_scale = scale_for(in_plane ? both : y_size, y_unit);

  Picture picture;
  picture.name = name;
  picture.data = data_of(curves, x_scale, y_scale);
  std::string& set = picture.set;
  set += "set xlabel " + gnuplot::quoted(x_scale.axis(x_name)) + " noenhanced\n";
  const std::string label = y_scale.axis(y_name);
  set += "set ylabel " +
         (label.size() > kLabelWidth ? "\"" + folded_title(label, kLabelWidth) + "\"" : gnuplot::quoted(label)) +
         " noenhanced\n";
  set += "set title \"" + folded_title(title) + "\" noenhanced\n";
  if (in_plane && std::min(x_size, y_size) > kThin * both) set += "set size ratio -1\n";
  const bool path = !curves.empty() && curves.front().path;
  set += "set xrange " + x.range(x_begin, x_end, path ? kMargin : 0.0, x_scale) + "\n";
  if (log_y)
    set += "set logscale y\nset format y '10^{%L}'\nset yrange [" +
           (y_begin ? number(*y_begin * y_scale.factor) : "*") + ":*]\n";
  else if (from_zero)
    set += "set yrange [0:" + number(1.25 * std::max(y.most, 0.0) * y_scale.factor) + "]\n";
  else
    set += "set yrange " + y.range(y_begin, std::nullopt, kMargin, y_scale) + "\n";

  std::vector<std::string> parts, entries;
  const auto entry = [&entries](const std::string& text) {
    if (text.empty()) return std::string(" notitle");
    entries.push_back(text);
    return " title " + gnuplot::quoted(text);
  };
  for (const Mark& level : levels) {
    const bool drawn = is_near(level);
    if (!drawn && level.title.empty()) continue;
    parts.push_back((drawn ? number(level.at * y_scale.factor) : "NaN") + " with lines " + kMarkStyle +
                    entry(level.title + (drawn ? "" : " (out of sight)")));
  }
  for (std::size_t i = 0; i < uprights.size(); ++i) {
    const std::string at = number(uprights[i].at * x_scale.factor);
    set += "set arrow " + std::to_string(i + 1) + " from first " + at + ", graph 0 to first " + at +
           ", graph 1 nohead back " + kMarkStyle + "\n";
    if (!uprights[i].title.empty())
      parts.push_back(std::string("NaN with lines ") + kMarkStyle + entry(uprights[i].title));
  }
  for (std::size_t i = 0; i < curves.size(); ++i)
    parts.push_back("$curve" + std::to_string(i) + pen_of(curves[i]) + entry(curves[i].title));
  set += gnuplot::legend_below(entries);
  picture.plot = "plot ";
  for (std::size_t i = 0; i < parts.size(); ++i) picture.plot += (i > 0 ? ", \\\n     " : "") + parts[i];
  return picture;
}

}  // namespace butee::app::plot
