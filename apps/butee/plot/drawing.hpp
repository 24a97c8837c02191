#pragma once

#include <functional>

#include "chart.hpp"
#include "result.hpp"

namespace butee::app::plot {

/// What is drawn: probes of runs.
struct Drawing {
  const std::vector<Result>& results;
  std::vector<std::string> labels;  ///< of the probes
  bool several() const { return results.size() > 1; }
};

/// A probe of a run.
struct Item {
  const Result* result;
  std::string label;
};

/// The scene's title, or the runs' names where they are of several scenes.
std::string title_of(const std::vector<Result>& results);

/// |length| with a unit in which it is easy to read.
std::string length_text(double metres);

/// What an axis shows, with the probe where the legend names the runs.
std::string axis_name(const Drawing& drawing, const Item& item, const std::string& what);
/// A curve's name in the legend.
std::string curve_name(const Drawing& drawing, const Item& item);

/// The gap lines of a probe; one entry in the legend for each width.
std::vector<Mark> gap_marks(const Item& item);
/// The frequencies of the loads up to `limit`, Hz.
std::vector<Mark> frequency_marks(const std::vector<Result>& results, double limit);

/// Charts that `add` fills, item by item; it gets the number of those that are in the chart already, and returns false
/// for what it cannot draw. All probes of a single run share a chart where they are not to stand `apart`; of several
/// runs there is one for each probe.
std::vector<Chart> grouped(const Drawing& drawing, const std::string& name, bool apart,
                           const std::function<bool(const Item&, std::size_t, Chart&)>& add);

}  // namespace butee::app::plot
