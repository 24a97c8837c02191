#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include "butee/config/file_reference.hpp"
#include "butee/config/override.hpp"
#include "butee/config/parameters.hpp"
#include "butee/config/toml.hpp"
#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/scene/read_scene.hpp"
#include "butee/study/points.hpp"
#include "butee/study/read_axis.hpp"
#include "butee/study/study.hpp"

namespace butee::study {
namespace {

using config::Diagnostics;
using config::Parameter;
using config::Parameters;
using config::Table;
using config::Value;

/// Frequencies of loads that differ by less than this fraction are taken as equal.
constexpr double kSameFrequency = 1e-12;

constexpr double kStepsUntilEnd = 1000.0;

const std::vector<std::string> kPlans = {"grid", "list", "sobol", "latin"};
/// All integers below are exact as a double.
constexpr double kLargestInteger = 9e15;

PlanKind kind_of(const std::string& name) {
  return static_cast<PlanKind>(std::find(kPlans.begin(), kPlans.end(), name) - kPlans.begin());
}

/// Reads the tables of a study.
class Reader {
 public:
  Reader(const config::Document& document, Diagnostics& diagnostics)
      : document_(document), diagnostics_(diagnostics), root_(*document.root.table()) {}

  /// A scene or a comparison of methods gets one kind of message, not one for each of its keys.
  void refuse_others() {
    if (const Value* element = root_.find("element"); element != nullptr && root_.find("scene") == nullptr)
      diagnostics_.error("element", element->at,
                         "belongs to a scene, which `butee run` computes; a study has scene = \"FILE\" and [[vary]]");
    const Value* table = root_.find("study");
    for (const char* of_compare : {"scenes", "method", "targets"})
      if (table != nullptr && table->table() != nullptr && table->table()->find(of_compare) != nullptr)
        diagnostics_.error(std::string("study.") + of_compare, table->at,
                           "belongs to a comparison of methods, which is `butee compare`; a study of `butee study` has "
                           "scene and [[vary]]");
    diagnostics_.throw_if_any();
  }

  void check_root() {
    read_parameters(document_.root, "",
                    {config::integer("schema", "the version of this format").at_least(1).at_most(1),
                     config::text("scene", "the model file, beside the study"),
                     config::text("title", "the title of pictures").optional(),
                     config::table("vary", "[[vary]]: the keys that vary").optional(),
                     config::table("study", "the keys of the plan, the periods and the results").optional()},
                    diagnostics_);
  }

  std::optional<Parameters> settings() {
    const Value empty;
    const Value* table = root_.find("study");
    auto p = read_parameters(table != nullptr ? *table : empty, "study", study_parameters(), diagnostics_, {"follow"});
    follow_ = read_follow(table);
    return p;
  }

  Follow follow() const { return follow_; }

  std::vector<Axis> axes(PlanKind kind) {
    std::vector<Axis> axes;
    const Value* list = root_.find("vary");
    if (list == nullptr) return axes;
    if (list->array() == nullptr) {
      diagnostics_.error("vary", *list, "must be an array of tables: write [[vary]]");
      return axes;
    }
    std::set<std::string> keys;
    for (std::size_t i = 0; i < list->array()->size(); ++i) {
      const std::string path = "vary[" + std::to_string(i) + "]";
      const auto p = read_parameters((*list->array())[i], path, vary_parameters(), diagnostics_, {"values"});
      if (!p) continue;
      if (!keys.insert(p->text("key")).second) p->complain(diagnostics_, "key", "varies twice");
      if (auto axis = read_axis(*p, (*list->array())[i], kind, diagnostics_)) axes.push_back(std::move(*axis));
    }
    return axes;
  }

 private:
  Follow read_follow(const Value* table) {
    const Value* value = table != nullptr && table->table() != nullptr ? table->table()->find("follow") : nullptr;
    if (value == nullptr) return Follow::no;
    if (const bool* flag = std::get_if<bool>(&value->data)) return *flag ? Follow::both : Follow::no;
    if (const std::string* text = value->text(); text != nullptr && (*text == "up" || *text == "down"))
      return *text == "up" ? Follow::up : Follow::down;
    diagnostics_.error("study.follow", *value, "must be true (sweeps up and down), false, \"up\" or \"down\"");
    return Follow::no;
  }

