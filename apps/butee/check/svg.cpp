#include "svg.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace butee::app::check {
namespace {

std::string number(double value) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.4g", value);
  return buffer.data();
}

std::string attribute(const char* name, const std::string& value) {
  return " " + std::string(name) + "=\"" + value + "\"";
}
std::string attribute(const char* name, double value) {
  return attribute(name, number(value));
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (static_cast<unsigned char>(c) >= 0x20)
      out += c;
  }
  return out;
}

std::string list_of(const std::vector<std::pair<double, double>>& points) {
  std::string list;
  for (const auto& [x, y] : points) list += (list.empty() ? "" : " ") + number(x) + "," + number(y);
  return list;
}

}  // namespace

Svg::Svg(double width, double height)
    : width_(width),
      shapes_("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\"" +
              attribute("width", width) + attribute("height", height) +
              attribute("viewBox", "0 0 " + number(width) + " " + number(height)) +
              " font-family=\"sans-serif\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n") {}

void Svg::line(double x1, double y1, double x2, double y2, const std::string& colour, double width) {
  shapes_ += "<line" + attribute("x1", x1) + attribute("y1", y1) + attribute("x2", x2) + attribute("y2", y2) +
             attribute("stroke", colour) + attribute("stroke-width", width) + "/>\n";
}

void Svg::path(const std::vector<std::pair<double, double>>& points, const std::string& colour, double width) {
  shapes_ += "<polyline" + attribute("points", list_of(points)) + " fill=\"none\"" + attribute("stroke", colour) +
             attribute("stroke-width", width) + "/>\n";
}

void Svg::polygon(const std::vector<std::pair<double, double>>& points, const std::string& fill) {
  shapes_ += "<polygon" + attribute("points", list_of(points)) + attribute("fill", fill) + "/>\n";
}

void Svg::circle(double x, double y, double radius, const std::string& fill) {
  shapes_ +=
      "<circle" + attribute("cx", x) + attribute("cy", y) + attribute("r", radius) + attribute("fill", fill) + "/>\n";
}

void Svg::text(double x, double y, const std::string& text, const std::string& anchor, double size,
               const std::string& colour) {
  // The width of a character of wide sans-serif fonts, over the font size.
  constexpr double kCharacter = 0.65, kMargin = 4.0;
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; });
  const double length = kCharacter * size * static_cast<double>(characters),
               left = x - (anchor == "start"    ? 0.0
                           : anchor == "middle" ? 0.5 * length
                                                : length),
               most_left = std::max(kMargin, width_ - kMargin - length);
  x += std::clamp(left, kMargin, most_left) - left;
  labels_ += "<text" + attribute("x", x) + attribute("y", y) + attribute("text-anchor", anchor) +
             attribute("font-size", size) + attribute("fill", colour) +
             " stroke=\"white\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\">" + escaped(text) +
             "</text>\n";
}

}  // namespace butee::app::check
