#include "pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <butee/core/error.hpp>

#include "drawing.hpp"
#include "motion.hpp"
#include "orbits.hpp"
#include "spectrum.hpp"

namespace butee::app::plot {
namespace {

/// A probe's quantity over time, with the gaps of its stops as lines.
std::vector<Chart> with_gaps(const Drawing& drawing, const std::string& name, const std::string& quantity,
                             const std::string& y_name, const std::string& y_unit, bool gaps) {
  return grouped(drawing, name, false, [&](const Item& item, std::size_t place, Chart& chart) {
    const auto* values = item.result->column(item.label, quantity);
    if (values == nullptr || values->empty()) return false;
    chart.x_name = "time";
    chart.x_unit = "s";
    chart.y_name = axis_name(drawing, item, y_name);
    chart.y_unit = y_unit;
    chart.curves.push_back({curve_name(drawing, item), item.result->history.times(), *values, place});
    if (!gaps) return true;
    for (const Mark& mark : gap_marks(item)) {
      const auto same = [&](const Mark& other) { return other.at == mark.at; };
      if (std::none_of(chart.levels.begin(), chart.levels.end(), same)) chart.levels.push_back(mark);
    }
    return true;
  });
}

Curve path(const std::string& title, const std::vector<Motion::Point>& points, std::size_t colour) {
  Curve curve{title, {}, {}, colour};
  curve.path = true;
  for (const Motion::Point& point : points) {
    curve.x.push_back(point.u);
    curve.y.push_back(point.v);
  }
  return curve;
}

}  // namespace

std::vector<Chart> over_time(const Drawing& drawing, const std::string& name, const std::string& quantity,
                             const std::string& y_name, const std::string& y_unit) {
  return with_gaps(drawing, name, quantity, y_name, y_unit, false);
}

std::vector<Chart> of_motion(const Drawing& drawing) {
  auto charts = with_gaps(drawing, "displacement", "u", "displacement", "m", true);
  for (const char* other : {"uz", "ux"})
    if (charts.empty()) charts = over_time(drawing, "displacement", other, std::string("displacement ") + other, "m");
  for (const char* rotation : {"theta", "ry", "rx"})
    if (charts.empty()) charts = over_time(drawing, "rotation", rotation, std::string("rotation ") + rotation, "rad");
  return charts;
}

std::vector<Chart> of_steps(const Drawing& drawing) {
  Chart chart;
  chart.name = "step";
  chart.title = title_of(drawing.results);
  chart.x_name = "time";
  chart.x_unit = "s";
  chart.y_name = "step";
  chart.y_unit = "s";
  double least = INFINITY, most = 0.0;
  for (const Result& result : drawing.results) {
    const auto* steps = result.history.find("h");
    if (steps == nullptr || steps->empty()) continue;
    Curve curve{drawing.several() ? result.label : "step size", {}, {}, chart.curves.size()};
    for (std::size_t i = 0; i < steps->size(); ++i) {
      if (!((*steps)[i] > 0.0)) continue;
      curve.x.push_back(result.history.times()[i]);
      curve.y.push_back((*steps)[i]);
      // The last step is shortened to end at the end of the run, and is not representative.
      if (i + 1 < steps->size()) least = std::min(least, curve.y.back());
      most = std::max(most, curve.y.back());
    }
    if (!curve.x.empty()) chart.curves.push_back(std::move(curve));
  }
  if (chart.curves.empty()) return {};
  constexpr double kWide = 5.0;
  chart.log_y = std::isfinite(least) && most > kWide * least;
  if (chart.log_y) chart.y_begin = 0.7 * least;
  chart.from_zero = !chart.log_y;
  return {chart};
}

std::vector<Chart> of_energy(const Drawing& drawing) {
  Chart chart;
  chart.name = "energy";
  chart.title = title_of(drawing.results);
  chart.x_name = "time";
  chart.x_unit = "s";
  chart.y_name = "energy";
  chart.y_unit = "J";
  if (drawing.several()) chart.y_name = "total energy";
  for (const Result& result : drawing.results) {
    if (!result.energy || result.energy->rows() == 0) continue;
    const Table& table = *result.energy;
    std::vector<double> total(table.rows(), 0.0);
    for (const char* name : {"kinetic", "strain", "contact"}) {
      const auto* part = table.find(name);
      if (part == nullptr) return {};
      for (std::size_t i = 0; i < total.size(); ++i) total[i] += (*part)[i];
      if (!drawing.several()) chart.curves.push_back({name, table.times(), *part, chart.curves.size()});
    }
    if (drawing.several()) {
      chart.curves.push_back({result.label, table.times(), total, chart.curves.size()});
      continue;
    }
    chart.curves.push_back({.title = "total", .x = table.times(), .y = total, .colour = 8, .wide = true});
    const auto *work = table.find("work"), *dissipated = table.find("dissipated");
    if (work == nullptr || dissipated == nullptr || largest_of(*work) + largest_of(*dissipated) == 0.0) continue;
    std::vector<double> balance = total;
    for (std::size_t i = 0; i < balance.size(); ++i)
      balance[i] = total.front() + ((*work)[i] - work->front()) - ((*dissipated)[i] - dissipated->front());
    chart.curves.push_back({.title = "work - dissipated", .x = table.times(), .y = balance, .colour = 4});
  }
  if (chart.curves.empty()) return {};
  return {chart};
}

std::vector<Chart> of_phase(const Drawing& drawing) {
  return grouped(drawing, "phase", true, [&](const Item& item, std::size_t place, Chart& chart) {
    const auto *u = item.result->column(item.label, "u"), *v = item.result->column(item.label, "v");
    if (u == nullptr || v == nullptr || u->empty()) return false;
    chart.x_name = axis_name(drawing, item, "displacement");
    chart.x_unit = "m";
    chart.y_name = "velocity";
    chart.y_unit = "m/s";
    const Motion motion(item.result->history.times(), *u, *v, item.result->column(item.label, "a"));
    chart.curves.push_back(path(curve_name(drawing, item), motion.smooth(), place));
    const double u_largest = largest_of(*u);
    for (const Mark& mark : gap_marks(item))
      if (std::abs(mark.at) < 2.0 * u_largest && place == 0) chart.uprights.push_back(mark);
    if (!drawing.several() && item.result->frequencies.size() == 1) {
      Curve points = path("once per load period", motion.once_per(1.0 / item.result->frequencies.front()), place);
      points.points = true;
      if (points.x.size() > 2) chart.curves.push_back(std::move(points));
    }
    return true;
  });
}

std::vector<Chart> of_spectrum(const Drawing& drawing) {
  constexpr double kDepth = 1e-9, kVisible = 3e-4;  // of the largest amplitude: end of the axis, least visible
  constexpr double kPeriods = 4.0;                  // the axis shows at least this multiple of the load's frequency
  auto charts = grouped(drawing, "spectrum", false, [&](const Item& item, std::size_t place, Chart& chart) {
    const auto* u = item.result->column(item.label, "u");
    if (u == nullptr) return false;
    const Spectrum spectrum = amplitude_spectrum(item.result->history.times(), *u);
    const double largest = largest_of(spectrum.amplitudes);
    if (largest == 0.0) return false;
    chart.x_name = "frequency";
    chart.x_unit = "Hz";
    chart.y_name = axis_name(drawing, item, "amplitude of the displacement");
    chart.y_unit = "m";
    chart.log_y = true;
    double limit = 0.0;
    for (const double f : item.result->frequencies) limit = std::max(limit, kPeriods * f);
    for (std::size_t i = 0; i < spectrum.frequencies.size(); ++i)
      if (spectrum.amplitudes[i] > kVisible * largest) limit = std::max(limit, spectrum.frequencies[i]);
    limit = std::min(limit, spectrum.frequencies.back());
    double lowest = largest;
    for (std::size_t i = 0; i < spectrum.frequencies.size() && spectrum.frequencies[i] <= limit; ++i)
      lowest = std::min(lowest, spectrum.amplitudes[i]);
    chart.x_begin = 0.0;
    chart.x_end = std::max(chart.x_end.value_or(0.0), limit);
    chart.y_begin = std::min(chart.y_begin.value_or(largest), std::max(lowest, kDepth * largest));
    chart.curves.push_back({curve_name(drawing, item), spectrum.frequencies, spectrum.amplitudes, place});
    return true;
  });
  for (Chart& chart : charts) chart.uprights = frequency_marks(drawing.results, *chart.x_end);
  return charts;
}

}  // namespace butee::app::plot
