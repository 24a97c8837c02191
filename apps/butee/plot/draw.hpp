#pragma once

#include "pictures.hpp"

namespace butee::app::plot {

struct Request {
  std::vector<std::string> folders;  ///< of results
  std::vector<std::string> kinds;    ///< empty: those that the data allow
  std::vector<std::string> formats = {"png"};
  std::vector<std::string> probes;  ///< labels; empty: all
  Window window;
  std::string output;  ///< a folder; empty: "plots" in the result folder, or here for several
};

/// The formats of pictures, and "script" for the script alone.
std::vector<std::string> picture_formats();

/// Throws InputError where gnuplot is wanted and not there.
void require_gnuplot(const std::vector<std::string>& formats);

/// Draws, and returns the files that it made. Throws InputError where there is nothing to draw of a kind that was asked
/// for, and RunError where drawing fails.
std::vector<std::string> draw(const Request& request, const plugin::Catalogue& catalogue);

}  // namespace butee::app::plot
