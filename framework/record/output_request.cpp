#include "butee/record/output_request.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "butee/config/parameters.hpp"
#include "butee/core/text.hpp"
#include "butee/model/read_model.hpp"

namespace butee::record {
namespace {

using config::Diagnostics;
using config::Parameters;
using config::Value;
using model::Model;

constexpr double kDefaultIntervals = 1000.0;
constexpr double kMostRows = 1e9;

constexpr std::array<const char*, 7> kQuantities = {"u", "v", "a", "theta", "theta_v", "theta_a", "contact_force"};

std::vector<std::string> quantity_names() {
  return {kQuantities.begin(), kQuantities.end()};
}

DofKind kind_of(Quantity quantity) {
  const bool turns = quantity == Quantity::theta || quantity == Quantity::theta_v || quantity == Quantity::theta_a;
  return turns ? DofKind::theta : DofKind::u;
}

/// "string:17" -> "string-17"
std::string label_of(const std::string& node_name) {
  std::string label = node_name;
  std::replace(label.begin(), label.end(), ':', '-');
  return label;
}

/// A probe on every node with a single load, else on every node that starts in motion.
std::vector<ProbeRequest> default_probes(const Model& model) {
  std::set<model::NodeId> nodes;
  for (const model::Load& load : model.loads)
    if (load.pattern.size() == 1) nodes.insert(load.pattern.front().dof.node);
  if (nodes.empty())
    for (const auto* values : {&model.initial_displacement, &model.initial_velocity})
      for (const model::NodalValue& value : *values) nodes.insert(value.dof.node);
  const model::DofTable dofs = number_dofs(model);
  std::vector<ProbeRequest> probes;
  for (const model::NodeId node : nodes)
    if (dofs.exists({node, DofKind::u})) probes.push_back({label_of(model.nodes.name(node)), node, {Quantity::u}});
  return probes;
}

class OutputReader {
 public:
  OutputReader(const Model& model, double end_time, Diagnostics& diagnostics)
      : model_(model), end_time_(end_time), diagnostics_(diagnostics), complete_(diagnostics.error_count() == 0) {}

  OutputRequest read(const Value& table) {
    OutputRequest request;
    const auto p =
        read_parameters(table, "output",
                        {config::number("interval", "s", "the time between two rows").above(0).optional(),
                         config::integer("every", "a row at every so manyth accepted step").at_least(1).optional(),
                         config::integer("checkpoint", "keep the run on disk after every so manyth accepted step")
                             .at_least(1)
                             .optional(),
                         config::boolean("energy", "follow work, dissipation and the balance").or_else(false),
                         config::boolean("impacts", "write impacts.csv").or_else(false),
                         config::boolean("trust", "find out how far the answer can be trusted").or_else(false),
                         config::number("trust_accuracy", "1", "the accuracy it is to be trusted to, of the peak")
                             .above(0)
                             .at_most(1)
                             .or_else(1e-2),
                         config::texts("formats", "the file formats").one_of({"csv"}).optional(),
                         config::table("probe", "the recorded nodes: [[output.probe]]").optional()},
                        diagnostics_);
    if (const Value* probes = table.table() != nullptr ? table.table()->find("probe") : nullptr)
      read_probes(*probes, request);
    else if (complete_)
      request.probes = default_probes(model_);
    if (!p) return request;
    if (p->has("interval") && p->has("every"))
      p->complain(diagnostics_, "every", "stands beside interval; give one of them");
    if (p->has("every"))
      request.every = p->integer("every");
    else
      request.interval = p->has("interval") ? p->number("interval") : end_time_ / kDefaultIntervals;
    if (request.interval && end_time_ / *request.interval > kMostRows)
      p->complain(diagnostics_, "interval",
                  "gives more than 1e9 rows until end_time = " + to_text(end_time_) + " s; make it larger");
    if (p->has("checkpoint")) request.checkpoint = p->integer("checkpoint");
    request.energy = p->flag("energy");
    request.impacts = p->flag("impacts");
    request.trust = p->flag("trust");
    request.trust_accuracy = p->number("trust_accuracy");
    return request;
  }

 private:
  void read_probes(const Value& list, OutputRequest& request) {
    if (list.table() != nullptr)
      return diagnostics_.error("output.probe", list, "must be an array of tables: write [[output.probe]]");
    if (!config::table("probe", "").complaint(list).empty()) return;
    for (std::size_t i = 0; i < list.array()->size(); ++i) {
      const auto p =
          read_parameters((*list.array())[i], "output.probe[" + std::to_string(i) + "]",
                          {config::text("label", "the name of its columns"), config::text("node", "the node"),
                           config::texts("quantities", "what is recorded").one_of(quantity_names())},
                          diagnostics_);
      if (!p) continue;
      const std::string& label = p->text("label");
      if (!is_plain_name(label)) p->complain(diagnostics_, "label", "is made of letters, digits, _ and -");
      if (!labels_.insert(label).second)
        p->complain(diagnostics_, "label", "is taken by another probe; labels are unique");
      if (p->texts("quantities").empty()) p->complain(diagnostics_, "quantities", "must name at least one quantity");
      read_probe_node(*p, request);
    }
  }

  void read_probe_node(const Parameters& p, OutputRequest& request) {
    const auto node = read_node(model_.nodes, p, "node", diagnostics_);
    if (!node) return;
    ProbeRequest probe{p.text("label"), *node, {}};
    if (complete_ && !dofs_) dofs_ = number_dofs(model_);
    for (const std::string& name : p.texts("quantities")) {
      const auto* const found = std::find(kQuantities.begin(), kQuantities.end(), name);
      const auto quantity = static_cast<Quantity>(found - kQuantities.begin());
      if (std::find(probe.quantities.begin(), probe.quantities.end(), quantity) != probe.quantities.end())
        p.complain(diagnostics_, "quantities", "names " + name + " twice");
      if (dofs_ && !dofs_->exists({*node, kind_of(quantity)}))
        p.complain(diagnostics_, "quantities",
                   "there is no " + name + ": " + dofs_->name({*node, kind_of(quantity)}) + " does not exist");
      probe.quantities.push_back(quantity);
    }
    request.probes.push_back(std::move(probe));
  }

  const Model& model_;
  double end_time_;
  Diagnostics& diagnostics_;
  bool complete_;
  std::set<std::string> labels_;
  std::optional<model::DofTable> dofs_;
};

}  // namespace

const char* name_of(Quantity quantity) {
  return kQuantities.at(static_cast<std::size_t>(quantity));
}

OutputRequest read_output(const Value& root, const Model& model, double end_time, Diagnostics& diagnostics) {
  const Value* table = root.table()->find("output");
  const Value empty;
  return OutputReader(model, end_time, diagnostics).read(table != nullptr ? *table : empty);
}

}  // namespace butee::record
