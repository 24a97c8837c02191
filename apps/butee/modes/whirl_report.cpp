#include "whirl_report.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include <butee/core/format.hpp>
#include <butee/core/text.hpp>

#include "../gnuplot.hpp"
#include "../plot/chart.hpp"

namespace butee::app::modes {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
/// Orbits with a smaller axis ratio are called planar.
constexpr double kPlanar = 1e-6;

/// The sign of forward whirl at a speed; 0 if modes of both senses are alike, so that forward whirl is
/// undefined.
double sense_at(const dynamics::Whirl& whirl, double speed) {
  if (speed != 0.0) return speed;
  return whirl.system().stiffness_is_symmetric ? 0.0 : 1.0;
}

const char* sense_of(double direction, dynamics::ModeMotion motion, double speed) {
  if (motion == dynamics::ModeMotion::torsional) return "torsional";
  if (motion == dynamics::ModeMotion::axial) return "axial";
  if (std::abs(direction) < kPlanar || speed == 0.0) return "planar";
  return direction * speed > 0.0 ? "forward" : "backward";
}

const char* sense_of(const dynamics::WhirlMode& mode, double speed) {
  if (mode.frequency() == 0.0) return "no oscillation";
  return mode.is_mixed ? "mixed" : sense_of(mode.direction, mode.motion, speed);
}

std::string rpm(double speed) {
  return formatted("%.6f", speed * 60.0 / kTwoPi);
}

Json to_json(const dynamics::WhirlMode& mode, double speed) {
  Json row;
  row["angular_frequency"] = mode.frequency();
  row["frequency"] = mode.frequency() / kTwoPi;
  row["damping"] = mode.damping_ratio();
  row["logarithmic_decrement"] = mode.frequency() > 0.0 ? Json(mode.logarithmic_decrement()) : Json();
  row["growth"] = mode.lambda.real();
  row["direction"] = mode.direction;
  row["whirl"] = sense_of(mode, speed);
  return row;
}

}  // namespace

WhirlAnalysis whirl_at(const dynamics::Whirl& whirl, const std::string& title, double speed, Index count) {
  return {title, whirl.size(), speed, sense_at(whirl, speed), whirl.modes(speed, count)};
}

Campbell campbell(const dynamics::Whirl& whirl, const std::string& title, double from, double to, Index steps,
                  double order, Index count) {
  Campbell diagram{title, order, {}, {}, {}, {}, {}, false, 0};
  // Damping that turns with the shaft lets modes grow whose frequency is below the speed.
  const Index examined =
      whirl.is_dense() ? count
                       : whirl.count_to(std::max(order, 1.0) * std::max(std::abs(from), std::abs(to)), from, to, count);
  if (!whirl.is_dense()) diagram.examined = examined;
  std::vector<dynamics::ModesAtSpeed> grid;
  for (Index i = 0; i <= steps; ++i) {
    diagram.speeds.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(steps));
    diagram.senses.push_back(sense_at(whirl, diagram.speeds.back()));
    grid.push_back(whirl.modes_at(diagram.speeds.back(), examined));
  }
  diagram.critical = whirl.critical_speeds(from, to, steps, order, examined);
  diagram.borders = whirl.stability_borders(grid, examined);
  const auto& first = grid.front().eigenvalues;
  diagram.grows_at_first = std::any_of(first.begin(), first.end(), [&](auto lambda) { return whirl.grows(lambda); });
  for (dynamics::ModesAtSpeed& at : grid) {
    dynamics::keep_lowest(at.lowest, count);
    diagram.modes.push_back(std::move(at.lowest));
  }
  return diagram;
}

void print(const WhirlAnalysis& analysis) {
  if (!analysis.title.empty()) std::printf("%s\n", printable(analysis.title).c_str());
  std::printf("  %td free DOFs, at %s rad/s (%s rev/min)\n\n", analysis.dofs, to_short_text(analysis.speed).c_str(),
              rpm(analysis.speed).c_str());
  std::printf("  mode         rad/s            Hz     damping   log. decrement  whirl\n");
  for (std::size_t i = 0; i < analysis.modes.size(); ++i) {
    const dynamics::WhirlMode& mode = analysis.modes[i];
    const bool oscillates = mode.frequency() > 0.0;
    std::printf("  %4zu  %12s  %12s  %10.4g  %15s  %s%s\n", i + 1, formatted("%.9g", mode.frequency()).c_str(),
                formatted("%.9g", mode.frequency() / kTwoPi).c_str(), mode.damping_ratio(),
                oscillates ? formatted("%.4g", mode.logarithmic_decrement()).c_str() : "-",
                sense_of(mode, analysis.sense), mode.lambda.real() > 1e-9 * std::abs(mode.lambda) ? ", unstable" : "");
  }
}

