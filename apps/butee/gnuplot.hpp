#pragma once

#include <array>
#include <string>
#include <vector>

/// Pictures by gnuplot, an external program: scripts that users can read and change.
namespace butee::app::gnuplot {

inline constexpr std::array<const char*, 10> kColours = {"#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e",
                                                         "#17becf", "#8c564b", "#e377c2", "#7f7f7f", "#bcbd22"};

/// True where the program is found.
bool is_installed();
/// What to do where it is not.
std::string remedy();

/// "png", "svg" and "pdf"
std::vector<std::string> formats();

/// A text in gnuplot's quotes.
std::string quoted(const std::string& text);

/// The lines of the house's style: grid, axes, legend.
std::string style();

/// The lines that put a legend with these entries below a picture, in as many rows as it takes.
std::string legend_below(const std::vector<std::string>& entries);

/// `plot` (lines of a script) drawn once into each format, as `<name>.<format>` beside the script.
std::string draw_into(const std::vector<std::string>& formats, const std::string& name, const std::string& plot);

/// Writes `<folder>/<name>.gp`. Throws RunError where that fails.
void write_script(const std::string& folder, const std::string& name, const std::string& text);

/// Runs gnuplot on `<folder>/<name>.gp`, in that folder; what it complained of, or "".
std::string run_script(const std::string& folder, const std::string& name);

}  // namespace butee::app::gnuplot
