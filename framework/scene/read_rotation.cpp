#include <algorithm>

#include "butee/core/text.hpp"
#include "butee/scene/scene_reader.hpp"

namespace butee::scene {

using config::Parameters;
using config::Value;
using Turning = Element::Turning;

void SceneReader::read_rotation() {
  const Value* given = root_.table()->find("rotation");
  model_.turns.assign(model_.elements.size(), false);
  if (given == nullptr) {
    for (std::size_t i = 0; i < model_.elements.size(); ++i)
      if (model_.elements[i]->turning() == Turning::always)
        diagnostics_.error(element_places_[i].first, element_places_[i].second,
                           "has rotating damping, but nothing turns: give [rotation] with a speed");
    if (diagnostics_.error_count() > 0) return;
    for (const auto& [entry, path] : entries("element"))
      if (entry->table() != nullptr && entry->table()->find("gyroscopic") != nullptr)
        diagnostics_.warning(path + ".gyroscopic", entry->at,
                             "has no effect, since nothing turns: [rotation] is not given");
    return;
  }
  const auto p = read_parameters(
      *given, "rotation",
      {config::texts("parts", "the beams, discs and matrices that turn; default: all that can").optional()},
      diagnostics_, {"speed"});
  if (!p) return;
  model_.rotation = read_speed(*given);
  choose_turning(*p);
}

void SceneReader::warn_of_standing_discs() {
  DofTable turning(model_.nodes);
  for (std::size_t i = 0; i < model_.elements.size(); ++i)
    if (model_.turns[i]) model_.elements[i]->claim(turning);
  for (std::size_t i = 0; i < model_.elements.size(); ++i) {
    if (model_.turns[i] || model_.elements[i]->turning() != Turning::possible) continue;
    DofTable own(model_.nodes);
    model_.elements[i]->claim(own);
    bool is_on_turning = true;
    for (NodeId node = 0; node < model_.nodes.size(); ++node)
      for (const DofKind kind : kAllDofKinds)
        if (own.exists({node, kind})) is_on_turning = is_on_turning && turning.exists({node, kind});
    if (is_on_turning)
      diagnostics_.warning(element_places_[i].first, element_places_[i].second,
                           "stands still, but all its nodes are on parts that turn; if it turns with them, name it in "
                           "rotation.parts");
  }
}

std::unique_ptr<Rotation> SceneReader::read_speed(const Value& rotation) {
  const Value* given = rotation.table()->find("speed");
  if (given == nullptr) {
    diagnostics_.error("rotation.speed", rotation.at,
                       "missing; give the speed about x (number, rad/s), or a table such as { type = \"ramp\", from = "
                       "0.0, to = 300.0, end = 10.0 }");
    return nullptr;
  }
  if (const auto speed = config::as_number(*given)) {
    if (std::isfinite(*speed)) return std::make_unique<Rotation>(std::vector{0.0}, std::vector{*speed});
    diagnostics_.error("rotation.speed", *given, "must be a finite number (rad/s)");
    return nullptr;
  }
  if (given->table() == nullptr) {
    diagnostics_.error(
        "rotation.speed", *given,
        std::string("must be a number (rad/s) or a table with type = \"ramp\" or \"table\", not ") + given->kind());
    return nullptr;
  }
  const auto type = type_of(*given, "rotation.speed", "type", {"constant", "ramp", "table"});
  auto in_time = type ? read_in_time(*given, "rotation.speed", {}, "rad/s") : nullptr;
  if (in_time == nullptr) return nullptr;
  std::vector<double> times = in_time->discontinuities(), speeds;
  if (times.empty()) times = {0.0};
  for (const double t : times) speeds.push_back(in_time->value(t));
  return std::make_unique<Rotation>(std::move(times), std::move(speeds));
}

void SceneReader::choose_turning(const Parameters& p) {
  const std::vector<std::string> parts = p.has("parts") ? p.texts("parts") : std::vector<std::string>{};
  std::vector<std::string> able;
  bool any = false;
  for (std::size_t i = 0; i < model_.elements.size(); ++i) {
    const Element& element = *model_.elements[i];
    const std::string& name = model_.element_names[i];
    if (element.turning() == Turning::never) continue;
    if (!name.empty() && element.turning() == Turning::possible) able.push_back(name);
    const bool is_meant = !p.has("parts") || std::find(parts.begin(), parts.end(), name) != parts.end();
    if (element.turning() != Turning::always && !is_meant) continue;
    any = true;
    model_.turns[i] = true;
    if (const std::string problem = element.turning_problem(); !problem.empty())
      diagnostics_.error(element_places_[i].first, element_places_[i].second,
                         "turns with [rotation], but " + problem +
                             (p.has("parts") ? "" : "; if it stands still, name the rotating parts in rotation.parts"));
  }
  if (p.has("parts")) warn_of_standing_discs();
  for (const std::string& part : parts)
    if (std::find(able.begin(), able.end(), part) == able.end() && !lacks_elements_)
      p.complain(diagnostics_, "parts",
                 "\"" + part +
                     "\" is neither a beam along x with motion = \"lateral\" or \"spatial\", nor a disc, nor matrices "
                     "with gyroscopic" +
                     suggestion(part, able) + (able.empty() ? "" : "; these can turn: " + join(able)));
  const auto has_entry = [this](const char* list, const auto& is_meant) {
    const Value* all = root_.table()->find(list);
    return all != nullptr && all->array() != nullptr &&
           std::any_of(all->array()->begin(), all->array()->end(),
                       [&](const Value& one) { return one.table() != nullptr && is_meant(*one.table()); });
  };
  // A lone mass may represent a shaft with a rotating unbalance or friction.
  any = any || has_entry("contact", [](const config::Table& one) { return one.find("radius") != nullptr; }) ||
        has_entry("load", [](const config::Table& one) {
          const Value* type = one.find("type");
          return type != nullptr && type->text() != nullptr && *type->text() == "unbalance" && !one.find("speed");
        });
  if (any || lacks_elements_ || !parts.empty()) return;
  if (p.has("parts") && !able.empty())
    p.complain(diagnostics_, "parts", "names nothing, so that nothing turns; these can turn: " + join(able));
  else
    diagnostics_.error("rotation", p.at(),
                       "turns nothing: the scene has no disc and no beam along x with motion = \"lateral\" or "
                       "\"spatial\"");
}

}  // namespace butee::scene
