#pragma once

#include <array>
#include <string>
#include <vector>

/// Pictures by gnuplot, an external program: scripts that users can read and change.
namespace butee::app::gnuplot {

inline constexpr std::array<const char*, 10> kColours = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e",
                                                         "#17becf", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22"};

/// True if gnuplot is found.
bool is_installed();
/// Hint shown if gnuplot is missing.
std::string remedy();

/// Picture formats: "png", "svg" and "pdf".
std::vector<std::string> formats();

/// Quotes text for gnuplot.
std::string quoted(const std::string& text);

/// gnuplot commands for the common style: grid, axes, legend.
std::string style();

/// gnuplot commands for a legend with these entries below the picture, in as many rows as needed.
std::string legend_below(const std::vector<std::string>& entries);

/// Height over width of most pictures.
inline constexpr double kFlat = 0.6;

/// Commands that draw `plot` (lines of a script) in each format, as `<name>.<format>` beside the script; `shape` is
/// height over width.
std::string draw_into(const std::vector<std::string>& formats, const std::string& name, const std::string& plot,
                      double shape = kFlat);

/// A text as the name of a file in the present folder, on one line: without slashes and control characters.
std::string file_name(std::string text);

/// Writes `<folder>/<name>.gp`. Throws RunError on failure.
void write_script(const std::string& folder, const std::string& name, const std::string& text);

/// Runs gnuplot on `<folder>/<name>.gp` in that folder; returns gnuplot's error messages, or "".
std::string run_script(const std::string& folder, const std::string& name);

}  // namespace butee::app::gnuplot
