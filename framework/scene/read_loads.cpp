#include <algorithm>

#include "butee/core/text.hpp"
#include "butee/scene/keys_of_others.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::Parameters;
using config::Value;

namespace {

/// The unit of the values of a load.
constexpr const char* kOfLoads = "N";
const std::vector<std::string> kDirections = {"u", "w", "ux", "uy", "uz"};

}  // namespace

void SceneReader::read_loads() {
  for (const auto& [entry, path] : entries("load")) read_load(*entry, path);
}

void SceneReader::read_load(const Value& entry, const std::string& path) {
  std::vector<std::string> known = type_names(types_.loads);
  known.emplace_back("distributed");
  const auto type = type_of(entry, path, "type", known);
  if (entry.table() == nullptr) return;
  if (type == "distributed") return read_distributed(entry, path);
  if (type == "unbalance" && entry.table()->find("speed") == nullptr) return read_turning_unbalance(entry, path);

  auto in_time = type ? read_in_time(entry, path, {"node", "dof"}, kOfLoads) : nullptr;
  std::vector<std::string> in_time_keys;
  for (const auto& [key, value] : entry.table()->entries)
    if (key != "node" && key != "dof") in_time_keys.push_back(key);
  const auto p = read_table(entry, path,
                            {config::text("node", "the loaded node"),
                             config::text("dof", "the loaded degree of freedom").one_of(dof_names()).or_else("u")},
                            in_time_keys);
  if (!p) return;
  const auto node = select_one(*p, "node");
  if (!node) return;
  const NodalDof dof{*node, *dof_named(p->text("dof"))};
  check_free(*p, "node", dof, "a load");
  if (in_time != nullptr) model_.loads.push_back({{{dof, 1.0}}, std::move(in_time), nullptr, 0.0});
}

void SceneReader::read_turning_unbalance(const Value& entry, const std::string& path) {
  const auto p = read_table(entry, path,
                            {config::text("node", "the node that carries the unbalance"),
                             config::number("moment", "kg m", "mass times eccentricity"),
                             config::number("phase", "rad", "the angle from y at t = 0").or_else(0.0)},
                            {"type", "dof"});
  if (!p) return;
  const auto node = select_one(*p, "node");
  if (root_.table()->find("rotation") == nullptr)
    return diagnostics_.error(
        path + ".speed", entry.at,
        "missing; give the speed of rotation (number, rad/s), or [rotation] with the speed of the "
        "shaft that carries the unbalance");
  if (const Value* dof = entry.table()->find("dof"))
    return diagnostics_.error(path + ".dof", *dof,
                              "belongs to an unbalance with speed; one that turns with [rotation] acts along y and z; "
                              "remove dof");
  if (!node || model_.rotation == nullptr) return;
  bool acts = false;
  for (const auto& [kind, along] :
       {std::pair(DofKind::uy, TurningUnbalance::Along::y), std::pair(DofKind::uz, TurningUnbalance::Along::z)}) {
    const NodalDof dof{*node, kind};
    if (!dofs_->exists(dof) || dofs_->is_fixed(dof)) continue;
    acts = true;
    model_.loads.push_back(
        {{{dof, 1.0}},
         std::make_unique<TurningUnbalance>(*model_.rotation, p->number("moment"), p->number("phase"), along),
         nullptr,
         0.0});
  }
  if (!acts && !lacks_elements_)
    p->complain(diagnostics_, "node", "neither uy nor uz of " + model_.nodes.name(*node) + " is free to move");
}

void SceneReader::read_distributed(const Value& entry, const std::string& path) {
  const auto p =
      read_parameters(entry, path,
                      {config::text("beam", "the loaded beam"), config::number("value", "N/m", "the load per length"),
                       config::text("dof", "the displacement that it acts along").one_of(kDirections).or_else("u"),
                       config::table("in_time", "a factor in time").optional()},
                      diagnostics_, {"type"});
  if (!p) return;
  std::unique_ptr<TimeFunction> in_time;
  if (p->has("in_time")) {
    in_time = read_in_time(p->value("in_time"), path + ".in_time", {}, "1");
  } else {
    config::Table unity;
    unity["value"] = Value(1.0);
    in_time = find_type(types_.loads, "constant")
                  ->make(config::make_parameters(find_type(types_.loads, "constant")->parameters, unity), diagnostics_);
  }
  const std::string& name = p->text("beam");
  const auto named = std::find_if(named_elements_.begin(), named_elements_.end(),
                                  [&](const auto& element) { return element.first == name; });
  std::vector<NodalValue> pattern;
  const bool is_read = named != named_elements_.end();
  const DofKind along = *dof_named(p->text("dof"));
  const bool is_loaded = is_read && named->second->add_line_load(pattern, along);
  if (is_read && !named->second->axis().empty() && !is_loaded)
    return p->complain(diagnostics_, "dof",
                       std::string("\"") + name_of(along) + "\" is not a displacement that " + name + " has");
  if (!is_loaded) {
    const bool was_reported = !is_read && (model_.nodes.find(name) != nullptr || model_.nodes.select(name).excused);
    if (was_reported) return;
    std::vector<std::string> beams;
    for (const auto& [beam, element] : named_elements_)
      if (std::vector<NodalValue> any; element->add_line_load(any)) beams.push_back(beam);
    return p->complain(diagnostics_, "beam",
                       (is_read ? "is not a beam" : "there is no such beam" + suggestion(name, beams)) +
                           (beams.empty() ? "" : "; known: " + butee::join(beams)));
  }
  for (NodalValue& nodal : pattern) nodal.value *= p->number("value");
  if (in_time != nullptr)
    model_.loads.push_back({std::move(pattern), std::move(in_time), named->second, p->number("value"), along});
}

std::unique_ptr<TimeFunction> SceneReader::read_in_time(const Value& entry, const std::string& path,
                                                        const std::vector<std::string>& ignored, const char* unit) {
  const auto name = type_of(entry, path, "type", type_names(types_.loads));
  if (!name) return nullptr;
  const LoadType& type = *find_type(types_.loads, *name);
  std::vector<std::string> skipped = ignored;
  skipped.emplace_back("type");
  for (const std::string& key : names_of(type.parameters)) skipped.push_back(key);
  report_keys_of_others(entry, path, "type = \"" + *name + "\"", types_.loads, skipped, diagnostics_);
  std::vector<config::Parameter> declared = type.parameters;
  for (config::Parameter& parameter : declared) {
    if (parameter.unit != kOfLoads || unit == std::string(kOfLoads)) continue;
    parameter.unit = unit;
    parameter.help = parameter.help.substr(0, parameter.help.find(" (N m on"));
  }
  const auto p = read_parameters(entry, path, declared, diagnostics_, skipped);
  return p ? type.make(*p, diagnostics_) : nullptr;
}

}  // namespace butee::scene
