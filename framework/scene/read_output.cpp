#include "butee/scene/read_output.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "butee/config/parameters.hpp"
#include "butee/core/text.hpp"
#include "butee/model/element_choice.hpp"
#include "butee/scene/read_fields.hpp"
#include "butee/scene/read_model.hpp"

namespace butee::scene {
namespace {

using config::Diagnostics;
using config::Parameters;
using config::Value;
using model::Model;

constexpr double kDefaultIntervals = 1000.0;
constexpr double kMostRows = 1e9;

/// "string:17" -> "string-17"
std::string label_of(const std::string& node_name) {
  std::string label = node_name;
  std::replace(label.begin(), label.end(), ':', '-');
  return label;
}

bool takes_element(model::Quantity quantity) {
  return source_of(quantity) == model::Source::section || source_of(quantity) == model::Source::springs;
}

/// A probe on every node with a single load, or otherwise on every node with initial motion.
std::vector<model::ProbeRequest> default_probes(const Model& model) {
  std::set<model::NodeId> nodes;
  for (const model::Load& load : model.loads)
    if (load.pattern.size() == 1) nodes.insert(load.pattern.front().dof.node);
  if (nodes.empty())
    for (const auto* values : {&model.initial_displacement, &model.initial_velocity})
      for (const model::NodalValue& value : *values) nodes.insert(value.dof.node);
  const model::DofTable dofs = number_dofs(model);
  std::vector<model::ProbeRequest> probes;
  for (const model::NodeId node : nodes)
    if (dofs.exists({node, DofKind::u}))
      probes.push_back({label_of(model.nodes.name(node)), node, {model::Quantity::u}, {}});
  return probes;
}

class OutputReader {
 public:
  OutputReader(const Model& model, double end_time, Diagnostics& diagnostics,
               const std::vector<model::FieldFormat>& formats)
      : model_(model),
        begin_(model.initial_motion ? model.initial_motion->time : 0.0),
        end_time_(end_time),
        diagnostics_(diagnostics),
        complete_(diagnostics.error_count() == 0) {
    if (complete_ && model.initial_motion && begin_ >= end_time_)
      diagnostics.error("initial.keep_time", diagnostics.document().root.table()->find("initial")->at,
                        "begins the run at t = " + to_text(begin_) + " s, and its end_time is " + to_text(end_time_) +
                            " s; end_time counts from the same zero");
    for (const model::FieldFormat& format : formats) formats_.push_back(format.name);
  }

  model::OutputRequest read(const Value& table) {
    model::OutputRequest request;
    const auto p = read_parameters(
        table, "output",
        {config::number("interval", "s", "the time between two rows").above(0).optional(),
         config::integer("every", "a row at every N-th accepted step").at_least(1).optional(),
         config::integer("checkpoint", "save a checkpoint at every N-th accepted step").at_least(1).optional(),
         config::numbers("states", "s", "instants at which the whole motion is saved in states.bin").optional(),
         config::boolean("energy", "follow work, dissipation and the balance").or_else(false),
         config::boolean("impacts", "write impacts.csv").or_else(false),
         config::boolean("trust", "estimate the accuracy of the result").or_else(false),
         config::number("trust_accuracy", "1", "accuracy required by trust, relative to the peak")
             .above(0)
             .at_most(1)
             .or_else(1e-2),
         config::texts("formats", "the file formats").optional(),
         config::table("fields", "the keys of the formats of fields").optional(),
         config::table("probe", "the recorded nodes: [[output.probe]]").optional()},
        diagnostics_);
    if (const Value* probes = table.table() != nullptr ? table.table()->find("probe") : nullptr)
      read_probes(*probes, request);
    else if (complete_)
      request.probes = default_probes(model_);
    if (!p) return request;
    if (p->has("interval") && p->has("every"))
      p->complain(diagnostics_, "every", "conflicts with interval; give one of them");
    if (p->has("every"))
      request.every = p->integer("every");
    else
      request.interval = p->has("interval") ? p->number("interval") : (end_time_ - begin_) / kDefaultIntervals;
    if (complete_ && p->has("interval") && request.interval && *request.interval > end_time_ - begin_)
      diagnostics_.warning("output.interval", p->value("interval").at,
                           "is longer than the run of " + to_text(end_time_ - begin_) +
                               " s, so that the history has its beginning and its end alone");
    read_states(*p, request);
    if (complete_ && request.interval && (end_time_ - begin_) / *request.interval > kMostRows)
      p->complain(diagnostics_, "interval",
                  "gives more than 1e9 rows until end_time = " + to_text(end_time_) + " s; make it larger");
    if (p->has("checkpoint")) request.checkpoint = p->integer("checkpoint");
    request.energy = p->flag("energy");
    request.impacts = p->flag("impacts");
    request.trust = p->flag("trust");
    request.trust_accuracy = p->number("trust_accuracy");
    const FormatRequest formats = read_formats(*p, formats_, diagnostics_);
    request.csv = formats.csv;
    request.fields = read_fields(*p, formats.fields, complete_ ? &model_ : nullptr, diagnostics_);
    if (complete_ && request.fields.interval && (end_time_ - begin_) / *request.fields.interval > kMostRows)
      diagnostics_.error("output.fields.interval", p->value("fields"),
                         "gives more than 1e9 records until end_time = " + to_text(end_time_) + " s; make it larger");
    return request;
  }

