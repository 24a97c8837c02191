#include "elements/beam.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

namespace butee::elements {

using config::Diagnostics;
using config::Parameters;
using model::NodalDof;
using model::NodeId;

namespace {

constexpr double kMostElements = 5e6;
constexpr Index kVy = 1, kMz = 5;  ///< rows of SectionCut::resultants

/// Consistent nodal forces of 1 N/m on an element of length l.
std::array<double, 4> line_load_of(double l) {
  return {l / 2, l * l / 12, l / 2, -l * l / 12};
}

std::array<NodalDof, 4> dofs_between(NodeId left, NodeId right) {
  return {NodalDof{left, DofKind::u}, NodalDof{left, DofKind::theta}, NodalDof{right, DofKind::u},
          NodalDof{right, DofKind::theta}};
}

std::vector<double> even_coordinates(double length, Index elements) {
  std::vector<double> x(static_cast<std::size_t>(elements) + 1);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = length * static_cast<double>(i) / static_cast<double>(elements);
  return x;
}

model::ElementType::Nodes read_coordinates(const Parameters& p, Diagnostics& diagnostics) {
  if (p.has("coordinates")) {
    if (p.has("length") || p.has("elements"))
      p.complain(diagnostics, "coordinates", "stands in place of length and elements; remove one of the two");
    auto x = p.numbers("coordinates");
    if (x.size() < 2) p.complain(diagnostics, "coordinates", "must hold at least two coordinates");
    if (std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) != x.end())
      p.complain(diagnostics, "coordinates", "must ascend: every coordinate larger than the one before");
    return x;
  }
  for (const char* key : {"length", "elements"})
    if (!p.has(key)) p.complain(diagnostics, key, "missing; give length and elements, or coordinates");
  if (!p.has("length") || !p.has("elements")) return std::vector<double>{};
  return even_coordinates(p.number("length"), p.integer("elements"));
}

std::unique_ptr<model::Element> make_beam(const Parameters& p, model::ElementContext& context) {
  const auto material = context.material(p, "material");
  const auto section = context.section(p, "section");
  const std::vector<double> x = read_coordinates(p, context.diagnostics()).value();
  std::vector<NodeId> nodes(x.size());
  std::iota(nodes.begin(), nodes.end(), context.own_node());
  for (const auto& [key, own] : {std::pair("start_node", nodes.front()), std::pair("end_node", nodes.back())}) {
    if (!p.has(key)) continue;
    const auto shared = context.node(p, key);
    if (!shared) return nullptr;
    if (*shared >= nodes.front() && *shared <= nodes.back()) {
      p.complain(context.diagnostics(), key, "must be a node of another element");
      return nullptr;
    }
    context.join(*shared, own);
  }
  if (!material || !section) return nullptr;
  return std::make_unique<Beam>(*material, *section, std::move(nodes), x);
}

}  // namespace

Beam::Beam(model::Material material, model::Section section, std::vector<NodeId> nodes, std::vector<double> coordinates)
    : material_(material), section_(section), nodes_(std::move(nodes)), coordinates_(std::move(coordinates)) {}

void Beam::claim(model::DofTable& dofs) const {
  for (const NodeId node : nodes_) {
    dofs.claim({node, DofKind::u}, true);
    dofs.claim({node, DofKind::theta}, true);
  }
}

void Beam::assemble(model::MatrixSink& sink) const {
  double length_before = 0.0;
  model::ElementMatrices matrices(4);
  for (std::size_t e = 0; e + 1 < nodes_.size(); ++e) {
    const double l = coordinates_[e + 1] - coordinates_[e];
    if (l != length_before) matrices = beam_matrices(material_, section_, l);
    length_before = l;
    sink.add(dofs_between(nodes_[e], nodes_[e + 1]), matrices);
  }
}

double Beam::length_of(Index part) const {
  const auto e = static_cast<std::size_t>(part);
  return coordinates_.at(e + 1) - coordinates_.at(e);
}

std::optional<model::SectionCut> Beam::cut(Index part, bool at_end) const {
  const auto e = static_cast<std::size_t>(part);
  const double l = length_of(part), sign = at_end ? 1.0 : -1.0;
  const auto dofs = dofs_between(nodes_[e], nodes_[e + 1]);
  const auto consistent = line_load_of(l);
  model::SectionCut cut({dofs.begin(), dofs.end()});
  cut.matrices = beam_matrices(material_, section_, l);
  cut.line_load = Eigen::Map<const Eigen::Vector4d>(consistent.data());
  cut.resultants(kVy, at_end ? 2 : 0) = sign;
  cut.resultants(kMz, at_end ? 3 : 1) = sign;
  if (section_.outer_fibre > 0.0) cut.modulus = section_.second_moment / section_.outer_fibre;
  return cut;
}

bool Beam::add_line_load(std::vector<model::NodalValue>& loads) const {
  for (std::size_t e = 0; e + 1 < nodes_.size(); ++e) {
    const auto consistent = line_load_of(length_of(static_cast<Index>(e)));
    const auto dofs = dofs_between(nodes_[e], nodes_[e + 1]);
    for (std::size_t i = 0; i < dofs.size(); ++i) loads.push_back({dofs[i], consistent[i]});
  }
  return true;
}

model::ElementMatrices beam_matrices(const model::Material& material, const model::Section& section, double l) {
  model::ElementMatrices matrices(4);
  matrices.stiffness << 12, 6 * l, -12, 6 * l,  //
      6 * l, 4 * l * l, -6 * l, 2 * l * l,      //
      -12, -6 * l, 12, -6 * l,                  //
      6 * l, 2 * l * l, -6 * l, 4 * l * l;      //
  matrices.mass << 156, 22 * l, 54, -13 * l,    //
      22 * l, 4 * l * l, 13 * l, -3 * l * l,    //
      54, 13 * l, 156, -22 * l,                 //
      -13 * l, -3 * l * l, -22 * l, 4 * l * l;  //
  matrices.stiffness *= material.young_modulus * section.second_moment / (l * l * l);
  matrices.mass *= material.density * section.area * l / 420.0;
  return matrices;
}

model::ElementType beam_type() {
  using config::integer, config::number, config::numbers, config::text;
  return {"beam",
          "planar Euler-Bernoulli beam: Hermite cubics, consistent mass, DOFs u and theta",
          {text("material", "the [material.NAME]"), text("section", "the [section.NAME]"),
           number("length", "m", "the length, divided evenly").above(0).optional(),
           integer("elements", "the number of elements").at_least(1).at_most(kMostElements).optional(),
           numbers("coordinates", "m", "the nodes of an uneven mesh, ascending").optional(),
           text("start_node", "a node of another element that is this beam's first").optional(),
           text("end_node", "a node of another element that is this beam's last").optional()},
          read_coordinates,
          make_beam};
}

}  // namespace butee::elements
