#include "study.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <butee/config/override.hpp>
#include <butee/config/parameters.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <butee/study/study.hpp>

namespace butee::app::compare {
namespace {

using config::Diagnostics;
using config::Parameter;
using config::Parameters;
using config::Table;
using config::Value;

/// Largest number of halvings of a fixed step; successive tolerances differ by the factor sqrt(10).
constexpr int kMostHalvings = 18;
const double kToleranceRatio = std::sqrt(10.0);
/// Initial step of an adaptive method if the scene does not set it, s.
constexpr double kFirstStep = 1e-5;
/// Number of steps in the coarsest run of an unconditionally stable method.
constexpr double kFewestSteps = 200.0;
/// Coarsest step of a conditionally stable method, as a fraction of its stability limit.
constexpr double kSafeStep = 0.95;

std::vector<Parameter> study_parameters() {
  return {
      config::text("title", "the title of the report").or_else(std::string()),
      config::texts("scenes", "the model files, beside the study"),
      config::texts("set", "overrides for every scene: KEY=VALUE").optional(),
      config::texts("quantity", "the compared columns of history.csv; the worst one counts for a run").optional(),
      config::number("end_time", "s", "the end of every run").above(0).optional(),
      config::numbers("end_times", "s", "the end of the runs of each scene, instead of end_time").above(0).optional(),
      config::numbers("targets", "1", "relative rms errors for which the fastest method is reported")
          .above(0)
          .optional(),
      config::number("time_limit", "s", "the longest single run").above(0).or_else(2.0),
      config::text("reference", "a CSV file with columns t and the quantities").or_else(std::string()),
      config::table("method", "[[study.method]]: the methods; default: all that are found").optional()};
}

std::string beside(const std::string& study, const std::string& file) {
  return (std::filesystem::path(study).parent_path() / file).string();
}

Sweep read_sweep(const Value& table, const std::string& path, const plugin::Catalogue& catalogue,
                 Diagnostics& diagnostics) {
  Sweep sweep;
  const auto p = read_parameters(
      table, path,
      {config::text("type", "the method").one_of(catalogue.integrator_names()),
       config::text(
           "sweep",
           "the key that takes the values; default: that of the method; \"none\": a single run as the scene is written")
           .optional(),
       config::numbers("values", "", "its values, from coarse to fine").above(0).optional(),
       config::table("with", "further keys of [integrator] for this method").optional()},
      diagnostics);
  if (!p) return sweep;
  sweep.method = catalogue.find(p->text("type"))->declaration.name;
  if (p->has("sweep")) sweep.knob = p->text("sweep");
  sweep.as_written = sweep.knob == "none";
  if (sweep.as_written) sweep.knob.clear();
  if (p->has("values")) sweep.values = p->numbers("values");
  if (p->has("values") && sweep.values.empty())
    p->complain(diagnostics, "values", "is empty; give at least one value, or remove the key");
  if (!sweep.values.empty() && sweep.knob.empty() && !sweep.as_written)
    p->complain(diagnostics, "sweep", "is missing: values require a key that takes them");
  if (const Value* with = table.table()->find("with"); with != nullptr && with->table() != nullptr)
    sweep.settings = *with->table();
  return sweep;
}

Study read_study_file(const config::Document& document, const ModelArguments& arguments) {
  Diagnostics diagnostics(document);
  Study study;
  const Table& root = *document.root.table();
  read_parameters(document.root, "", {config::integer("schema", "").at_least(1).at_most(1), config::table("study", "")},
                  diagnostics);
  const auto p = read_parameters(*root.find("study"), "study", study_parameters(), diagnostics);
  diagnostics.throw_if_any();
  study.title = p->text("title");
  for (const std::string& scene : p->texts("scenes")) study.scenes.push_back(beside(arguments.model, scene));
  if (p->has("set")) study.overrides = p->texts("set");
  if (p->has("quantity")) study.quantities = p->texts("quantity");
  if (p->has("end_time")) study.end_time = p->number("end_time");
  if (p->has("end_times")) {
    study.end_times = p->numbers("end_times");
    if (study.end_times.size() != study.scenes.size() || study.end_time)
      p->complain(diagnostics, "end_times",
                  "must hold one value for each of the " + std::to_string(study.scenes.size()) +
                      " scenes, and replaces end_time");
  }
  if (p->has("targets")) study.targets = p->numbers("targets");
  if (study.scenes.empty()) p->complain(diagnostics, "scenes", "is empty; name at least one model file");
  if (study.targets.empty())
    p->complain(diagnostics, "targets", "is empty; give relative errors such as 1e-3, or remove the key");
  study.time_limit = p->number("time_limit");
  if (!p->text("reference").empty()) study.reference_file = beside(arguments.model, p->text("reference"));
  const plugin::Catalogue catalogue = plugin::Catalogue::with_plugins(arguments.plugins);
  if (const Value* methods = root.find("study")->table()->find("method"); methods != nullptr && methods->array())
    for (std::size_t i = 0; i < methods->array()->size(); ++i)
      study.sweeps.push_back(
          read_sweep((*methods->array())[i], "study.method[" + std::to_string(i) + "]", catalogue, diagnostics));
  diagnostics.throw_if_any();
  return study;
}

const Parameter* knob_of(const time::IntegratorType& type) {
  for (const Parameter& parameter : type.parameters)
    if (parameter.swept) return &parameter;
  return nullptr;
}

std::vector<double> tolerance_values(const Parameter& knob) {
  std::vector<double> values;
  for (double value = knob.swept->first; value > knob.swept->second * 0.99; value /= kToleranceRatio)
    values.push_back(std::max(value, knob.swept->second));  // rounding may fall below the bound
  return values;
}

std::vector<double> step_values(double limit, double highest_frequency, double end_time) {
  double step = end_time / kFewestSteps;
  if (std::isfinite(limit) && highest_frequency > 0.0) step = std::min(step, kSafeStep * limit / highest_frequency);
  std::vector<double> values;
  for (int i = 0; i <= kMostHalvings; ++i, step *= 0.5) values.push_back(step);
  return values;
}

}  // namespace

Study read_study(const ModelArguments& arguments) {
  const config::Document document = config::load_toml(arguments.model);
  Study study;
  if (study::is_study(document))
    throw InputError(arguments.model +
                     ": is a study of many runs, which is `butee study`; a comparison of methods has "
                     "[study] with scenes");
  if (document.root.table()->find("study") != nullptr)
    study = read_study_file(document, arguments);
  else
    study.scenes = {arguments.model};
  study.overrides.insert(study.overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
  return study;
}

std::vector<Sweep> complete_sweeps(const Study& study, plugin::Catalogue& catalogue, double highest_frequency,
                                   double end_time) {
  std::vector<Sweep> sweeps = study.sweeps;
  if (sweeps.empty())
    for (const auto& entry : catalogue.integrators()) sweeps.push_back({entry.declaration.name, "", false, {}, {}});
  for (Sweep& sweep : sweeps) {
    if (sweep.as_written) sweep.values = {0.0};
    if (!sweep.values.empty()) continue;
    const time::IntegratorType& type = catalogue.load(sweep.method);
    const Parameter* knob = knob_of(type);
    if (!sweep.knob.empty() && sweep.knob != "time_step" && (knob == nullptr || knob->name != sweep.knob))
      throw InputError("study.method: values are missing for " + sweep.knob + " of " + sweep.method +
                       ", which has no sweep of its own");
    if (knob != nullptr && sweep.knob != "time_step") {
      sweep.knob = knob->name;
      sweep.values = tolerance_values(*knob);
    } else if (type.fixed_step || sweep.knob == "time_step") {
      sweep.knob = "time_step";
      sweep.values = step_values(type.stability_limit, highest_frequency, end_time);
    } else {
      sweep.as_written = true;  // nothing to sweep
      sweep.values = {0.0};
    }
  }
  return sweeps;
}

config::Document with_method(const config::Document& scene, const time::IntegratorType& type, const Sweep& sweep,
                             double value) {
  config::Document document = scene;
  Table& root = *document.root.table();
  const Table before = *root["integrator"].table();
  // Keys directly in [integrator] belong to the scene's own method; another's `tolerance` differs in meaning.
  const Value* own_type = before.find("type");
  const std::string chosen = own_type != nullptr && own_type->text() != nullptr ? *own_type->text() : "auto";
  const bool is_own =
      chosen == type.name || std::find(type.aliases.begin(), type.aliases.end(), chosen) != type.aliases.end();
  const auto of_scene = [&](const std::string& key) -> const Value* {
    for (const std::string* name : {&type.name, type.aliases.empty() ? &type.name : &type.aliases.front()})
      if (const Value* own = before.find(*name); own != nullptr && own->table() != nullptr)
        if (const Value* found = own->table()->find(key)) return found;
    return is_own || key == "time_step" || key == "end_time" ? before.find(key) : nullptr;
  };
  Table integrator;
  integrator["type"] = Value(type.name);
  if (const Value* found = of_scene("end_time")) integrator["end_time"] = *found;
  const Value* step = of_scene("time_step");
  if (step != nullptr && (is_own || !type.finds_first_step))
    integrator["time_step"] = *step;
  else if (!type.finds_first_step)
    integrator["time_step"] = Value(kFirstStep);
  for (const Parameter& parameter : type.parameters) {
    if (const Value* found = of_scene(parameter.name))
      integrator[parameter.name] = *found;
    else if (parameter.required && parameter.first_try)
      integrator[parameter.name] = *parameter.first_try;
  }
  for (const Table::Entry& entry : sweep.settings.entries) integrator[entry.first] = entry.second;
  if (!sweep.knob.empty()) integrator[sweep.knob] = Value(value);
  root["integrator"] = Value(std::move(integrator));
  return document;
}

}  // namespace butee::app::compare
