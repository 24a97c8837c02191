#include "butee/model/element_choice.hpp"

#include <algorithm>
#include <optional>

#include "butee/core/text.hpp"
#include "butee/model/parts_at.hpp"

namespace butee::model {
namespace {

/// "string:17" as "string" and 17; the number is -1 if there is none.
struct PartName {
  std::string element;
  Index part = -1;
};

std::optional<PartName> parse(const std::string& text) {
  const auto colon = text.find(':');
  PartName name{text.substr(0, colon)};
  if (colon == std::string::npos) return name;
  name.part = whole_number<Index>(std::string_view(text).substr(colon + 1)).value_or(-1);
  if (name.part < 0) return std::nullopt;
  return name;
}

std::vector<std::string> names_where(const Model& model, const auto& wanted) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < model.elements.size(); ++i)
    if (const std::string& name = element_name(model, i); !name.empty() && wanted(i)) names.push_back(name);
  return names;
}

std::string known_beams(const Model& model) {
  const auto beams = names_where(model, [&](std::size_t i) { return !model.elements[i]->axis().empty(); });
  return beams.empty() ? "" : "; known: " + join(beams);
}

CutChoice refused(std::string problem) {
  return {nullptr, 0, true, std::move(problem)};
}

/// A beam that the node belongs to, and the node's position in it.
struct Place {
  std::size_t element;
  std::vector<NodeId> axis;
  Index at;
};

std::vector<Place> places_of(const Model& model, NodeId node) {
  std::vector<Place> places;
  const NodeId wanted = model.nodes.canonical(node);
  for (std::size_t i = 0; i < model.elements.size(); ++i) {
    auto axis = model.elements[i]->axis();
    const auto found =
        std::find_if(axis.begin(), axis.end(), [&](NodeId other) { return model.nodes.canonical(other) == wanted; });
    if (found != axis.end()) places.push_back({i, axis, found - axis.begin()});
  }
  return places;
}

CutChoice cut_at(const Model& model, const Place& place, NodeId node, Index part) {
  const Index last = std::ssize(place.axis) - 2;
  if (part < 0) part = std::max<Index>(place.at - 1, 0);
  const std::string& name = element_name(model, place.element);
  if (part > last)
    return refused("\"" + name + "\" has the elements " + name + ":0 to " + name + ":" + std::to_string(last));
  if (part != place.at && part + 1 != place.at)
    return refused(name + ":" + std::to_string(part) + " does not end at " + model.nodes.name(node) + "; name " +
                   (place.at > 0 ? name + ":" + std::to_string(place.at - 1) : "") +
                   (place.at > 0 && place.at <= last ? " or " : "") +
                   (place.at <= last ? name + ":" + std::to_string(place.at) : ""));
  return {model.elements[place.element].get(), part, part + 1 == place.at, ""};
}

/// The reason why a section force or stress is not known at the end of a part, or "".
std::string cut_problem(Quantity quantity, const SectionCut& cut) {
  const auto has = [&](Index row) { return !cut.resultants.row(row).isZero(0.0); };
  const bool needs_modulus = quantity == Quantity::bending_stress || quantity == Quantity::von_mises;
  if (needs_modulus && !cut.modulus)
    return "the section of the beam has no outer fibre; give outer_fibre (m) beside second_moment";
  const auto row = resultant_row(quantity);
  if (row && !has(*row) && !(*row == 0 && cut.preload != 0.0))
    return *row == 0 || *row == 3 ? "the beam has no such motion; write motion = \"spatial\""
                                  : "the beam has no such motion; write motion = \"lateral\" or \"spatial\"";
  if (quantity != Quantity::von_mises || !has(4)) return "";
  if (has(3) && !cut.torsion_modulus)
    return "the stress of torsion is available only for round sections (tube, circle); bending_stress is that of "
           "bending along u";
  if (!cut.modulus_y) return "the section of the beam has no outer fibre along z; give outer_fibre_z (m)";
  return "";
}

}  // namespace

const std::string& element_name(const Model& model, std::size_t element) {
  static const std::string none;
  return element < model.element_names.size() ? model.element_names[element] : none;
}

CutChoice choose_cut(const Model& model, NodeId node, const std::string& element) {
  const auto named = parse(element);
  if (!named) return refused("write the name of a beam, such as string, or of one of its elements, such as string:17");
  const std::vector<Place> places = places_of(model, node);
  const std::string& wanted = element.empty() ? model.nodes.group_of(node).name : named->element;
  for (const Place& place : places)
    if (!wanted.empty() && element_name(model, place.element) == wanted) return cut_at(model, place, node, named->part);
  if (element.empty()) {
    if (places.size() == 1) return cut_at(model, places.front(), node, -1);
    if (places.empty())
      return refused(model.nodes.name(node) + " belongs to no beam, and only beams have section forces");
    std::vector<std::string> names;
    for (const Place& place : places) names.push_back(element_name(model, place.element));
    return refused(model.nodes.name(node) + " belongs to several beams; name one of them by element: " + join(names));
  }
  const auto beams = names_where(model, [&](std::size_t i) { return !model.elements[i]->axis().empty(); });
  if (std::find(beams.begin(), beams.end(), named->element) != beams.end())
    return refused(model.nodes.name(node) + " does not belong to the beam " + named->element);
  return refused("there is no beam \"" + named->element + "\"" + suggestion(named->element, beams) +
                 known_beams(model));
}