  const config::Document& document_;
  Diagnostics& diagnostics_;
  const Table& root_;
  Follow follow_ = Follow::no;
};

std::vector<Axis> axes_of_points(const std::string& text) {
  const PointTable table = read_points(text);
  if (table.names.empty()) throw InputError("the points have no first line with the keys that vary");
  std::vector<Axis> axes;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    if (std::count(table.names.begin(), table.names.end(), table.names[i]) > 1)
      throw InputError("the first line of the points names " + table.names[i] + " twice");
    axes.push_back({table.names[i], {}});
    for (const auto& row : table.rows) axes.back().values.push_back(value_of(row[i]));
  }
  return axes;
}

std::vector<Item> read_items(const Parameters& p, Diagnostics& diagnostics) {
  std::vector<Item> items;
  std::set<std::string> known;
  for (const std::string& text : p.texts("collect")) {
    try {
      items.push_back(read_item(text));
      items.back().place = describe(diagnostics.document(), p.value("collect").at) + ": " + p.key("collect");
      if (!known.insert(text).second) p.complain(diagnostics, "collect", "names \"" + text + "\" twice");
    } catch (const InputError& error) {
      p.complain(diagnostics, "collect", error.what());
    }
  }
  if (p.texts("collect").empty()) p.complain(diagnostics, "collect", "must name at least one result");
  return items;
}

config::Document scene_beside(const config::Document& study, Diagnostics& diagnostics) {
  const Value& scene = *study.root.table()->find("scene");
  const std::string path = config::path_beside(study, *scene.text());
  if (!std::filesystem::exists(path))
    diagnostics.error("scene", scene, "does not exist; the path is relative to the study");
  diagnostics.throw_if_any();
  config::Document found = config::load_toml(path);
  if (is_study(found)) {
    diagnostics.error("scene", scene, "is a study, not a scene; name the model that it varies");
    diagnostics.throw_if_any();
  }
  return found;
}

/// The origins of values of the scene, in messages.
constexpr const char *kOfSet = "study.set", *kOfAxis = "value of the study";

/// Applies an override of [study] set; returns the reason why that is not possible, or "".
std::string why_not_applied(const std::string& assignment, config::Document& scene) {
  try {
    config::apply_override(scene, assignment, kOfSet);
    return "";
  } catch (const InputError& error) {
    std::string reason = error.what();
    if (const std::string prefix = std::string(kOfSet) + " " + assignment + ": "; reason.starts_with(prefix))
      reason.erase(0, prefix.size());
    return reason;
  }
}

/// The key that the number of periods determines.
constexpr const char* kEndTime = "integrator.end_time";

/// The reason why an override would be used in no run, or "".
std::string why_unused(const std::string& key, bool has_periods, const std::vector<Axis>& axes) {
  if (std::any_of(axes.begin(), axes.end(), [&](const Axis& axis) { return axis.key == key; }))
    return "the study varies " + key +
           ", so that this value would be used in no run; remove it, or the key from what varies";
  if (has_periods && key == kEndTime)
    return "settle and periods determine the end of every run, so that this value would not be used; remove it or "
           "periods";
  return "";
}

/// Complains of keys of [[vary]] that lead to no place in the scene, or that no run would use.
void check_keys(const config::Document& study, const config::Document& scene, const std::vector<Axis>& axes,
                bool has_periods, Diagnostics& diagnostics) {
  const config::Array& list = *study.root.table()->find("vary")->array();
  for (std::size_t i = 0; i < axes.size() && i < list.size(); ++i) {
    config::Document copy = scene;
    std::string problem = why_unused(axes[i].key, has_periods, {});
    if (problem.empty()) problem = why_not_applied(axes[i].key + "=0", copy);
    if (!problem.empty())
      diagnostics.error("vary[" + std::to_string(i) + "].key", *list[i].table()->find("key"), problem);
  }
  diagnostics.throw_if_any();
}

/// The scene with the overrides of the study and of the command.
config::Document with_overrides(config::Document scene, const Parameters& p, const StudyOptions& options,
                                const std::vector<Axis>& axes, Diagnostics& diagnostics) {
  const auto unused = [&](const std::string& assignment) {
    return why_unused(assignment.substr(0, assignment.find('=')), p.has("periods"), axes);
  };
  if (p.has("set"))
    for (const std::string& assignment : p.texts("set")) {
      std::string problem = unused(assignment);
      if (problem.empty()) problem = why_not_applied(assignment, scene);
      if (!problem.empty()) p.complain(diagnostics, "set", "\"" + assignment + "\": " + problem);
    }
  diagnostics.throw_if_any();
  for (const std::string& assignment : options.overrides) {
    if (const std::string problem = unused(assignment); !problem.empty())
      throw InputError("--set \"" + assignment + "\": " + problem);
    config::apply_override(scene, assignment);
  }
  return scene;
}

/// A value of a range for a key that the scene gives as an integer: 4 instead of 4.0.
Value as_in_scene(const config::Document& scene, const Axis& axis, const Value& value) {
  const auto* number = std::get_if<double>(&value.data);
  if (!axis.range || number == nullptr || *number != std::floor(*number) || !(std::abs(*number) < kLargestInteger))
    return value;
  const Value* present = config::find_value(scene, axis.key);
  if (present == nullptr || !std::holds_alternative<std::int64_t>(present->data)) return value;
  return Value(static_cast<std::int64_t>(*number));
}

}  // namespace

