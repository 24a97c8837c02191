#include "orbits.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spectrum.hpp"

namespace butee::app::plot {
namespace {

const std::vector<double>* along_y(const Item& item) {
  return item.result->column(item.label, "u");
}
const std::vector<double>* along_z(const Item& item) {
  return item.result->column(item.label, "uz");
}

constexpr int kCircle = 180;  ///< points of a drawn ring

/// Adds the edges of rings and planes; edges far beyond the orbit appear only in the legend.
void add_walls(const Item& item, double largest, Chart& chart) {
  constexpr double kFar = 4.0;
  for (const Probe& probe : item.result->probes) {
    if (probe.label != item.label) continue;
    for (const double gap : probe.gaps_z) chart.levels.push_back({gap, "gap of uz " + length_text(gap)});
    for (const double gap : probe.gaps) chart.uprights.push_back({gap, "gap of uy " + length_text(gap)});
    for (const Wall& wall : probe.walls) {
      const std::string title = (wall.is_circle ? "ring " : "plane at ") + length_text(wall.distance);
      if (std::abs(wall.distance) > kFar * largest) {
        chart.levels.push_back({2.0 * kFar * wall.distance, title});
        continue;
      }
      Curve edge{title, {}, {}, 0};
      edge.path = edge.dashed = true;
      for (int i = 0; i <= (wall.is_circle ? kCircle : 1); ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kCircle, along = (2.0 * i - 1.0) * largest;
        edge.x.push_back(wall.is_circle ? wall.y + wall.distance * std::cos(angle)
                                        : wall.distance * wall.y - along * wall.z);
        edge.y.push_back(wall.is_circle ? wall.z + wall.distance * std::sin(angle)
                                        : wall.distance * wall.z + along * wall.y);
      }
      chart.curves.push_back(std::move(edge));
    }
  }
}

}  // namespace

std::vector<Chart> of_orbit(const Drawing& drawing) {
  return grouped(drawing, "orbit", true, [&](const Item& item, std::size_t place, Chart& chart) {
    const auto *y = along_y(item), *z = along_z(item);
    if (y == nullptr || z == nullptr || y->size() < 2) return false;
    chart.x_name = axis_name(drawing, item, "uy");
    chart.y_name = "uz";
    chart.x_unit = chart.y_unit = "m";
    chart.in_plane = true;
    Curve curve{curve_name(drawing, item), *y, *z, place};
    curve.path = true;
    chart.curves.push_back(std::move(curve));
    if (place == 0) add_walls(item, std::max(largest_of(*y), largest_of(*z)), chart);
    return true;
  });
}

std::vector<Chart> of_run_up(const Drawing& drawing) {
  return grouped(drawing, "run-up", false, [&](const Item& item, std::size_t place, Chart& chart) {
    const auto *y = along_y(item), *z = along_z(item);
    const auto& speeds = item.result->speeds;
    if (speeds.empty() || (y == nullptr && z == nullptr)) return false;
    Curve curve{curve_name(drawing, item), speeds, {}, place};
    curve.path = true;
    for (std::size_t i = 0; i < speeds.size(); ++i)
      curve.y.push_back(std::hypot(y != nullptr ? (*y)[i] : 0.0, z != nullptr ? (*z)[i] : 0.0));
    chart.x_name = "speed of rotation";
    chart.x_unit = "rad/s";
    chart.y_name = axis_name(drawing, item, y != nullptr && z != nullptr ? "radius of the orbit" : "displacement");
    chart.y_unit = "m";
    chart.curves.push_back(std::move(curve));
    return true;
  });
}

std::vector<Chart> of_full_spectrum(const Drawing& drawing) {
  constexpr double kDepth = 1e-6, kVisible = 1e-3;  // of the largest amplitude: end of the axis, least visible
  auto charts = grouped(drawing, "full-spectrum", false, [&](const Item& item, std::size_t place, Chart& chart) {
    const auto *y = along_y(item), *z = along_z(item);
    if (y == nullptr || z == nullptr) return false;
    const Spectrum spectrum = full_spectrum(item.result->history.times(), *y, *z);
    const double largest = largest_of(spectrum.amplitudes);
    if (largest == 0.0) return false;
    chart.x_name = "frequency, backward whirl below zero";
    chart.x_unit = "Hz";
    chart.y_name = axis_name(drawing, item, "amplitude of uy + i uz");
    chart.y_unit = "m";
    chart.log_y = true;
    double limit = chart.x_end.value_or(0.0);
    for (std::size_t i = 0; i < spectrum.frequencies.size(); ++i)
      if (spectrum.amplitudes[i] > kVisible * largest) limit = std::max(limit, 1.1 * std::abs(spectrum.frequencies[i]));
    limit = std::min(limit, spectrum.frequencies.back());
    chart.x_begin = -limit;
    chart.x_end = limit;
    chart.y_begin = std::min(chart.y_begin.value_or(largest), kDepth * largest);
    chart.curves.push_back({curve_name(drawing, item), spectrum.frequencies, spectrum.amplitudes, place});
    return true;
  });
  return charts;
}

}  // namespace butee::app::plot