 private:
  void read_states(const Parameters& p, model::OutputRequest& request) {
    if (!p.has("states")) return;
    request.states = p.numbers("states");
    std::sort(request.states.begin(), request.states.end());
    request.states.erase(std::unique(request.states.begin(), request.states.end()), request.states.end());
    for (const double t : request.states)
      if (complete_ && (t < begin_ || t > end_time_))
        return p.complain(diagnostics_, "states",
                          "holds " + to_text(t) + " s, which is not between the beginning of the run and end_time = " +
                              to_text(end_time_) + " s");
  }

  void read_probes(const Value& list, model::OutputRequest& request) {
    if (list.table() != nullptr)
      return diagnostics_.error("output.probe", list, "must be an array of tables: write [[output.probe]]");
    if (!config::table("probe", "").complaint(list).empty()) return;
    for (std::size_t i = 0; i < list.array()->size(); ++i) {
      const auto p = read_parameters(
          (*list.array())[i], "output.probe[" + std::to_string(i) + "]",
          {config::text("label", "the name of its columns; default: the node, with - instead of :").optional(),
           config::text("node", "the node"),
           config::texts("quantities", "the recorded quantities").one_of(model::probe_quantities()),
           config::text("element", "the beam or spring whose forces are recorded, if the node has several").optional()},
          diagnostics_);
      if (!p) continue;
      const std::string label = p->has("label") ? p->text("label") : label_of(p->text("node"));
      if (p->has("label") && !is_plain_name(label))
        p->complain(diagnostics_, "label", "must be made of A to Z, a to z, digits, _ and -");
      if (!labels_.insert(label).second) {
        if (p->has("label"))
          p->complain(diagnostics_, "label", "is taken by another probe; labels are unique");
        else
          p->complain(diagnostics_, "node", "has another probe of that name; give this one a label");
      }
      if (p->texts("quantities").empty()) p->complain(diagnostics_, "quantities", "must name at least one quantity");
      read_probe_node(*p, label, request);
    }
  }

  void read_probe_node(const Parameters& p, const std::string& label, model::OutputRequest& request) {
    const auto node = read_node(model_.nodes, p, "node", diagnostics_);
    if (!node) return;
    model::ProbeRequest probe{label, *node, {}, p.has("element") ? p.text("element") : ""};
    if (complete_ && !dofs_) dofs_ = number_dofs(model_);
    for (const std::string& name : p.texts("quantities")) {
      const model::Quantity quantity = model::quantity_of(name);
      if (std::find(probe.quantities.begin(), probe.quantities.end(), quantity) != probe.quantities.end())
        p.complain(diagnostics_, "quantities", "names " + name + " twice");
      const std::string problem = dofs_ ? why_not(quantity, model_, *dofs_, *node, probe.element) : "";
      if (!problem.empty())
        p.complain(diagnostics_, p.has("element") && takes_element(quantity) ? "element" : "quantities", problem);
      probe.quantities.push_back(quantity);
    }
    if (p.has("element") && std::none_of(probe.quantities.begin(), probe.quantities.end(), takes_element))
      p.complain(diagnostics_, "element", "no quantity of this probe is the force of an element; remove it");
    request.probes.push_back(std::move(probe));
  }

  const Model& model_;
  double begin_, end_time_;
  Diagnostics& diagnostics_;
  bool complete_;  ///< no mistakes before: end_time is known
  std::vector<std::string> formats_;
  std::set<std::string> labels_;
  std::optional<model::DofTable> dofs_;
};

}  // namespace

model::OutputRequest read_output(const Value& root, const Model& model, double end_time, Diagnostics& diagnostics,
                                 const std::vector<model::FieldFormat>& formats) {
  const Value* table = root.table()->find("output");
  const Value empty;
  return OutputReader(model, end_time, diagnostics, formats).read(table != nullptr ? *table : empty);
}

}  // namespace butee::scene
