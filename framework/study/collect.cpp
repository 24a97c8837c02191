#include "butee/study/collect.hpp"

#include <algorithm>
#include <limits>

#include "butee/core/error.hpp"
#include "butee/model/element_choice.hpp"
#include "butee/record/contacts_on.hpp"
#include "butee/study/collect_parts.hpp"

namespace butee::study {

using Kind = Item::Kind;

Collector::Collector(const std::vector<Item>& items, const scene::Scene& scene, dynamics::Dynamics& dynamics,
                     const Counted& counted)
    : places_(items.size(), {nullptr, 0}), counted_(counted) {
  const auto add = [&](const std::vector<std::size_t>& chosen, std::unique_ptr<CollectorPart> part) {
    for (std::size_t i = 0; i < chosen.size(); ++i) places_[chosen[i]] = {part.get(), i};
    parts_.push_back(std::move(part));
  };
  const auto chosen_by = [&](auto is_chosen) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < items.size(); ++i)
      if (is_chosen(items[i])) chosen.push_back(i);
    return chosen;
  };
  const auto probes_of = [&](const std::vector<std::size_t>& chosen) {
    std::vector<model::ProbeRequest> probes;
    for (const std::size_t i : chosen) probes.push_back(probe_of(items[i], scene));
    return probes;
  };
  const auto kinds_of = [&](const std::vector<std::size_t>& chosen) {
    std::vector<Kind> kinds;
    for (const std::size_t i : chosen) kinds.push_back(items[i].kind);
    return kinds;
  };
  const model::DofTable& dofs = dynamics.system().dofs;
  const auto is_followed = [&](const Item& item) {
    return !is_element_force(item.quantity) &&
           !record::Probes::has_base_share(&scene.model, dofs, probe_of(item, scene).node, item.quantity);
  };
  // Peaks follows the forces of elastic stops only.
  const auto is_of_obstacle = [&](const Item& item) {
    if (!is_contact_force(item.quantity)) return false;
    const model::NodeId node = probe_of(item, scene).node;
    return !record::contacts_on(scene.model, dofs, {node, contact_kind(scene.model, node, item.quantity)})
                .obstacles.empty();
  };
  for (const Item& item : items)
    if ((item.kind == Kind::max || item.kind == Kind::min) && !is_followed(item))
      throw refused(item,
                    "max and min take displacements, velocities and accelerations in the frame of the solution; take "
                    "peak, the largest |value|");

  for (const Item& item : items)
    if (item.kind == Kind::wear && dynamics.obstacles() == nullptr)
      throw refused(item, "no contact of the scene has friction; add friction, or remove it");

  if (const auto chosen =
          chosen_by([&](const Item& i) { return i.kind == Kind::peak && is_followed(i) && !is_of_obstacle(i); });
      !chosen.empty())
    add(chosen, std::make_unique<PeakPart>(probes_of(chosen), dynamics));
  if (const auto chosen =
          chosen_by([&](const Item& i) { return i.kind == Kind::peak && (!is_followed(i) || is_of_obstacle(i)); });
      !chosen.empty())
    add(chosen, std::make_unique<SampledPeakPart>(probes_of(chosen), dynamics, counted_));
  if (const auto chosen = chosen_by([](const Item& i) { return i.kind == Kind::max || i.kind == Kind::min; });
      !chosen.empty()) {
    std::vector<bool> is_max;
    for (const std::size_t i : chosen) is_max.push_back(items[i].kind == Kind::max);
    add(chosen, std::make_unique<RangePart>(probes_of(chosen), is_max, dynamics));
  }
  if (const auto chosen =
          chosen_by([&](const Item& i) { return i.kind == Kind::mean || i.kind == Kind::rms || i.kind == Kind::end; });
      !chosen.empty()) {
    add(chosen, std::make_unique<MeanPart>(probes_of(chosen), kinds_of(chosen), dynamics, counted_));
  }
  if (const auto chosen = chosen_by([](const Item& i) { return i.kind == Kind::section; }); !chosen.empty())
    add(chosen, std::make_unique<SectionPart>(probes_of(chosen), dynamics, counted_));
  if (const auto chosen = chosen_by([](const Item& i) { return i.kind == Kind::frequency; }); !chosen.empty())
    add(chosen, std::make_unique<FrequencyPart>(probes_of(chosen), dynamics, counted_));
  if (const auto chosen = chosen_by([](const Item& i) { return i.kind == Kind::impacts || i.kind == Kind::wear; });
      !chosen.empty())
    add(chosen, std::make_unique<ContactPart>(kinds_of(chosen), dynamics, counted_));
}

Collector::~Collector() = default;

void Collector::open(const time::State& state) {
  is_open_ = true;
  if (state.t != counted_.begin) {
    counted_.end = state.t + counted_.end - counted_.begin;
    counted_.begin = state.t;
  }
  for (const auto& part : parts_) part->start(state);
}

void Collector::step(const time::AcceptedStep& step) {
  if (!is_open_) return;
  for (const auto& part : parts_) part->step(step);
}

double Collector::next_instant(double t) const {
  double next = std::numeric_limits<double>::infinity();
  if (is_open_)
    for (const auto& part : parts_) next = std::min(next, part->next_instant(t));
  return next;
}

std::vector<double> Collector::values(std::size_t item) const {
  const auto [part, place] = places_[item];
  return part != nullptr ? part->values(place) : std::vector<double>{};
}

}  // namespace butee::study
