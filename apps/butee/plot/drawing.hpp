#pragma once

#include <functional>

#include <butee/plugin/catalogue.hpp>

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// The selection to draw: probes of runs.
struct Drawing {
  const std::vector<Result>& results;
  std::vector<std::string> labels;  ///< labels of the probes
  Window window;
  bool asked_for;  ///< the kind was named; otherwise all kinds that the results allow are drawn
  const plugin::Catalogue& catalogue;
  bool several() const { return results.size() > 1; }
};

/// One probe of one run.
struct Item {
  const Result* result;
  std::string label;
};

/// The scene's title, or the names of the runs if they belong to several scenes.
std::string title_of(const std::vector<Result>& results);

/// |length| with a readable unit.
std::string length_text(double metres);

/// Axis label for the quantity `what`, with the probe's label if the legend names the runs.
std::string axis_name(const Drawing& drawing, const Item& item, const std::string& what);
/// A curve's name in the legend.
std::string curve_name(const Drawing& drawing, const Item& item);

/// The gap lines of a probe; one legend entry for each gap width.
std::vector<Mark> gap_marks(const Item& item);
/// The load frequencies up to `limit`, Hz.
std::vector<Mark> frequency_marks(const std::vector<Result>& results, double limit);

/// Charts that `add` fills item by item. `add` receives the number of items already in the chart, and returns
/// false for items that it cannot draw. All probes of a single run share a chart unless `apart`; for several
/// runs there is one chart for each probe.
std::vector<Chart> grouped(const Drawing& drawing, const std::string& name, bool apart,
                           const std::function<bool(const Item&, std::size_t, Chart&)>& add);

}  // namespace butee::app::plot
