#pragma once

#include <functional>

#include "drawing.hpp"

namespace butee::app::plot {

/// A kind of picture of runs.
struct Kind {
  std::string name;
  std::string needs;  ///< the data that it requires of a result, and how to obtain them
  /// The pictures that the results allow; empty if required data are missing.
  std::function<std::vector<Picture>(const Drawing&)> draw;
};

/// The kinds that have names of their own: "displacement", "force" ...
const std::vector<Kind>& named_kinds();

/// The kinds that are drawn if none is asked for: the named ones, and one for each quantity of the probes that none of
/// them shows. Velocities and accelerations over time are drawn only if asked for.
std::vector<Kind> default_kinds(const std::vector<Result>& results);

/// The kind of a name: a named one, or a quantity of probes over time ("T", "von_mises" ...). Throws InputError for
/// other names.
Kind kind_of(const std::string& name);

}  // namespace butee::app::plot