std::vector<Parameter> study_parameters() {
  return {config::text("plan", "how the values are combined").one_of(kPlans).or_else("grid"),
          config::integer("count", "the number of points of plan sobol or latin").at_least(1).optional(),
          config::integer("seed", "the seed of plan sobol (digital shift) or latin").at_least(0).optional(),
          config::integer("settle", "the number of periods before results count")
              .at_least(0)
              .at_most(Study::kMostPeriods)
              .or_else(std::int64_t{0}),
          config::integer("periods", "the number of periods that count; default: to end_time of the scene")
              .at_least(1)
              .at_most(Study::kMostPeriods)
              .optional(),
          config::number("period", "s", "the period for settle, periods and sections; default: that of the loads")
              .above(0)
              .optional(),
          config::number("steady", "1", "ends settling early if the motion repeats within this relative difference")
              .above(0)
              .at_most(1e-2)
              .optional(),
          config::texts("collect", "the results of each run"),
          config::texts("set", "overrides of the scene for all runs: KEY=VALUE").optional()};
}

std::vector<Parameter> vary_parameters() {
  return {config::text("key", "a key of the scene, as --set takes it: load[0].amplitude"),
          config::number("from", "", "the first value of a range").optional(),
          config::number("to", "", "the last value of a range").optional(),
          config::integer("count", "the number of values of a range").at_least(1).optional(),
          config::text("spacing", "the spacing of the values of a range").one_of({"linear", "log"}).or_else("linear"),
          config::text("file", "a CSV file with a line of names, beside the study").optional(),
          config::text("label", "the label of its axis in pictures: \"load / N\"; default: the key").optional(),
          config::text("column", "its column; default: the only one, or that of the key's name").optional()};
}

bool is_study(const config::Document& document) {
  return document.root.table() != nullptr &&
         (document.root.table()->find("scene") != nullptr || document.root.table()->find("vary") != nullptr);
}

config::Document scene_at(const Study& study, const std::vector<Value>& values) {
  config::Document scene = study.scene;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Axis& axis = study.plan.axes()[i];
    config::apply_override(scene, axis.key + "=" + config::to_toml(as_in_scene(study.scene, axis, values[i])),
                           axis.place.empty() ? kOfAxis : axis.place + ": " + kOfAxis);
  }
  // The study determines the end of its runs; until it is known, any end after the first step will
  // do.
  Table* integrator = (*scene.root.table())["integrator"].table();
  if (study.periods && integrator != nullptr && integrator->find("end_time") == nullptr) {
    const Value* step = integrator->find("time_step");
    (*integrator)["end_time"] =
        Value(step != nullptr ? std::max(1.0, kStepsUntilEnd * config::as_number(*step).value_or(0.0)) : 1.0);
  }
  return scene;
}

double period_of(const model::Model& model) {
  double frequency = 0.0;
  for (const model::Load& load : model.loads) {
    const auto harmonic = load.in_time->harmonic();
    if (!harmonic || harmonic->angular_frequency == 0.0) continue;
    const double own = std::abs(harmonic->angular_frequency);
    if (frequency != 0.0 && std::abs(own - frequency) > kSameFrequency * frequency)
      throw InputError(
          "the loads of the scene have several frequencies, so that no period follows from them; write "
          "period = ... (s) in [study]");
    if (frequency == 0.0) frequency = own;
  }
  if (frequency == 0.0)
    throw InputError(
        "no load of the scene is harmonic, so that no period follows from them; write period = ... (s) in "
        "[study]");
  return 2.0 * std::numbers::pi / frequency;
}