void print(const Campbell& diagram) {
  if (!diagram.title.empty()) std::printf("%s\n", printable(diagram.title).c_str());
  const std::string among = diagram.examined > 0 ? " (the " + std::to_string(diagram.examined) + " lowest modes)" : "";
  std::printf("  critical speeds of order %s between %s and %s rad/s%s\n\n", to_short_text(diagram.order).c_str(),
              to_short_text(diagram.speeds.front()).c_str(), to_short_text(diagram.speeds.back()).c_str(),
              among.c_str());
  if (diagram.critical.empty()) std::printf("  none\n");
  for (const dynamics::CriticalSpeed& critical : diagram.critical)
    std::printf("  %14s rad/s  %16s rev/min  %s\n", formatted("%.10g", critical.speed).c_str(),
                rpm(critical.speed).c_str(), sense_of(critical.direction, critical.motion, critical.speed));
  std::printf("\n  stability without contact%s\n\n", among.c_str());
  if (diagram.grows_at_first && !diagram.borders.empty())
    std::printf("  unstable at %s rad/s\n", to_short_text(diagram.speeds.front()).c_str());
  for (const dynamics::StabilityBorder& border : diagram.borders)
    std::printf("  %14s rad/s  %16s rev/min  a mode of %s rad/s (%s) %s\n", formatted("%.8g", border.speed).c_str(),
                rpm(border.speed).c_str(), to_short_text(border.mode.frequency()).c_str(),
                sense_of(border.mode, border.speed), border.begins ? "begins to grow" : "ceases to grow");
  if (diagram.borders.empty())
    std::printf("  %s at all these speeds\n", diagram.grows_at_first ? "unstable" : "stable");
}

Json to_json(const WhirlAnalysis& analysis) {
  Json json;
  json["title"] = analysis.title;
  json["dofs"] = analysis.dofs;
  json["speed"] = analysis.speed;
  json["modes"] = Json::array();
  for (const dynamics::WhirlMode& mode : analysis.modes) json["modes"].push_back(to_json(mode, analysis.sense));
  return json;
}

Json to_json(const Campbell& diagram) {
  Json json;
  json["title"] = diagram.title;
  json["order"] = diagram.order;
  if (diagram.examined > 0) json["examined_modes"] = diagram.examined;
  json["critical_speeds"] = Json::array();
  for (const dynamics::CriticalSpeed& critical : diagram.critical)
    json["critical_speeds"].push_back({{"speed", critical.speed},
                                       {"direction", critical.direction},
                                       {"whirl", sense_of(critical.direction, critical.motion, critical.speed)}});
  json["stability_borders"] = Json::array();
  for (const dynamics::StabilityBorder& border : diagram.borders)
    json["stability_borders"].push_back(
        {{"speed", border.speed}, {"begins", border.begins}, {"angular_frequency", border.mode.frequency()}});
  json["speeds"] = Json::array();
  for (std::size_t i = 0; i < diagram.speeds.size(); ++i) {
    Json row;
    row["speed"] = diagram.speeds[i];
    row["modes"] = Json::array();
    for (const dynamics::WhirlMode& mode : diagram.modes[i]) row["modes"].push_back(to_json(mode, diagram.senses[i]));
    json["speeds"].push_back(std::move(row));
  }
  return json;
}

