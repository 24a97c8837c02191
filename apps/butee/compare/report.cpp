#include "report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>

#include <butee/core/text.hpp>
#include <butee/study/table.hpp>

#include "../gnuplot.hpp"

namespace butee::app::compare {
namespace {

std::string number(double value, int digits = 3) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, value);
  return text.data();
}

/// 0.00123 s as "1.23 ms".
std::string duration(double seconds) {
  if (seconds < 1e-3) return number(seconds * 1e6) + " us";
  if (seconds < 1.0) return number(seconds * 1e3) + " ms";
  return number(seconds) + " s";
}

std::vector<std::string> methods_of(const std::vector<Row>& rows) {
  std::vector<std::string> methods;
  for (const Row& row : rows)
    if (std::find(methods.begin(), methods.end(), row.method) == methods.end()) methods.push_back(row.method);
  return methods;
}

std::string setting_of(const Row& row) {
  return row.knob.empty() ? "as written" : row.knob + " = " + number(row.value);
}

/// True if the reference is accurate enough to measure an error of this size.
bool is_beyond_doubt(const SceneResult& result, double target) {
  constexpr double kTimes = 3.0;
  return target > kTimes * result.reference.uncertainty;
}

void write_reference(std::ostream& out, const SceneResult& result) {
  const Reference& r = result.reference;
  if (r.method.empty()) {
    out << "Reference: " << r.origin << ". Its own error is not known: differences from it are given as errors.\n";
    return;
  }
  out << "Reference: " << r.origin << "; its uncertainty (relative rms of two computations) is "
      << number(r.uncertainty) << ".\n";
  if (r.parted)
    out << "The two computations diverge at t = " << number(r.horizon, 4)
        << " s: later motion cannot be computed this way, and errors are evaluated only up to that time; run times are "
           "those of runs to the end, t = "
        << number(result.end_time, 4) << " s.\n";
  else
    out << "They agree to the end, t = " << number(result.end_time, 4) << " s.\n";
}

void write_fastest(std::ostream& out, const Study& study, const SceneResult& result) {
  out << "\n| error up to | fastest | with | error | time | next best |\n|---|---|---|---|---|---|\n";
  for (const double target : study.targets) {
    out << "| " << number(target) << " | ";
    const Row* best = fastest_beyond_doubt(result, target);
    if (best == nullptr) {
      out << (is_beyond_doubt(result, target) ? "none reached it" : "within the reference's own uncertainty")
          << " | | | | |\n";
      continue;
    }
    // auto, or the method that it took, has the same errors.
    const auto is_alike = [&](const std::string& method) {
      return std::any_of(result.rows.begin(), result.rows.end(), [&](const Row& row) {
        return row.method == method && row.completed() && row.error.rms == best->error.rms;
      });
    };
    std::vector<Row> others;
    for (const Row& row : result.rows)
      if (!is_alike(row.method)) others.push_back(row);
    const Row* next = fastest(others, target);
    out << best->method << " | " << setting_of(*best) << " | " << number(best->error.rms) << " | "
        << duration(best->seconds) << " | "
        << (next != nullptr ? next->method + ", " + number(next->seconds / best->seconds) + " times" : "none")
        << " |\n";
  }
}

void write_runs(std::ostream& out, const SceneResult& result) {
  out << "\n| method | with | error (rms) | error (max) | time | steps | rejected | factorizations | solves | contact "
         "evaluations |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : result.rows) {
    out << "| " << row.method << " | " << setting_of(row) << " | ";
    if (!row.completed()) {
      out << row.outcome << " | | " << duration(row.seconds) << " | | | | | |\n";
      continue;
    }
    out << number(row.error.rms) << " | " << number(row.error.largest) << " | " << duration(row.seconds) << " | "
        << row.steps << " | " << row.rejected << " | " << row.factorizations << " | " << row.solves << " | "
        << row.contact_evaluations << " |\n";
  }
}

std::string quoted(std::string text) {
  std::replace(text.begin(), text.end(), '"', '\'');
  std::replace(text.begin(), text.end(), '\n', ' ');
  return "\"" + text + "\"";
}

constexpr std::size_t kColumns = 16;

}  // namespace

std::string csv_header() {
  return "fingerprint,scene,method,knob,value,outcome,error_rms,error_max,seconds,steps,rejected,newton_iterations,"
         "factorizations,solves,contact_evaluations,force_evaluations";
}

std::string csv_line(const Row& row) {
  std::ostringstream out;
  out.precision(17);
  out << row.fingerprint << ',' << quoted(row.scene) << ',' << row.method << ',' << row.knob << ',' << row.value << ','
      << quoted(row.outcome) << ',';
  if (row.completed()) out << row.error.rms;
  out << ',';
  if (row.completed()) out << row.error.largest;
  out << ',' << row.seconds << ',' << row.steps << ',' << row.rejected << ',' << row.newton << ',' << row.factorizations
      << ',' << row.solves << ',' << row.contact_evaluations << ',' << row.force_evaluations;
  return out.str();
}

std::vector<Row> read_csv(const std::string& path) {
  std::vector<Row> rows;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  if (line != csv_header()) return rows;
  while (std::getline(file, line)) {
    const auto cells = study::cells_of(line);
    if (cells.size() != kColumns) continue;
    try {
      Row row;
      row.fingerprint = cells[0];
      row.scene = cells[1];
      row.method = cells[2];
      row.knob = cells[3];
      row.value = number_of(cells[4]).value();
      row.outcome = cells[5];
      if (row.completed()) row.error = {number_of(cells[6]).value(), number_of(cells[7]).value()};
      row.seconds = number_of(cells[8]).value();
      const std::array<std::int64_t*, 7> counts = {&row.steps,
                                                   &row.rejected,
                                                   &row.newton,
                                                   &row.factorizations,
                                                   &row.solves,
                                                   &row.contact_evaluations,
                                                   &row.force_evaluations};
      for (std::size_t i = 0; i < counts.size(); ++i) *counts[i] = std::stoll(cells[9 + i]);
      rows.push_back(std::move(row));
    } catch (const std::exception&) {
      continue;  // incomplete line left by an interruption
    }
  }
  return rows;
}

