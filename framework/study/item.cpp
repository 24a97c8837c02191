#include <algorithm>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/model/element_choice.hpp"
#include "butee/study/collect.hpp"

namespace butee::study {
namespace {

using Kind = Item::Kind;

bool takes_probe(Kind kind) {
  return kind != Kind::impacts && kind != Kind::wear && kind != Kind::lyapunov && kind != Kind::trust;
}

std::string known_kinds() {
  std::vector<std::string> names;
  for (const ItemKind& kind : item_kinds())
    names.push_back(kind.name + (takes_probe(kind.kind) ? " LABEL.QUANTITY" : ""));
  return join(names);
}

}  // namespace

const std::vector<ItemKind>& item_kinds() {
  static const std::vector<ItemKind> all = {
      {Kind::peak, "peak",
       "largest |value| over the periods that count, including between steps (forces of elements: at 64 instants of "
       "each period, or 4096 of a run without one, and at least every [output] interval)"},
      {Kind::max, "max", "largest value, of displacements, velocities and accelerations"},
      {Kind::min, "min", "smallest value, of the same quantities"},
      {Kind::mean, "mean", "mean over time"},
      {Kind::rms, "rms", "root of the mean square over time"},
      {Kind::end, "end", "value at the end"},
      {Kind::section, "section", "value at the end of each period (Poincare section)"},
      {Kind::frequency, "frequency", "frequency of the largest line of the spectrum, Hz"},
      {Kind::impacts, "impacts", "closings of stops; impacts.csv also has contacts that are closed at the start"},
      {Kind::wear, "wear", "wear work of all contacts, the integral of |F_n w| (Archard), J"},
      {Kind::lyapunov, "lyapunov", "largest Lyapunov exponent: growth of a small disturbance, 1/s"},
      {Kind::trust, "trust", "time up to which the run is accurate (butee run --trust), s: several runs"}};
  return all;
}

Item read_item(const std::string& text) {
  const std::size_t space = text.find(' ');
  const std::string name = text.substr(0, space);
  const auto found =
      std::find_if(item_kinds().begin(), item_kinds().end(), [&](const ItemKind& k) { return k.name == name; });
  if (found == item_kinds().end()) {
    std::vector<std::string> names;
    for (const ItemKind& kind : item_kinds()) names.push_back(kind.name);
    throw InputError("there is no result \"" + name + "\"" + suggestion(name, names) + "; known: " + known_kinds());
  }
  Item item{found->kind, text, "", model::Quantity::u};
  if (!takes_probe(item.kind)) {
    if (space != std::string::npos) throw InputError("\"" + text + "\": " + name + " stands alone");
    return item;
  }
  const std::size_t dot = text.rfind('.');
  if (space == std::string::npos || dot == std::string::npos || dot < space + 2)
    throw InputError("\"" + text + "\": write " + name + " LABEL.QUANTITY, such as \"" + name + " mid.u\"");
  item.probe = text.substr(space + 1, dot - space - 1);
  const std::string quantity = text.substr(dot + 1);
  const auto known = model::probe_quantities();
  if (std::find(known.begin(), known.end(), quantity) == known.end())
    throw InputError("\"" + text + "\": there is no quantity \"" + quantity + "\"" + suggestion(quantity, known) +
                     "; known: " + join(known));
  item.quantity = model::quantity_of(quantity);
  const bool is_motion = source_of(item.quantity) == model::Source::motion;
  if ((item.kind == Kind::max || item.kind == Kind::min) && !is_motion)
    throw InputError("\"" + text + "\": " + name + " applies to displacements, velocities and accelerations; use peak");
  return item;
}

Column column_of(const Item& item, std::int64_t periods) {
  Column column{item.text, "1"};
  switch (item.kind) {
    case Kind::frequency:
      column.unit = "Hz";
      break;
    case Kind::lyapunov:
      column.unit = "1/s";
      break;
    case Kind::impacts:
      break;
    case Kind::wear:
      column.unit = "J";
      break;
    case Kind::trust:
      column.unit = "s";
      break;
    case Kind::section:
      column.length = static_cast<std::size_t>(periods);
      [[fallthrough]];
    default:
      column.unit = unit_of(item.quantity);
  }
  return column;
}

InputError refused(const Item& item, const std::string& complaint) {
  return InputError(item.place + ": \"" + item.text + "\": " + complaint);
}

model::ProbeRequest probe_of(const Item& item, const scene::Scene& scene) {
  model::ProbeRequest probe{item.probe, 0, {item.quantity}, {}};
  std::vector<std::string> labels;
  bool is_label = false;
  for (const model::ProbeRequest& known : scene.output.probes) {
    labels.push_back(known.label);
    if (known.label != item.probe) continue;
    is_label = true;
    probe.node = known.node;
    probe.element = known.element;
  }
  if (!is_label) {
    const model::Selection selection = scene.model.nodes.select(item.probe);
    if (selection.nodes.size() != 1)
      throw refused(item, "\"" + item.probe + "\" is neither the label of a probe" + suggestion(item.probe, labels) +
                              " nor one node" +
                              (selection.nodes.empty() ? "" : ", but " + std::to_string(selection.nodes.size())) +
                              "; probes: " + join(labels) + "; nodes: " + join(scene.model.nodes.group_names()));
    probe.node = selection.nodes.front();
  }
  const std::string problem = why_not(item.quantity, scene.model, number_dofs(scene.model), probe.node, probe.element);
  if (!problem.empty()) throw refused(item, problem);
  return probe;
}

}  // namespace butee::study
