#include "butee/scene/read_model.hpp"

#include <algorithm>

#include "butee/core/text.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::Diagnostics;
using config::number;
using config::Parameters;
using config::Value;

namespace {

/// The motion of beams that has a degree of freedom which planar ones lack.
std::string motion_with(DofKind kind) {
  switch (kind) {
    case DofKind::uz:
    case DofKind::ry:
      return "; beams with motion = \"lateral\" or \"spatial\" do";
    case DofKind::ux:
    case DofKind::rx:
      return "; beams with motion = \"spatial\" do";
    default:
      return "";
  }
}

}  // namespace

std::vector<std::string> model_keys() {
  return {"schema", "title",   "material", "section",  "element", "support", "contact",
          "load",   "damping", "initial",  "rotation", "gravity", "base"};
}

Model read_model(const Value& root, const ModelTypes& types, Diagnostics& diagnostics) {
  return SceneReader(root, types, diagnostics).read();
}

std::optional<std::vector<NodeId>> read_nodes(const NodeTable& nodes, const Parameters& parameters,
                                              const std::string& key, Diagnostics& diagnostics) {
  std::vector<NodeId> all;
  bool ok = true;
  for (const std::string& selector : parameters.texts(key)) {
    Selection selection = nodes.select(selector);
    if (!selection.problem.empty()) parameters.complain(diagnostics, key, "\"" + selector + "\": " + selection.problem);
    ok = ok && selection.problem.empty() && !selection.excused;
    all.insert(all.end(), selection.nodes.begin(), selection.nodes.end());
  }
  if (!ok) return std::nullopt;
  if (all.empty()) {
    parameters.complain(diagnostics, key, "names no node");
    return std::nullopt;
  }
  std::vector<std::pair<NodeId, NodeId>> sorted;
  for (const NodeId node : all) sorted.emplace_back(nodes.canonical(node), node);
  std::sort(sorted.begin(), sorted.end());
  const auto twice =
      std::adjacent_find(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  if (twice != sorted.end()) {
    const std::string first = nodes.name(twice->second), second = nodes.name((twice + 1)->second);
    parameters.complain(diagnostics, key,
                        first == second ? "names " + first + " twice"
                                        : "names one node twice: " + first + " and " + second + " are joined");
    return std::nullopt;
  }
  return all;
}

std::optional<NodeId> read_node(const NodeTable& nodes, const Parameters& parameters, const std::string& key,
                                Diagnostics& diagnostics) {
  const auto selected = read_nodes(nodes, parameters, key, diagnostics);
  if (!selected) return std::nullopt;
  if (selected->size() != 1) {
    parameters.complain(diagnostics, key,
                        "names " + std::to_string(selected->size()) + " nodes; exactly one is required");
    return std::nullopt;
  }
  return selected->front();
}

Model SceneReader::read() {
  read_header();
  read_materials();
  read_sections();
  read_elements();
  read_rotation();
  read_supports();
  dofs_.emplace(number_dofs(model_));
  if (diagnostics_.error_count() == 0) check_dofs();
  if (diagnostics_.error_count() == 0) check_magnitudes();
  read_contacts();
  read_loads();
  read_gravity();
  read_damping();
  read_base();
  read_initial();
  read_preload();
  return std::move(model_);
}

void SceneReader::read_header() {
  constexpr std::int64_t kSchema = 1;
  const Value* schema = root_.table()->find("schema");
  if (schema == nullptr)
    diagnostics_.error("schema", root_.at, "missing; a model file starts with schema = 1");
  else if (const auto* version = std::get_if<std::int64_t>(&schema->data); version == nullptr || *version != kSchema)
    diagnostics_.error("schema", *schema, "must be 1, the only schema that this version reads");
  if (const Value* title = root_.table()->find("title")) {
    if (title->text() == nullptr)
      diagnostics_.error("title", *title, std::string("must be a string, not ") + title->kind());
    else
      model_.title = *title->text();
  }
}

void SceneReader::read_materials() {
  const Value* tables = root_.table()->find("material");
  if (tables == nullptr) return;
  if (tables->table() == nullptr) return diagnostics_.error("material", *tables, "must be tables [material.NAME]");
  for (const auto& [name, entry] : tables->table()->entries) {
    const auto p = read_parameters(
        entry, "material." + name,
        {number("young_modulus", "Pa", "Young's modulus").above(0), number("density", "kg/m3", "the density").above(0),
         number("poisson_ratio", "1", "Poisson's ratio").above(-1).at_most(0.5).optional(),
         number("shear_modulus", "Pa", "the shear modulus, instead of poisson_ratio").above(0).optional()},
        diagnostics_);
    auto& material = materials_[name];
    if (!p) continue;
    if (p->has("poisson_ratio") && p->has("shear_modulus")) {
      p->complain(diagnostics_, "shear_modulus", "conflicts with poisson_ratio; give one of the two");
      continue;
    }
    material = Material{p->number("young_modulus"), p->number("density")};
    if (p->has("poisson_ratio"))
      material->shear_modulus = 0.5 * material->young_modulus / (1.0 + p->number("poisson_ratio"));
    if (p->has("shear_modulus")) material->shear_modulus = p->number("shear_modulus");
  }
}

void SceneReader::read_sections() {
  const Value* tables = root_.table()->find("section");
  if (tables == nullptr) return;
  if (tables->table() == nullptr) return diagnostics_.error("section", *tables, "must be tables [section.NAME]");
  for (const auto& [name, entry] : tables->table()->entries) {
    const std::string path = "section." + name;
    auto& section = sections_[name];
    const auto shape = type_of(entry, path, "shape", type_names(types_.sections));
    if (!shape) continue;
    const SectionType& type = *find_type(types_.sections, *shape);
    if (const auto p = read_parameters(entry, path, type.parameters, diagnostics_, {"shape"}))
      section = type.make(*p, diagnostics_);
  }
}

void SceneReader::read_supports() {
  const DofTable dofs = number_dofs(model_);
  for (const auto& [entry, path] : entries("support")) {
    const auto p = read_table(
        *entry, path,
        {config::texts("nodes", "the nodes held"), config::texts("fix", "the displacements held").one_of(dof_names())});
    if (!p) continue;
    const auto nodes = select(*p, "nodes");
    if (p->texts("fix").empty())
      p->complain(diagnostics_, "fix", "holds nothing; name \"u\", \"theta\" or others of ux ... rz");
    if (!nodes) continue;
    for (const std::string& kind : p->texts("fix")) {
      std::vector<NodeId> lacking;
      for (const NodeId node : *nodes)
        if (const NodalDof dof{node, *dof_named(kind)}; dofs.exists(dof))
          model_.fixed.push_back(dof);
        else
          lacking.push_back(node);
      if (lacking.empty() || lacks_elements_) continue;
      const std::string others = lacking.size() > 1 ? ", nor have " + std::to_string(lacking.size() - 1) + " more" : "";
      p->complain(diagnostics_, "fix",
                  model_.nodes.name(lacking.front()) + " has no " + kind + others + ": no element there uses it" +
                      motion_with(*dof_named(kind)));
    }
  }
}

void SceneReader::check_dofs() {
  for (const NodalDof& dof : dofs_->free()) {
    if (dofs_->has_mass(dof)) continue;
    for (std::size_t i = 0; i < model_.elements.size(); ++i) {
      DofTable claims(model_.nodes);
      model_.elements[i]->claim(claims);
      if (!claims.exists(dof)) continue;
      diagnostics_.error(element_places_[i].first, element_places_[i].second,
                         "the free " + dofs_->name(dof) +
                             " has no mass, so its motion is undetermined: give the node a " +
                             (dof.kind == DofKind::rx ? "disc with polar_inertia"
                              : is_rotation(dof.kind) ? "mass with rotary_inertia"
                                                      : "mass") +
                             ", or fix it with a [[support]]");
      break;
    }
  }
  if (dofs_->free_count() == 0)
    diagnostics_.error("element", root_.at, "nothing can move: the scene has no free degree of freedom");
}

void SceneReader::check_free(const Parameters& parameters, const std::string& key, NodalDof dof, const char* what) {
  if (!dofs_->exists(dof)) {
    if (!lacks_elements_)
      parameters.complain(diagnostics_, parameters.given("dof") ? "dof" : key,
                          dofs_->name(dof) + " does not exist: no element there uses it" + motion_with(dof.kind));
  } else if (dofs_->is_fixed(dof)) {
    parameters.complain(
        diagnostics_, key,
        dofs_->name(dof) + " is fixed by a [[support]], so " + what + " there has no effect; remove one of the two");
  }
}

std::vector<std::pair<const Value*, std::string>> SceneReader::entries(const std::string& key) {
  std::vector<std::pair<const Value*, std::string>> list;
  const Value* value = root_.table()->find(key);
  if (value == nullptr) return list;
  const config::Array* array = value->array();
  if (array == nullptr) {
    diagnostics_.error(key, *value, "must be an array of tables: write [[" + key + "]]");
    return list;
  }
  for (std::size_t i = 0; i < array->size(); ++i) list.emplace_back(&(*array)[i], key + "[" + std::to_string(i) + "]");
  return list;
}

std::optional<std::string> SceneReader::type_of(const Value& entry, const std::string& path, const std::string& key,
                                                const std::vector<std::string>& known, const char* fallback) {
  if (entry.table() == nullptr) {
    diagnostics_.error(path, entry, std::string("must be a table, not ") + entry.kind());
    return std::nullopt;
  }
  const Value* value = entry.table()->find(key);
  if (value == nullptr && fallback != nullptr) return fallback;
  const std::string choices = "one of \"" + join(known, "\", \"") + "\"";
  if (value == nullptr) {
    diagnostics_.error(path + "." + key, entry.at, "missing; give " + choices);
    return std::nullopt;
  }
  const std::string* name = value->text();
  if (name == nullptr || std::find(known.begin(), known.end(), *name) == known.end()) {
    diagnostics_.error(path + "." + key, *value,
                       "must be " + choices + (name != nullptr ? suggestion(*name, known) : ""));
    return std::nullopt;
  }
  return *name;
}

std::optional<Parameters> SceneReader::read_table(const Value& entry, const std::string& path,
                                                  const std::vector<config::Parameter>& declared,
                                                  const std::vector<std::string>& ignored) {
  auto p = read_parameters(entry, path, declared, diagnostics_, ignored);
  if (p || entry.table() == nullptr) return p;
  for (const config::Parameter& parameter : declared) {
    const Value* given = entry.table()->find(parameter.name);
    if (given == nullptr || !parameter.complaint(*given).empty()) continue;
    Parameters alone;
    alone.place(path, entry.at);
    alone.set(parameter.name, *given, true);
    if (parameter.name == "node") select_one(alone, "node");
    if (parameter.name == "nodes") select(alone, "nodes");
  }
  return std::nullopt;
}

std::optional<std::vector<NodeId>> SceneReader::select(const Parameters& parameters, const std::string& key) {
  return read_nodes(model_.nodes, parameters, key, diagnostics_);
}

std::optional<NodeId> SceneReader::select_one(const Parameters& parameters, const std::string& key) {
  return read_node(model_.nodes, parameters, key, diagnostics_);
}

}  // namespace butee::scene