namespace {

bool is_drawn(const Row& row) {
  return row.completed() && row.error.rms < 2.0 && row.error.rms > 0.0;
}

/// Number of methods that get a colour in the picture; the others are grey.
constexpr std::size_t kTold = 10;
/// The error at which methods are ranked by time.
constexpr double kRanked = 1e-3;

/// The methods with points to draw, ordered by the time to reach an error of kRanked.
std::vector<std::string> ranked_methods(const SceneResult& result) {
  std::vector<std::pair<double, std::string>> ranked;
  for (const std::string& method : methods_of(result.rows)) {
    double least = std::numeric_limits<double>::infinity(), best = least;
    for (const Row& row : result.rows) {
      if (row.method != method || !is_drawn(row)) continue;
      best = std::min(best, row.error.rms);
      if (row.error.rms <= kRanked) least = std::min(least, row.seconds);
    }
    // Methods that do not reach it follow, ordered by their smallest error.
    if (std::isfinite(best)) ranked.emplace_back(std::isfinite(least) ? least : 1e9 * best, method);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  std::vector<std::string> methods;
  for (auto& entry : ranked) methods.push_back(std::move(entry.second));
  return methods;
}

}  // namespace

const Row* fastest(const std::vector<Row>& rows, double target) {
  const Row* best = nullptr;
  for (const Row& row : rows)
    if (row.completed() && row.error.rms <= target && (best == nullptr || row.seconds < best->seconds)) best = &row;
  return best;
}

const Row* fastest_beyond_doubt(const SceneResult& result, double target) {
  return is_beyond_doubt(result, target) ? fastest(result.rows, target) : nullptr;
}

std::string markdown(const Study& study, const std::vector<SceneResult>& results, const std::string& command) {
  std::ostringstream out;
  out << "# " << (study.title.empty() ? "Run time against error" : study.title) << "\n\nMade by `" << command
      << "`. Errors are relative to a reference over all output times; times are set-up and integration of one run\n"
         "on one machine, the fastest of several, without files.\n";
  for (const SceneResult& result : results) {
    out << "\n## " << (result.title.empty() ? result.scene : result.title) << "\n\n`" << result.scene << "`, "
        << result.column << ", to t = " << number(result.end_time, 4) << " s. ";
    write_reference(out, result);
    if (result.rows.empty()) continue;
    write_fastest(out, study, result);
    if (!ranked_methods(result).empty()) out << "\n![error against time](work-precision-" << result.scene << ".svg)\n";
    write_runs(out, result);
  }
  return out.str();
}

bool draw(const SceneResult& result, const std::string& folder) {
  const std::string name = "work-precision-" + result.scene;
  const std::vector<std::string> drawn = ranked_methods(result);
  if (drawn.empty()) return true;
  std::string script = "# error against time, a block for each method\n$runs << EOD\n";
  double least = 1.0;
  for (const std::string& method : drawn) {
    for (const Row& row : result.rows) {
      if (row.method != method || !is_drawn(row)) continue;
      least = std::min(least, row.error.rms);
      script += number(row.seconds * 1e3, 6) + " " + number(row.error.rms, 6) + "\n";
    }
    script += "\n\n";
  }
  const double own = result.reference.uncertainty;
  const bool shows_reference = own > 0.1 * least;
  std::vector<std::string> legend(drawn.begin(),
                                  drawn.begin() + static_cast<std::ptrdiff_t>(std::min(kTold, drawn.size())));
  if (drawn.size() > kTold) legend.push_back("others");
  if (shows_reference) legend.push_back("reference itself");
  script += "EOD\n" + gnuplot::style() + gnuplot::legend_below(legend) +
            "set logscale xy\nset format x '10^{%L}'\nset format y '10^{%L}'\nset yrange [" + number(0.3 * least, 3) +
            ":*]\nset grid xtics ytics mxtics mytics lt 1 lc rgb '#c8c8c8', lt 1 lc rgb '#eeeeee'\n"
            "set xlabel 'time of one run / ms'\n"
            "set ylabel 'relative rms error of " +
            result.column + "' noenhanced\nset title " +
            gnuplot::quoted(printable(result.title.empty() ? result.scene : result.title)) + " noenhanced\n";
  std::string plot = "plot ";
  if (shows_reference) plot += number(own, 6) + " w l lc rgb '#000000' dt 3 t 'reference itself', ";
  // Grey curves first, below the others.
  for (std::size_t i = drawn.size(); i-- > 0;) {
    plot += "$runs index " + std::to_string(i);
    if (i >= kTold)
      plot += " w lp lw 0.8 ps 0.4 pt 7 lc rgb '#bbbbbb' " + (i == kTold ? "t 'others'" : std::string("notitle"));
    else
      plot += " w lp lw 1.6 ps 0.8 pt " + std::to_string(4 + i % 10) + " lc rgb '" + gnuplot::kColours[i] + "' t " +
              gnuplot::quoted(drawn[i]);
    plot += ", ";
  }
  plot.resize(plot.size() - 2);
  gnuplot::write_script(folder, name, script + gnuplot::draw_into({"png", "svg"}, name, plot));
  return gnuplot::is_installed() && gnuplot::run_script(folder, name).empty();
}

}  // namespace butee::app::compare
