#include "contact_places.hpp"

#include <algorithm>
#include <map>

namespace butee::app::plot {
namespace {

bool holds(const model::NodeTable& nodes, const std::vector<model::NodeId>& some, model::NodeId wanted) {
  return std::any_of(some.begin(), some.end(),
                     [&](model::NodeId node) { return nodes.canonical(node) == nodes.canonical(wanted); });
}

/// x of the nodes of all beams, by canonical number. A beam that shares a node with an earlier one continues
/// there. Empty if a beam lies in another direction.
std::map<model::NodeId, double> along_x(const model::NodeTable& nodes) {
  std::map<model::NodeId, double> places;
  for (const std::string& name : nodes.group_names()) {
    const model::NodeGroup& group = *nodes.find(name);
    if (group.lone()) continue;
    if (group.direction != std::array{1.0, 0.0, 0.0}) return {};
    double begin = group.origin[0];
    for (model::NodeId i = 0; i < group.size(); ++i)
      if (const auto known = places.find(nodes.canonical(group.first + i)); known != places.end()) {
        begin = known->second - group.coordinates[static_cast<std::size_t>(i)];
        break;
      }
    for (model::NodeId i = 0; i < group.size(); ++i)
      places.emplace(nodes.canonical(group.first + i), begin + group.coordinates[static_cast<std::size_t>(i)]);
  }
  return places;
}

}  // namespace

std::vector<double> gaps_of(const model::Model& model, model::NodeId node, DofKind kind) {
  std::vector<double> gaps;
  for (const model::StopGroup& stops : model.stops) {
    if (stops.dof != kind || !stops.b.empty() || !holds(model.nodes, stops.a, node)) continue;
    if (stops.play.has_negative()) gaps.push_back(stops.play.lower());
    if (stops.play.has_positive()) gaps.push_back(stops.play.upper());
  }
  // Stops with dissipation or friction.
  using Kind = model::ContactShape::Form::Kind;
  for (const model::ObstacleGroup& group : model.obstacles) {
    if (group.shape == nullptr || group.directions != std::vector{kind} || !group.b.empty() ||
        !holds(model.nodes, group.a, node))
      continue;
    const model::ContactShape::Form form = group.shape->form();
    if (form.kind == Kind::line) gaps.push_back(form.place[0] * form.distance);
    if (form.kind == Kind::circle) gaps.insert(gaps.end(), {-form.distance, form.distance});
  }
  std::sort(gaps.begin(), gaps.end());
  gaps.erase(std::unique(gaps.begin(), gaps.end()), gaps.end());
  return gaps;
}

std::vector<Wall> walls_of(const model::Model& model, model::NodeId node) {
  using Kind = model::ContactShape::Form::Kind;
  std::vector<Wall> walls;
  for (const model::ObstacleGroup& group : model.obstacles) {
    if (group.shape == nullptr || !group.b.empty() || !holds(model.nodes, group.a, node)) continue;
    if (group.directions != std::vector{DofKind::uy, DofKind::uz}) continue;
    const model::ContactShape::Form form = group.shape->form();
    if (form.kind == Kind::other) continue;
    walls.push_back({form.kind == Kind::circle, form.place[0], form.place[1], form.distance});
  }
  return walls;
}

void find_contact_places(const model::Model& model, Result& result) {
  std::vector<std::pair<std::string, model::NodeId>> contacts;
  const auto add = [&](const std::vector<model::NodeId>& a, const std::vector<model::NodeId>& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
      contacts.emplace_back(model.nodes.name(a[i]) + (b.empty() ? "" : "|" + model.nodes.name(b[i])), a[i]);
  };
  for (const model::StopGroup& group : model.stops) add(group.a, group.b);
  for (const model::ObstacleGroup& group : model.obstacles) add(group.a, group.b);
  const auto places = along_x(model.nodes);
  result.contacts_along_x = !contacts.empty();
  for (const auto& [name, node] : contacts)
    result.contacts_along_x = result.contacts_along_x && places.contains(model.nodes.canonical(node));
  for (const auto& [name, node] : contacts) {
    const auto is_known = [&name = name](const ContactPlace& place) { return place.node == name; };
    if (std::any_of(result.contact_places.begin(), result.contact_places.end(), is_known)) continue;
    result.contact_places.push_back({name, result.contacts_along_x
                                               ? places.at(model.nodes.canonical(node))
                                               : static_cast<double>(result.contact_places.size() + 1)});
  }
}

}  // namespace butee::app::plot
