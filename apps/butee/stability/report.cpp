#include "report.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include <butee/core/text.hpp>
#include <nlohmann/json.hpp>

#include "../gnuplot.hpp"

namespace butee::app::stability {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(const std::optional<double>& value) {
  if (!value || !std::isfinite(*value)) return "";
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.17g", *value);
  return text.data();
}

std::string cell(double value) {
  return cell(std::optional<double>(value));
}

std::string declared_text(double limit) {
  return std::isinf(limit) ? "none" : to_short_text(limit);
}

Json number(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json to_json(const Limit& limit) {
  const char* const kinds[] = {"found", "unbounded", "no_map"};
  Json json = {{"kind", kinds[static_cast<int>(limit.kind)]}, {"value", limit.value}};
  if (!limit.why.empty()) json["why"] = limit.why;
  return json;
}

/// Height over width of three curves above each other, and of a map.
constexpr double kTall = 1.1, kNearlySquare = 0.8;

/// Writes the same picture as PNG and as SVG.
bool plot(const std::string& folder, const std::string& name, const std::string& commands, double shape) {
  gnuplot::write_script(folder, name, gnuplot::draw_into({"png", "svg"}, name, commands, shape));
  return gnuplot::is_installed() && gnuplot::run_script(folder, name).empty();
}

std::string curve_plot(const std::vector<Analysis>& all, const std::string& data, double ratio) {
  std::string commands =
      "reset\nset encoding utf8\nset datafile separator ','\nset datafile missing ''\nset multiplot layout 3,1\nset "
      "logscale x\nset "
      "xlabel "
      "'h ω'\nset grid\nset key outside right noenhanced\n";
  const std::array<const char*, 3> labels = {"spectral radius", "numerical damping ratio", "period error"};
  const std::array<const char*, 3> ranges = {"[0:1.5]", "[-0.05:0.6]", "[-0.5:1]"};
  commands += "set xrange [0.01:100]\n";
  for (std::size_t i = 0; i < labels.size(); ++i) {
    commands += "set ylabel '" + std::string(labels[i]) + "'\nset yrange " + ranges[i] + "\n";
    if (i == 0) commands += "set title 'damping ratio " + to_short_text(ratio) + "'\n";
    if (i == 1) commands += "unset title\n";
    commands += "plot ";
    for (std::size_t k = 0; k < all.size(); ++k)
      commands += std::string(k > 0 ? ", " : "") + gnuplot::quoted(data) + " using (strcol(1) eq '" + all[k].method +
                  "' && $2 == " + to_text(ratio) + " ? $3 : 1/0):" + std::to_string(i + 4) +
                  " every ::1 with lines lw 1.6 title '" + all[k].method + "'";
    commands += "\n";
  }
  return commands + "unset multiplot\n";
}

std::string stop_plot(const Analysis& one, const std::string& data) {
  // Cells of the grid of stops.csv, which is evenly spaced in both logarithms.
  const auto half_step = [&](double Sample::*quantity) {
    double ratio = std::numeric_limits<double>::infinity();
    for (const Sample& sample : one.stops) {
      const double step = sample.*quantity / one.stops.front().*quantity;
      if (step > 1.0 + 1e-9) ratio = std::min(ratio, step);
    }
    return std::isfinite(ratio) ? std::sqrt(ratio) : 1.5;
  };
  const std::string x = to_short_text(half_step(&Sample::h_omega)), y = to_short_text(half_step(&Sample::stop_ratio));
  return "reset\nset encoding utf8\nset datafile separator ','\nset datafile missing ''\nset logscale xy\nset xlabel "
         "'h ω'\nset "
         "ylabel "
         "'k_c / k'\nset xrange [*:*] noextend\nset yrange [*:*] noextend\nset cblabel 'spectral radius'\nset cbrange "
         "[0:2]\nset palette defined (0 '#2166ac', 0.99 "
         "'#d1e5f0', 1.01 '#fddbc7', 2 '#b2182b')\nset title '" +
         one.method + " with a closed stop' noenhanced\nset grid\nunset key\nplot " + gnuplot::quoted(data) +
         " using 3:2:($3/" + x + "):($3*" + x + "):($2/" + y + "):($2*" + y +
         "):4 every ::1 with boxxyerror fillstyle solid noborder lc palette\n";
}

}  // namespace

std::string text_of(const Limit& limit) {
  switch (limit.kind) {
    case Limit::Kind::found:
      return to_short_text(limit.value);
    case Limit::Kind::unbounded:
      return "none to " + to_short_text(limit.value);
    case Limit::Kind::no_map:
      break;
  }
  return limit.value > 0.0 ? "no map beyond " + to_short_text(limit.value) : "no map";
}

std::string table(const std::vector<Analysis>& all, const Request& request) {
  std::vector<std::vector<std::string>> rows = {
      {"method", "h omega stable up to", "declared", "h c/m stable up to", "declared"}};
  for (const double ratio : request.ratios)
    if (ratio > 0.0) rows[0].push_back("h omega, ratio " + to_short_text(ratio));
  std::string notes;
  for (const Analysis& one : all) {
    rows.push_back({one.method, text_of(one.undamped), declared_text(one.declared_stability), text_of(one.dashpot),
                    declared_text(one.declared_damping)});
    for (std::size_t i = 0; i < one.damped.size(); ++i)
      if (request.ratios[i] > 0.0) rows.back().push_back(text_of(one.damped[i]));
    if (!one.undamped.why.empty())
      notes += one.method + ": there is no map of one step " +
               (one.has_map() ? "beyond h omega = " + to_short_text(one.undamped.value) : std::string("at all")) +
               ": " + one.undamped.why + "\n";
    if (!one.choice.empty()) notes += one.method + ": " + one.choice + "\n";
  }
  std::vector<std::size_t> widths(rows[0].size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += row[i] + (i + 1 < row.size() ? std::string(widths[i] - row[i].size() + 2, ' ') : "");
    text += "\n";
  }
  return text + notes;
}

std::string curves_csv(const std::vector<Analysis>& all) {
  std::string text = "method,damping_ratio,h_omega,spectral_radius,numerical_damping,period_error\n";
  for (const Analysis& one : all)
    for (const Sample& s : one.curves)
      text += one.method + "," + cell(s.ratio) + "," + cell(s.h_omega) + "," + cell(s.properties.radius) + "," +
              cell(s.properties.damping) + "," + cell(s.properties.period_error) + "\n";
  return text;
}

std::string stops_csv(const std::vector<Analysis>& all) {
  std::string text = "method,stop_ratio,h_omega,spectral_radius\n";
  for (const Analysis& one : all)
    for (const Sample& s : one.stops)
      text += one.method + "," + cell(s.stop_ratio) + "," + cell(s.h_omega) + "," + cell(s.properties.radius) + "\n";
  return text;
}

std::string to_json(const std::vector<Analysis>& all, const Request& request) {
  Json list = Json::array();
  for (const Analysis& one : all) {
    Json json = {{"method", one.method}, {"parameters", one.parameters}};
    if (!one.choice.empty()) json["choice"] = one.choice;
    json["has_map"] = one.has_map();
    json["undamped"] = to_json(one.undamped);
    json["dashpot"] = to_json(one.dashpot);
    json["declared"] = {{"stability_limit", number(one.declared_stability)},
                        {"damping_limit", number(one.declared_damping)}};
    json["damped"] = Json::array();
    for (std::size_t i = 0; i < one.damped.size(); ++i) {
      json["damped"].push_back(to_json(one.damped[i]));
      json["damped"].back()["damping_ratio"] = request.ratios[i];
    }
    json["with_stop"] = Json::array();
    for (std::size_t i = 0; i < one.with_stop.size(); ++i) {
      json["with_stop"].push_back(to_json(one.with_stop[i]));
      json["with_stop"].back()["stop_ratio"] = request.stop_ratios[i];
    }
    list.push_back(std::move(json));
  }
  return list.dump(2) + "\n";
}

bool draw(const std::vector<Analysis>& all, const Request& request, const std::string& folder) {
  std::vector<Analysis> drawn;
  for (const Analysis& one : all)
    if (one.has_map()) drawn.push_back(one);
  if (drawn.empty()) return true;
  bool good = true;
  for (const double ratio : request.ratios) {
    const std::string name = "stability" + (ratio > 0.0 ? "-" + to_short_text(ratio) : "");
    good = plot(folder, name, curve_plot(drawn, "stability.csv", ratio), kTall) && good;
  }
  if (drawn.size() == 1 && !request.stop_ratios.empty())
    good = plot(folder, "stops", stop_plot(drawn.front(), "stops.csv"), kNearlySquare) && good;
  return good;
}

}  // namespace butee::app::stability
