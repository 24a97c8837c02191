#include "butee/study/read_axis.hpp"

#include <algorithm>
#include <cmath>

#include "butee/config/file_reference.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/study/points.hpp"

namespace butee::study {
namespace {

using config::Parameters;
using config::Value;

class AxisReader {
 public:
  explicit AxisReader(config::Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  std::optional<Axis> read(const Parameters& p, const Value& table, PlanKind kind) {
    const std::string& path = p.path();
    Axis axis{p.text("key"), {}};
    axis.place = describe(diagnostics_.document(), p.value("key").at) + ": " + path;
    if (p.has("label")) axis.label = p.text("label");
    if (axis.key.empty() || axis.key.find('=') != std::string::npos) {
      p.complain(diagnostics_, "key", "must be a key of the scene as --set takes it, such as load[0].amplitude");
      return std::nullopt;
    }
    const Value* values = table.table()->find("values");
    const int ways = (values != nullptr ? 1 : 0) + (p.has("file") ? 1 : 0) + (p.has("from") || p.has("to") ? 1 : 0);
    if (ways != 1) {
      diagnostics_.error(path, table.at,
                         "give its values in one way: values = [...], or from, to and count, or file = \"points.csv\"");
      return std::nullopt;
    }
    if (!p.has("file"))
      if (p.has("column")) p.complain(diagnostics_, "column", "belongs to file, which is not given");
    if (values != nullptr || p.has("file"))
      for (const char* key : {"count", "spacing"})
        if (p.given(key)) p.complain(diagnostics_, key, "belongs to from and to, which are not given");
    if (values != nullptr) axis.place = describe(diagnostics_.document(), values->at) + ": " + path;
    if (values != nullptr) return read_values(*values, path, std::move(axis));
    if (p.has("file")) return read_file(p, std::move(axis));
    return read_range(p, kind, std::move(axis));
  }

 private:
  std::optional<Axis> read_values(const Value& values, const std::string& path, Axis axis) {
    if (values.array() == nullptr || values.array()->empty()) {
      diagnostics_.error(path + ".values", values, "must be an array with at least one value");
      return std::nullopt;
    }
    axis.values = *values.array();
    return axis;
  }

  std::optional<Axis> read_range(const Parameters& p, PlanKind kind, Axis axis) {
    for (const char* key : {"from", "to"})
      if (!p.has(key)) {
        p.complain(diagnostics_, key, "missing; a range needs both from and to");
        return std::nullopt;
      }
    axis.range = Axis::Range{p.number("from"), p.number("to"), p.text("spacing") == "log"};
    if (axis.range->is_logarithmic && !(axis.range->from > 0.0 && axis.range->to > 0.0)) {
      p.complain(diagnostics_, "spacing", "log needs from and to above 0");
      return std::nullopt;
    }
    if (!std::isfinite(axis.range->to - axis.range->from)) {
      p.complain(diagnostics_, "to", "is too far from `from`");
      return std::nullopt;
    }
    const bool is_random = kind == PlanKind::sobol || kind == PlanKind::latin;
    if (is_random) {
      if (p.has("count")) p.complain(diagnostics_, "count", "applies to the whole plan: write it in [study]");
      if (!(axis.range->to != axis.range->from)) p.complain(diagnostics_, "to", "the range is empty");
      return axis;
    }
    if (!p.has("count")) {
      p.complain(diagnostics_, "count", "missing; give the number of values from one end to the other (integer >= 1)");
      return std::nullopt;
    }
    const std::int64_t count = p.integer("count");
    if (count > Plan::kMostPoints) {
      p.complain(diagnostics_, "count",
                 "is more than the " + std::to_string(Plan::kMostPoints) + " points that a study may have");
      return std::nullopt;
    }
    if (count > 1 && axis.range->to == axis.range->from) {
      p.complain(diagnostics_, "to", "the range is empty, but count requests " + std::to_string(count) + " values");
      return std::nullopt;
    }
    if (count == 1 && axis.range->to != axis.range->from) {
      p.complain(diagnostics_, "count", "a range with two ends needs at least 2 values");
      return std::nullopt;
    }
    axis.count = count;
    return axis;
  }

  std::optional<Axis> read_file(const Parameters& p, Axis axis) {
    const std::string path = config::path_beside(diagnostics_.document(), p.text("file"));
    try {
      const PointTable table = read_points(config::read_text(path));
      if (table.rows.empty()) {
        p.complain(diagnostics_, "file", path + " holds no points: a line of names and then a line for each point");
        return std::nullopt;
      }
      const std::string wanted = p.has("column")           ? p.text("column")
                                 : table.names.size() == 1 ? table.names.front()
                                                           : axis.key;
      const auto found = std::find(table.names.begin(), table.names.end(), wanted);
      if (found == table.names.end()) {
        p.complain(diagnostics_, p.has("column") ? "column" : "file",
                   path + " has no column \"" + wanted + "\"" + suggestion(wanted, table.names) + "; it has " +
                       join(table.names));
        return std::nullopt;
      }
      if (std::find(found + 1, table.names.end(), wanted) != table.names.end()) {
        p.complain(diagnostics_, p.has("column") ? "column" : "file",
                   path + " has two columns \"" + wanted + "\"; rename one of them");
        return std::nullopt;
      }
      const auto column = static_cast<std::size_t>(found - table.names.begin());
      for (const auto& row : table.rows) axis.values.push_back(value_of(row[column]));
    } catch (const InputError& error) {
      p.complain(diagnostics_, "file", path + ": " + error.what());
      return std::nullopt;
    }
    return axis;
  }

  config::Diagnostics& diagnostics_;
};

}  // namespace

std::optional<Axis> read_axis(const Parameters& parameters, const Value& table, PlanKind kind,
                              config::Diagnostics& diagnostics) {
  return AxisReader(diagnostics).read(parameters, table, kind);
}

}  // namespace butee::study
