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

constexpr std::array<const char*, 18> kNames = {
    "displacement", "force",  "step",     "energy", "phase",  "spectrum",      "shape",       "moment", "shear",
    "stress",       "spring", "reaction", "orbit",  "run-up", "full-spectrum", "contact-map", "wear",   "frame"};

std::vector<Chart> over_time(const Drawing& drawing, const std::string& name, const std::string& quantity,
                             const std::string& y_name, const std::string& y_unit, bool with_gaps) {
  return grouped(drawing, name, false, [&](const Item& item, std::size_t place, Chart& chart) {
    const auto* values = item.result->column(item.label, quantity);
    if (values == nullptr || values->empty()) return false;
    chart.x_name = "time";
    chart.x_unit = "s";
    chart.y_name = axis_name(drawing, item, y_name);
    chart.y_unit = y_unit;
    chart.curves.push_back({curve_name(drawing, item), item.result->history.times(), *values, place});
    if (!with_gaps) return true;
    for (const Mark& mark : gap_marks(item)) {
      const auto same = [&](const Mark& other) { return other.at == mark.at; };
      if (std::none_of(chart.levels.begin(), chart.levels.end(), same)) chart.levels.push_back(mark);
    }
    return true;
  });
}

/// The displacements u; where no probe has one, those along the other axes or the rotations.
std::vector<Chart> of_motion(const Drawing& drawing) {
  auto charts = over_time(drawing, "displacement", "u", "displacement", "m", true);
  for (const char* other : {"uz", "ux"})
    if (charts.empty())
      charts = over_time(drawing, "displacement", other, std::string("displacement ") + other, "m", false);
  for (const char* rotation : {"theta", "ry", "rx"})
    if (charts.empty())
      charts = over_time(drawing, "rotation", rotation, std::string("rotation ") + rotation, "rad", false);
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

Curve path(const std::string& title, const std::vector<Motion::Point>& points, std::size_t colour) {
  Curve curve{title, {}, {}, colour};
  curve.path = true;
  for (const Motion::Point& point : points) {
    curve.x.push_back(point.u);
    curve.y.push_back(point.v);
  }
  return curve;
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

std::vector<Chart> charts(Kind kind, const Drawing& drawing) {
  switch (kind) {
    case Kind::displacement:
      return of_motion(drawing);
    case Kind::force:
      return over_time(drawing, "force", "contact_force", "contact force", "N", false);
    case Kind::step:
      return of_steps(drawing);
    case Kind::energy:
      return of_energy(drawing);
    case Kind::phase:
      return of_phase(drawing);
    case Kind::spectrum:
      return of_spectrum(drawing);
    case Kind::moment:
      return over_time(drawing, "moment", "M", "bending moment", "N m", false);
    case Kind::shear:
      return over_time(drawing, "shear", "V", "shear force", "N", false);
    case Kind::stress:
      return over_time(drawing, "stress", "bending_stress", "bending stress", "Pa", false);
    case Kind::spring:
      return over_time(drawing, "spring", "spring_force", "spring force", "N", false);
    case Kind::reaction:
      return over_time(drawing, "reaction", "reaction", "reaction", "N", false);
    case Kind::orbit:
      return of_orbit(drawing);
    case Kind::run_up:
      return of_run_up(drawing);
    case Kind::full_spectrum:
      return of_full_spectrum(drawing);
    case Kind::contact_map:
    case Kind::wear:
    case Kind::shape:
    case Kind::frame:
      break;
  }
  return {};
}

}  // namespace

std::vector<std::string> kind_names() {
  return {kNames.begin(), kNames.end()};
}

Kind kind_of(const std::string& name) {
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  require(found != kNames.end(), "no such kind of picture");
  return static_cast<Kind>(found - kNames.begin());
}

std::vector<Picture> pictures(Kind kind, const std::vector<Result>& results, const std::vector<std::string>& labels) {
  Drawing drawing{results, labels};
  if (labels.empty())
    for (const Result& result : results)
      for (const Probe& probe : result.probes)
        if (std::find(drawing.labels.begin(), drawing.labels.end(), probe.label) == drawing.labels.end())
          drawing.labels.push_back(probe.label);
  std::vector<Picture> all;
  for (const Chart& chart : charts(kind, drawing)) all.push_back(chart.picture());
  return all;
}

std::string requirement_of(Kind kind) {
  switch (kind) {
    case Kind::displacement:
      return "a probe of a displacement or rotation: [[output.probe]] with quantities = [\"u\"]";
    case Kind::spectrum:
      return "a probe of u: [[output.probe]] with quantities = [\"u\"]";
    case Kind::force:
      return "a probe of contact_force: [[output.probe]] with quantities = [\"u\", \"contact_force\"]";
    case Kind::phase:
      return "a probe of u and v: [[output.probe]] with quantities = [\"u\", \"v\"]";
    case Kind::energy:
      return "energies: run again with --set output.energy=true";
    case Kind::shape:
      return "the displacements of all nodes: run again with --set 'output.formats=[\"csv\", \"hdf5\"]'";
    case Kind::moment:
      return "a probe of M: [[output.probe]] with quantities = [\"M\"]";
    case Kind::shear:
      return "a probe of V: [[output.probe]] with quantities = [\"V\"]";
    case Kind::stress:
      return "a probe of bending_stress: [[output.probe]] with quantities = [\"bending_stress\"]";
    case Kind::spring:
      return "a probe of spring_force: [[output.probe]] with quantities = [\"spring_force\"]";
    case Kind::reaction:
      return "a probe of reaction: [[output.probe]] with quantities = [\"reaction\"]";
    case Kind::orbit:
    case Kind::full_spectrum:
      return "a probe of uy and uz: [[output.probe]] with quantities = [\"uy\", \"uz\"]";
    case Kind::run_up:
      return "a speed of [rotation] that varies and a probe of uy and uz: [[output.probe]] with quantities = [\"uy\", "
             "\"uz\"]";
    case Kind::contact_map:
      return "closings of contacts: run again with --set output.impacts=true";
    case Kind::wear:
      return "wear: contacts in the plane, with dissipation or friction, that touch; run again with --set "
             "output.impacts=true";
    case Kind::frame:
      return "beams in space and the displacements of all nodes: run again with --set 'output.formats=[\"csv\", "
             "\"hdf5\"]'";
    case Kind::step:
      break;
  }
  return "rows in history.csv";
}

}  // namespace butee::app::plot
