#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::number;
using config::Parameters;
using config::text;
using config::Value;

namespace {

Sides sides_of(const std::string& name) {
  if (name == "positive") return Sides::positive;
  return name == "negative" ? Sides::negative : Sides::both;
}

}  // namespace

void SceneReader::read_contacts() {
  for (const auto& [entry, path] : entries("contact")) read_contact(*entry, path);
}

void SceneReader::read_contact(const Value& entry, const std::string& path) {
  const bool is_stop = type_of(entry, path, "type", {"stop"}).has_value();
  if (entry.table() == nullptr) return;
  const auto law_name = type_of(entry, path, "law", type_names(types_.laws), "linear");
  const LawType* law = law_name ? find_type(types_.laws, *law_name) : nullptr;

  std::vector<config::Parameter> declared = {
      config::texts("nodes", "the nodes that meet a fixed stop").optional(),
      config::texts("between", "two selectors: stops on u_a - u_b, pair by pair").optional(),
      number("gap", "m", "the free play on each side").at_least(0),
      text("sides", "the sides that have a stop").one_of({"both", "positive", "negative"}).or_else("both")};
  std::vector<std::string> ignored = {"type", "law"};
  if (law != nullptr) {
    declared.insert(declared.end(), law->parameters.begin(), law->parameters.end());
  } else {
    for (const LawType& any : types_.laws)
      for (const std::string& name : names_of(any.parameters)) ignored.push_back(name);
  }
  const auto p = read_table(entry, path, declared, ignored);
  if (!p) return;
  if (p->has("nodes") == p->has("between")) {
    diagnostics_.error(path, entry.at,
                       p->has("nodes") ? "has both nodes and between; give one of them"
                                       : "give nodes (stops to ground) or between (stops between two bodies)");
    return;
  }
  StopGroup group;
  if (law != nullptr) group.law = law->make(*p, diagnostics_);
  group.gap = p->number("gap");
  group.sides = sides_of(p->text("sides"));
  if (p->has("between")) {
    read_pairs(*p, group);
  } else if (const auto nodes = select(*p, "nodes")) {
    group.a = *nodes;
    for (const NodeId node : group.a)
      if (!dofs_->exists({node, DofKind::u}) && !lacks_elements_)
        p->complain(diagnostics_, "nodes",
                    dofs_->name({node, DofKind::u}) + " does not exist: no element there uses it");
  }
  if (is_stop && group.law != nullptr) model_.stops.push_back(std::move(group));
}

void SceneReader::read_pairs(const Parameters& parameters, StopGroup& group) {
  const auto selectors = parameters.texts("between");
  if (selectors.size() != 2)
    return parameters.complain(diagnostics_, "between",
                               "must hold two selectors, such as [\"rotor:3..9\", \"casing:3..9\"]");
  const Selection a = model_.nodes.select(selectors[0]), b = model_.nodes.select(selectors[1]);
  for (const auto& [selection, selector] : {std::pair(&a, &selectors[0]), std::pair(&b, &selectors[1])})
    if (!selection->problem.empty())
      parameters.complain(diagnostics_, "between", "\"" + *selector + "\": " + selection->problem);
  if (a.nodes.empty() || b.nodes.empty()) return;
  if (a.nodes.size() != b.nodes.size())
    return parameters.complain(diagnostics_, "between",
                               "pairs nodes one by one, but the first selector names " +
                                   std::to_string(a.nodes.size()) + " and the second " +
                                   std::to_string(b.nodes.size()));
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    if (model_.nodes.canonical(a.nodes[i]) == model_.nodes.canonical(b.nodes[i]))
      return parameters.complain(diagnostics_, "between",
                                 model_.nodes.name(a.nodes[i]) + " and " + model_.nodes.name(b.nodes[i]) +
                                     " are one node, which has no motion against itself");
    for (const NodeId node : {a.nodes[i], b.nodes[i]})
      if (!dofs_->exists({node, DofKind::u}) && !lacks_elements_)
        return parameters.complain(diagnostics_, "between",
                                   dofs_->name({node, DofKind::u}) + " does not exist: no element there uses it");
  }
  group.a = a.nodes;
  group.b = b.nodes;
}

}  // namespace butee::scene