std::string campbell_csv(const Campbell& diagram) {
  std::string text = "speed,mode,angular_frequency,damping,logarithmic_decrement,direction,whirl\n";
  for (std::size_t i = 0; i < diagram.speeds.size(); ++i)
    for (std::size_t k = 0; k < diagram.modes[i].size(); ++k) {
      const dynamics::WhirlMode& mode = diagram.modes[i][k];
      text += formatted("%.17g,%zu,%.17g,%.17g,", diagram.speeds[i], k + 1, mode.frequency(), mode.damping_ratio()) +
              (mode.frequency() > 0.0 ? formatted("%.17g", mode.logarithmic_decrement()) : "") +
              formatted(",%.17g,%s\n", mode.direction, sense_of(mode, diagram.senses[i]));
    }
  return text;
}

bool draw(const Campbell& diagram, const record::ResultFolder& folder) {
  struct Group {
    const char *name, *point;
  };
  constexpr Group kGroups[] = {
      {"forward", "pt 7 ps 0.4 lc rgb '#1f77b4'"},   {"backward", "pt 6 ps 0.4 lc rgb '#d62728'"},
      {"mixed", "pt 8 ps 0.5 lc rgb '#9467bd'"},     {"planar", "pt 5 ps 0.3 lc rgb '#2ca02c'"},
      {"torsional", "pt 1 ps 0.5 lc rgb '#ff7f0e'"}, {"axial", "pt 2 ps 0.5 lc rgb '#8c564b'"}};
  std::string data, plot = "plot ";
  std::vector<std::string> entries;
  const auto add = [&](const std::string& points, const std::string& name, const std::string& style) {
    plot += formatted("'campbell.dat' index %zu w p ", entries.size()) + style + " title '" + name + "', ";
    data += points + "\n\n";
    entries.push_back(name);
  };
  for (const Group& group : kGroups) {
    std::string points;
    for (std::size_t i = 0; i < diagram.speeds.size(); ++i)
      for (const dynamics::WhirlMode& mode : diagram.modes[i])
        if (std::string_view(sense_of(mode, diagram.senses[i])) == group.name)
          points += formatted("%.9g %.9g\n", diagram.speeds[i], mode.frequency());
    if (!points.empty()) add(points, group.name, group.point);
  }
  if (!diagram.critical.empty()) {
    std::string points;
    for (const dynamics::CriticalSpeed& critical : diagram.critical)
      points += formatted("%.9g %.9g\n", critical.speed, diagram.order * std::abs(critical.speed));
    add(points, "critical speeds", "pt 4 ps 1.2 lc rgb 'black'");
  }
  folder.write("campbell.dat", data);
  const std::string line = formatted("%.9g*abs(x)", diagram.order), order = "order " + to_short_text(diagram.order);
  entries.push_back(order);
  plot += line + " w l lc rgb '#808080' title " + gnuplot::quoted(order);
  constexpr double kShape = 0.7;
  // Modes far above the line of the order would flatten the crossings.
  const double fastest = std::max(std::abs(diagram.speeds.front()), std::abs(diagram.speeds.back()));
  double lowest = 0.0;
  for (const dynamics::WhirlMode& mode : diagram.modes.back())
    if (mode.frequency() > 0.0 && (lowest == 0.0 || mode.frequency() < lowest)) lowest = mode.frequency();
  const double top = std::max(1.5 * diagram.order * fastest, 1.2 * lowest);
  std::string borders;
  for (const dynamics::StabilityBorder& border : diagram.borders)
    borders += formatted("set arrow from %.9g, graph 0 to %.9g, graph 1 nohead dt 2 lc rgb '#d62728'\n", border.speed,
                         border.speed) +
               formatted("set label '%s' at %.9g, graph 0.97 right rotate font ',8' tc rgb '#d62728' offset -0.6,0\n",
                         border.begins ? "growth begins" : "growth ends", border.speed);
  const std::string script =
      gnuplot::style() + "set title \"" + plot::folded_title(diagram.title) + "\" noenhanced\n" + borders +
      "set xlabel 'speed of rotation / (rad/s)'\nset ylabel 'angular frequency / (rad/s)'\n" +
      gnuplot::legend_below(entries) +
      formatted("set yrange [0:%.9g]\nset xrange [%.9g:%.9g]\n", top, diagram.speeds.front(), diagram.speeds.back());
  folder.write("campbell.gp", script + gnuplot::draw_into({"png", "svg"}, "campbell", plot, kShape));
  return gnuplot::is_installed() && gnuplot::run_script(folder.path(), "campbell").empty();
}

}  // namespace butee::app::modes