namespace {

bool is_number(const Value& value) {
  return config::as_number(value).has_value();
}

/// Values of different kinds, or not finite, may be mistakes for the scene: those are errors of the study, before a run
/// fails for them.
void check_values(const Study& study) {
  for (std::size_t i = 0; i < study.plan.axes().size(); ++i) {
    const std::vector<Value>& values = study.plan.axes()[i].values;
    const bool are_mixed = std::any_of(values.begin(), values.end(), [&](const Value& value) {
      return value.data.index() != values.front().data.index() && !(is_number(value) && is_number(values.front()));
    });
    for (const Value& value : values) {
      if (!are_mixed && std::isfinite(config::as_number(value).value_or(0.0))) continue;
      std::vector<Value> point = study.plan.values(0);
      point[i] = value;
      const config::Document scene = scene_at(study, point);
      Diagnostics diagnostics(scene);
      (void)scene::read_draft(scene, study.catalogue, diagnostics);
      diagnostics.throw_if_any();
    }
  }
}

/// If no scene is given, reads the file named in the study.
Study study_of(const config::Document& document, const config::Document* known_scene, const StudyOptions& options) {
  Diagnostics diagnostics(document);
  Reader reader(document, diagnostics);
  reader.refuse_others();
  reader.check_root();
  const auto p = reader.settings();
  diagnostics.throw_if_any();
  PlanKind kind = kind_of(p->text("plan"));
  std::vector<Axis> axes;
  if (options.points.empty()) {
    axes = reader.axes(kind);
  } else {
    kind = PlanKind::list;
    axes = axes_of_points(options.points);
  }
  const bool is_random = kind == PlanKind::sobol || kind == PlanKind::latin;
  if (is_random && !p->has("count"))
    p->complain(diagnostics, "count", "missing; give the number of points of the plan (integer >= 1)");
  for (const char* key : {"count", "seed"})
    if (!is_random && options.points.empty() && p->given(key))
      p->complain(diagnostics, key, "belongs to plan = \"sobol\" or \"latin\"");
  if (reader.follow() != Follow::no && !p->has("periods"))
    p->complain(
        diagnostics, "periods",
        "missing; with follow every run lasts whole periods: give those that count after settle (integer >= 1)");
  std::vector<Item> items = read_items(*p, diagnostics);
  for (const Item& item : items)
    if (item.kind == Item::Kind::section && !p->has("periods")) {
      p->complain(diagnostics, "periods",
                  "missing; \"" + item.text + "\" needs the number of periods that count (integer >= 1)");
      break;
    }
  for (const Item& item : items)
    if (item.kind == Item::Kind::trust && reader.follow() != Follow::no)
      p->complain(diagnostics, "collect",
                  "names \"trust\", which requires runs that start as the scene states; remove follow");
    else if (item.kind == Item::Kind::trust && !options.horizon)
      p->complain(diagnostics, "collect", "names \"trust\", which only the program `butee study` computes");
  diagnostics.throw_if_any();

  const std::optional<std::uint64_t> seed =
      p->has("seed") ? std::optional<std::uint64_t>(static_cast<std::uint64_t>(p->integer("seed"))) : std::nullopt;
  const auto make_plan = [&] {
    try {
      return Plan(std::move(axes), kind, p->has("count") ? p->integer("count") : 0, seed, reader.follow());
    } catch (const InputError& error) {
      const std::string place = p->given("plan") ? describe(document, p->value("plan").at) : document.sources.front();
      throw InputError(place + ": " + error.what());
    }
  };
  config::Document scene = with_overrides(known_scene != nullptr ? *known_scene : scene_beside(document, diagnostics),
                                          *p, options, axes, diagnostics);
  if (options.points.empty() && !axes.empty()) check_keys(document, scene, axes, p->has("periods"), diagnostics);
  Study study{document, std::move(scene), plugin::Catalogue::with_plugins(options.plugins), make_plan()};
  check_values(study);
  study.settle = p->integer("settle");
  if (p->has("periods")) study.periods = p->integer("periods");
  if (p->has("period")) study.period = p->number("period");
  if (p->has("steady")) study.steady = p->number("steady");
  study.items = std::move(items);
  study.horizon = options.horizon;
  study.stem = std::filesystem::path(document.sources.front()).stem().string();
  if (const Value* title = document.root.table()->find("title"); title != nullptr) study.title = *title->text();
  return study;
}

}  // namespace

Study load_study(const std::string& path, const StudyOptions& options) {
  return study_of(config::load_toml(path), nullptr, options);
}

Study read_study(const config::Document& study, const config::Document& scene, const StudyOptions& options) {
  return study_of(study, &scene, options);
}

}  // namespace butee::study
