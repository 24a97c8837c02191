#pragma once

#include "result.hpp"

namespace butee::app::plot {

struct Request {
  std::vector<std::string> folders;  ///< result folders
  std::vector<std::string> kinds;    ///< kind_names() or quantities of probes; empty: all that the data allow
  std::vector<std::string> formats = {"png"};
  std::vector<std::string> probes;  ///< labels; empty: all
  Window window;
  std::string output;  ///< a folder; empty: "plots" in the result folder, or in the current folder for several results
};

/// The names of the kinds that have names of their own; quantities of probes are kinds, too.
std::vector<std::string> kind_names();

/// Formats of pictures, and "script" for the gnuplot script alone.
std::vector<std::string> picture_formats();

/// Throws InputError if gnuplot is needed but missing.
void require_gnuplot(const std::vector<std::string>& formats);

/// Draws and returns the names of the written files. Throws InputError if a requested kind has nothing to
/// draw, and RunError if drawing fails.
std::vector<std::string> draw(const Request& request, const plugin::Catalogue& catalogue);

}  // namespace butee::app::plot
