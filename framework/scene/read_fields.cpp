#include "butee/scene/read_fields.hpp"

#include <algorithm>
#include <numeric>

#include "butee/core/text.hpp"
#include "butee/scene/read_model.hpp"

namespace butee::scene {

using config::Diagnostics;
using config::Parameters;
using config::Value;

namespace {

/// The reason why a format is not known, in addition to the list of known formats.
std::string reason_of(const std::string& name, const std::vector<std::string>& known) {
  if (name == "hdf5")
    return ": its module was not built, since the HDF5 library was not found; install it (Debian: libhdf5-dev) and "
           "build "
           "butee again";
  return suggestion(name, known);
}

/// Reports the first name that occurs twice.
void refuse_doubles(const Parameters& p, const std::string& key, Diagnostics& diagnostics) {
  const auto names = p.texts(key);
  for (const std::string& name : names)
    if (std::count(names.begin(), names.end(), name) > 1)
      return p.complain(diagnostics, key, "names " + name + " twice");
}

/// u, theta, v and the stops, and the other displacements and rotations that the scene has.
config::Array usual_quantities(const model::Model* model) {
  std::vector<std::string> names = {"u", "theta"};
  if (model != nullptr) {
    const model::DofTable dofs = number_dofs(*model);
    for (const DofKind kind : {DofKind::ux, DofKind::uz, DofKind::rx, DofKind::ry})
      if (std::any_of(dofs.free().begin(), dofs.free().end(), [&](model::NodalDof dof) { return dof.kind == kind; }))
        names.emplace_back(name_of(kind));
  }
  names.insert(names.end(), {"v", "contact_force", "stop_state"});
  config::Array usual;
  for (const std::string& name : names) usual.emplace_back(name);
  return usual;
}

/// Reports displacements and rotations other than u and theta that none of the nodes has.
void refuse_absent(const Parameters& p, const model::Model& model, const model::FieldRequest& request,
                   Diagnostics& diagnostics) {
  if (!p.given("quantities")) return;
  const model::DofTable dofs = number_dofs(model);
  for (const model::Quantity quantity : request.quantities) {
    const DofKind kind = kind_of(quantity);
    if (kind == DofKind::u || kind == DofKind::theta) continue;
    const auto has = [&](model::NodeId node) { return dofs.exists({node, kind}); };
    if (std::none_of(request.nodes.begin(), request.nodes.end(), has))
      p.complain(diagnostics, "quantities",
                 std::string("no recorded node has ") + name_of(quantity) + ": no element there uses it");
  }
}

std::vector<config::Parameter> field_keys(const config::Array& usual) {
  return {
      config::texts("nodes", "the recorded nodes: selectors; default: all").optional(),
      config::texts("quantities", "the recorded quantities").one_of(model::field_quantities()).or_else(usual),
      config::number("interval", "s", "the time between two records; default: that of the rows").above(0).optional()};
}

}  // namespace

FormatRequest read_formats(const Parameters& output, const std::vector<std::string>& known, Diagnostics& diagnostics) {
  if (!output.has("formats")) return {};
  std::vector<std::string> all = known;
  all.insert(all.begin(), "csv");
  FormatRequest request{false, {}};
  for (const std::string& name : output.texts("formats")) {
    if (std::find(all.begin(), all.end(), name) == all.end())
      output.complain(diagnostics, "formats",
                      "there is no format \"" + name + "\"" + reason_of(name, all) + "; known: " + join(all));
    if (name == "csv")
      request.csv = true;
    else
      request.fields.push_back(name);
  }
  refuse_doubles(output, "formats", diagnostics);
  if (!request.csv && request.fields.empty())
    output.complain(diagnostics, "formats", "must name at least one format; known: " + join(all));
  return request;
}

model::FieldRequest read_fields(const Parameters& output, std::vector<std::string> formats, const model::Model* model,
                                Diagnostics& diagnostics) {
  model::FieldRequest request;
  request.formats = std::move(formats);
  const bool wanted = !request.formats.empty();
  if (output.has("fields") && !wanted)
    output.complain(diagnostics, "fields", "no format writes them; set formats = [\"csv\", \"hdf5\"]");
  const Value none, &table = output.has("fields") ? output.value("fields") : none;
  if (table.table() == nullptr) {
    output.complain(diagnostics, "fields", "must be one table, not several");
    return request;
  }
  const auto p =
      read_parameters(table, "output.fields", field_keys(usual_quantities(wanted ? model : nullptr)), diagnostics);
  if (!p) return request;
  if (p->texts("quantities").empty()) p->complain(diagnostics, "quantities", "must name at least one quantity");
  refuse_doubles(*p, "quantities", diagnostics);
  for (const std::string& name : p->texts("quantities")) request.quantities.push_back(model::quantity_of(name));
  if (p->has("interval")) request.interval = p->number("interval");
  if (!wanted || model == nullptr) return request;
  if (p->has("nodes")) {
    request.nodes = read_nodes(model->nodes, *p, "nodes", diagnostics).value_or(std::vector<model::NodeId>{});
    std::sort(request.nodes.begin(), request.nodes.end());
  } else {
    request.nodes.resize(static_cast<std::size_t>(model->nodes.size()));
    std::iota(request.nodes.begin(), request.nodes.end(), model::NodeId{0});
  }
  refuse_absent(*p, *model, request, diagnostics);
  return request;
}

}  // namespace butee::scene