bool is_spring_on(const Model& model, std::size_t element, NodalDof dof, const std::string& name) {
  const Element& one = *model.elements[element];
  if (!one.is_spring() || (!name.empty() && element_name(model, element) != name)) return false;
  bool found = false;
  PartsAt parts(model.nodes, dof, [&](const auto&, const auto&, Index) { found = true; });
  one.assemble(parts);
  return found;
}

std::optional<Index> resultant_row(Quantity quantity) {
  switch (quantity) {
    case Quantity::normal_force:
      return 0;
    case Quantity::shear_force:
    case Quantity::shear_y:
      return 1;
    case Quantity::shear_z:
      return 2;
    case Quantity::torque:
      return 3;
    case Quantity::moment_y:
      return 4;
    case Quantity::bending_moment:
    case Quantity::moment_z:
    case Quantity::bending_stress:
      return 5;
    default:
      return std::nullopt;
  }
}

DofKind contact_kind(const Model& model, NodeId node, Quantity quantity) {
  if (quantity != Quantity::contact_force) return kind_of(quantity);
  std::optional<DofKind> first;
  bool is_on_u = false;
  const auto note = [&](const std::vector<NodeId>& ends, DofKind kind) {
    const bool is_here = std::any_of(ends.begin(), ends.end(), [&](NodeId end) {
      return model.nodes.canonical(end) == model.nodes.canonical(node);
    });
    if (!is_here) return;
    if (!first) first = kind;
    is_on_u = is_on_u || kind == DofKind::uy;
  };
  for (const StopGroup& group : model.stops)
    for (const auto& ends : {group.a, group.b}) note(ends, group.dof);
  for (const ObstacleGroup& group : model.obstacles)
    for (const DofKind kind : group.directions)
      for (const auto& ends : {group.a, group.b}) note(ends, kind);
  return is_on_u || !first ? DofKind::uy : *first;
}

const char* unit_at(const Model& model, NodeId node, Quantity quantity) {
  const bool is_moment = quantity == Quantity::contact_force && is_rotation(contact_kind(model, node, quantity));
  return unit_of(is_moment ? Quantity::contact_rz : quantity);
}

std::string why_not(Quantity quantity, const Model& model, const DofTable& dofs, NodeId node,
                    const std::string& element) {
  const NodalDof dof{node, contact_kind(model, node, quantity)};
  const std::string none = std::string("there is no ") + name_of(quantity) + ": ";
  if (is_absolute(quantity) && model.bases.empty())
    return none + "the base does not move, so that u, v and a are those in space; give [base], or request these";
  if (is_absolute(quantity) && !knows_base_motion(model))
    return none + "only a base motion of type harmonic, constant, ramp or table can be integrated";
  switch (source_of(quantity)) {
    case Source::section: {
      const CutChoice choice = choose_cut(model, node, element);
      if (choice.beam == nullptr) return none + choice.problem;
      const std::string problem = cut_problem(quantity, *choice.beam->cut(choice.part, choice.at_end));
      return problem.empty() ? "" : none + problem;
    }
    case Source::springs: {
      const auto acts = [&](std::size_t i, const std::string& name) { return is_spring_on(model, i, dof, name); };
      for (std::size_t i = 0; i < model.elements.size(); ++i)
        if (acts(i, element)) return "";
      const auto known = names_where(model, [&](std::size_t i) { return acts(i, ""); });
      return none + (element.empty() ? "no spring" : "no spring \"" + element + "\"") + " acts on " + dofs.name(dof) +
             suggestion(element, known) + (known.empty() ? "" : "; known there: " + join(known));
    }
    case Source::support:
      if (!dofs.exists(dof)) return none + dofs.name(dof) + " does not exist";
      return dofs.is_fixed(dof) ? "" : none + dofs.name(dof) + " is free, held by no [[support]]";
    case Source::contacts: {
      const auto has = [&](const std::vector<NodeId>& ends) {
        return std::any_of(ends.begin(), ends.end(),
                           [&](NodeId end) { return model.nodes.canonical(end) == model.nodes.canonical(node); });
      };
      for (const ObstacleGroup& group : model.obstacles)
        if (has(group.a) || has(group.b)) return "";
      return none + "no contact in the plane, with dissipation or friction, is on " + model.nodes.name(node) +
             "; contact_force, contact_ux ... contact_rz are those of elastic stops, too";
    }
    case Source::motion:
    case Source::stops:
      break;
  }
  return dofs.exists(dof) ? "" : none + dofs.name(dof) + " does not exist";
}

}  // namespace butee::model
