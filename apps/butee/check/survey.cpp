#include "survey.hpp"

#include <cmath>

namespace butee::app::check {
namespace {

using model::ElementMatrices;
using model::NodalDof;
using model::NodeId;

class SurveySink final : public model::MatrixSink {
 public:
  SurveySink(const model::NodeTable& nodes, Survey& survey) : nodes_(nodes), survey_(survey) {}

  void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override {
    double mass = 0.0;
    for (std::size_t i = 0; i < dofs.size(); ++i)
      for (std::size_t j = 0; j < dofs.size(); ++j)
        if (dofs[i].kind == DofKind::u && dofs[j].kind == DofKind::u)
          mass += matrices.mass(static_cast<Index>(i), static_cast<Index>(j));
    survey_.total_mass += mass;
    if (dofs.size() == 2 && matrices.stiffness(0, 0) == 0.0 && matrices.stiffness(0, 1) != 0.0) are_entries_ = true;
    if (dofs.size() == 2 && mass != 0.0) couples_masses_ = true;
    if (dofs.size() == 4) return add_stretch(dofs, matrices, mass);
    if (dofs.size() == 1 && mass > 0.0 && dofs[0].kind == DofKind::u) masses_.push_back({dofs[0].node, mass});
    // Both displacements of a bearing are those of one node.
    const bool is_bearing = dofs.size() == 2 && nodes_.canonical(dofs[0].node) == nodes_.canonical(dofs[1].node);
    for (std::size_t i = 0; i < (is_bearing ? dofs.size() : 1U); ++i)
      if (const double k = matrices.stiffness(static_cast<Index>(i), static_cast<Index>(i));
          dofs.size() <= 2 && k != 0.0 && (dofs[i].kind == DofKind::uy || dofs[i].kind == DofKind::uz))
        springs_.push_back({dofs[i].node, dofs.size() == 2 && !is_bearing ? dofs[1].node : -1, k, dofs[i].kind});
  }

  /// Ends an element. In matrices given entry by entry, a diagonal entry is not a spring to ground; if masses
  /// are coupled, it is not a lumped mass either.
  void end() {
    if (!couples_masses_)
      for (const MassPlace& mass : masses_) {
        survey_.lumped_mass += mass.mass;
        survey_.masses.push_back(mass);
      }
    if (!are_entries_) survey_.springs.insert(survey_.springs.end(), springs_.begin(), springs_.end());
    masses_.clear();
    springs_.clear();
    are_entries_ = couples_masses_ = false;
  }

 private:
  /// Bending stiffness from the moment at one end due to a unit rotation of that end, 4 E I / l.
  void add_stretch(std::span<const NodalDof> dofs, const ElementMatrices& matrices, double mass) {
    const NodeId a = dofs[0].node, b = dofs[2].node;
    const model::NodeGroup& group = nodes_.group_of(a);
    if (dofs[1].kind != DofKind::theta || group.lone() || &nodes_.group_of(b) != &group) return;
    const double length = std::abs(group.coordinates[static_cast<std::size_t>(b - group.first)] -
                                   group.coordinates[static_cast<std::size_t>(a - group.first)]);
    survey_.stretches.push_back({a, b, length, matrices.stiffness(1, 1) * length / 4.0, mass / length});
  }

  const model::NodeTable& nodes_;
  Survey& survey_;
  std::vector<MassPlace> masses_;
  std::vector<SpringPlace> springs_;
  bool are_entries_ = false, couples_masses_ = false;
};

}  // namespace

Survey survey_of(const model::Model& model) {
  Survey survey;
  SurveySink sink(model.nodes, survey);
  for (const auto& element : model.elements) {
    element->assemble(sink);
    sink.end();
  }
  return survey;
}

}  // namespace butee::app::check
