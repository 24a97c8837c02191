#include "drawing.hpp"

#include <cmath>
#include <set>

namespace butee::app::plot {

std::string length_text(double metres) {
  const Scale scale = scale_for(std::abs(metres), "m");
  return short_number(std::abs(metres) * scale.factor) + " " + scale.unit;
}

std::string title_of(const std::vector<Result>& results) {
  std::set<std::string> titles;
  for (const Result& result : results) titles.insert(result.title);
  if (titles.size() == 1 && !titles.begin()->empty()) return *titles.begin();
  if (results.size() == 1) return results.front().label;
  std::string all;
  for (const Result& result : results) all += (all.empty() ? "" : ", ") + result.label;
  return all;
}

std::vector<Mark> gap_marks(const Item& item) {
  std::set<double> all;
  for (const Probe& probe : item.result->probes)
    if (probe.label == item.label) all.insert(probe.gaps.begin(), probe.gaps.end());
  std::vector<Mark> marks;
  for (const double gap : all) {
    const bool both = all.contains(-gap);
    const std::string text = "gap " + std::string(both && gap != 0.0 ? "±" : gap < 0.0 ? "-" : "") + length_text(gap);
    marks.push_back({gap, both && gap < 0.0 ? "" : text});
  }
  return marks;
}

std::vector<Mark> frequency_marks(const std::vector<Result>& results, double limit) {
  std::set<double> all;
  for (const Result& result : results) all.insert(result.frequencies.begin(), result.frequencies.end());
  std::vector<Mark> marks;
  for (const double f : all)
    if (f <= limit) marks.push_back({f, "load " + short_number(f) + " Hz"});
  return marks;
}

std::vector<Chart> grouped(const Drawing& drawing, const std::string& name, bool apart,
                           const std::function<bool(const Item&, std::size_t, Chart&)>& add) {
  std::vector<Chart> charts;
  std::vector<std::vector<Item>> groups;
  for (const std::string& label : drawing.labels) {
    const bool alone = drawing.several() || apart || groups.empty();
    if (alone) groups.emplace_back();
    for (const Result& result : drawing.results) groups.back().push_back({&result, label});
  }
  for (const std::vector<Item>& items : groups) {
    Chart chart;
    chart.title = title_of(drawing.results);
    std::vector<Item> drawn;
    for (const Item& item : items)
      if (add(item, drawn.size(), chart)) drawn.push_back(item);
    if (drawn.empty()) continue;
    const bool named = groups.size() > 1 || drawing.several();
    chart.name = named ? name + "-" + items.front().label : name;
    charts.push_back(std::move(chart));
  }
  return charts;
}

std::string axis_name(const Drawing& drawing, const Item& item, const std::string& what) {
  return drawing.several() ? what + " of " + item.label : what;
}

std::string curve_name(const Drawing& drawing, const Item& item) {
  return drawing.several() ? item.result->label : item.label;
}

}  // namespace butee::app::plot
