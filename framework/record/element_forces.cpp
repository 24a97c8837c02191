#include "butee/record/element_forces.hpp"

#include <cmath>

#include "butee/core/error.hpp"
#include "butee/model/element_choice.hpp"
#include "butee/model/parts_at.hpp"

namespace butee::record {
namespace {

using model::NodalDof;

constexpr Index kVy = 1, kMz = 5;  ///< rows of SectionCut::resultants

void gather(const std::vector<Index>& dofs, ConstVectorRef from, Eigen::VectorXd& to) {
  for (std::size_t i = 0; i < dofs.size(); ++i) to[static_cast<Index>(i)] = dofs[i] >= 0 ? from[dofs[i]] : 0.0;
}

const model::Model& model_of(const dynamics::Dynamics& dynamics) {
  require(dynamics.system().model != nullptr, "forces of elements are those of an assembled model");
  return *dynamics.system().model;
}

}  // namespace

ElementForces::ElementForces(dynamics::Dynamics& dynamics)
    : dynamics_(dynamics), model_(model_of(dynamics)), a_(Vector::Zero(dynamics.size())) {}

void ElementForces::add(model::Quantity quantity, model::NodeId node, const std::string& element) {
  Column column;
  switch (source_of(quantity)) {
    case model::Source::section:
      add_section_force(quantity, node, element, column);
      break;
    case model::Source::springs:
      add_springs({node, kind_of(quantity)}, element, column);
      break;
    case model::Source::support:
      add_reaction({node, kind_of(quantity)}, column);
      break;
    case model::Source::contacts:
    case model::Source::stops:
      add_obstacles(quantity, node, column);
      break;
    case model::Source::motion:
      throw LogicError("no force of an element");
  }
  columns_.push_back(std::move(column));
}

void ElementForces::add_section_force(model::Quantity quantity, model::NodeId node, const std::string& element,
                                      Column& column) {
  const model::CutChoice choice = choose_cut(model_, node, element);
  require(choice.beam != nullptr, "section forces of a beam");
  const model::SectionCut cut = choice.beam->cut(choice.part, choice.at_end).value();
  const bool is_stress = quantity == model::Quantity::bending_stress || quantity == model::Quantity::von_mises;
  if (is_stress) column.factor = 1.0 / cut.modulus.value();
  column.is_magnitude = quantity == model::Quantity::von_mises;
  const Eigen::VectorXd weights = cut.resultants.row(quantity == model::Quantity::shear_force ? kVy : kMz);
  column.shares.push_back({add_piece(cut.dofs, cut.matrices), weights});
  for (const model::Load& load : model_.loads)
    if (load.line == choice.beam)
      column.loads.push_back(
          {load.in_time.get(), -load.per_length * weights.dot(cut.line_loads.col(axis_of(load.along)))});
}

void ElementForces::add_obstacles(model::Quantity quantity, model::NodeId node, Column& column) {
  column.quantity = quantity;
  const model::DofTable& dofs = dynamics_.system().dofs;
  if (quantity == model::Quantity::contact_force) {
    column.dof = dofs.index({node, kind_of(quantity)});
    const dynamics::Contact& contact = dynamics_.contact();
    for (Index i = 0; i < contact.size(); ++i) {
      if (column.dof >= 0 && contact.dof_a(i) == column.dof) column.stops.push_back({i, 1.0});
      if (column.dof >= 0 && contact.dof_b(i) == column.dof) column.stops.push_back({i, -1.0});
    }
  }
  if (dynamics_.obstacles() == nullptr) return;
  for (Index i = 0; i < dynamics_.obstacles()->size(); ++i)
    if (dynamics_.obstacles()->touches_node(i, dofs, model_.nodes.canonical(node))) column.obstacles.push_back(i);
  has_obstacles_ = has_obstacles_ || !column.obstacles.empty();
}

double ElementForces::sum_of_obstacles(const Column& column) const {
  double sum = 0.0;
  for (const Index i : column.obstacles) {
    const dynamics::ContactForces& now = contacts_[static_cast<std::size_t>(i)];
    const model::FreeObstacles::Ends& ends = dynamics_.obstacles()->ends_of(i);
    switch (column.quantity) {
      case model::Quantity::normal_force:
        sum += now.normal;
        break;
      case model::Quantity::friction_force:
        sum += now.friction;
        break;
      case model::Quantity::slip:
        sum += now.slip_speed;
        break;
      case model::Quantity::wear_power:
        sum += std::abs(now.normal * now.slip_speed);
        break;
      default:
        for (std::size_t k = 0; k < 2; ++k) {
          if (column.dof >= 0 && ends.a[k] == column.dof) sum += now.force[static_cast<Index>(k)];
          if (column.dof >= 0 && ends.b[k] == column.dof) sum -= now.force[static_cast<Index>(k)];
        }
    }
  }
  return sum;
}

void ElementForces::add_springs(NodalDof dof, const std::string& element, Column& column) {
  for (std::size_t i = 0; i < model_.elements.size(); ++i)
    if (is_spring_on(model_, i, dof, element)) add_pieces_at(*model_.elements[i], dof, -1.0, column);
}

void ElementForces::add_reaction(NodalDof dof, Column& column) {
  for (const auto& element : model_.elements) add_pieces_at(*element, dof, 1.0, column);
  const auto same = [&](NodalDof other) {
    return other.kind == dof.kind && model_.nodes.canonical(other.node) == model_.nodes.canonical(dof.node);
  };
  for (const model::Load& load : model_.loads)
    for (const model::NodalValue& entry : load.pattern)
      if (same(entry.dof)) column.loads.push_back({load.in_time.get(), -entry.value});
  if (dof.kind == DofKind::u) add_stops(dof.node, column);
}

void ElementForces::add_stops(model::NodeId node, Column& column) {
  const model::DofTable& table = dynamics_.system().dofs;
  const model::NodeId wanted = model_.nodes.canonical(node);
  Index stop = 0;
  for (const model::StopGroup& group : model_.stops)
    for (std::size_t i = 0; i < group.a.size(); ++i) {
      const bool is_free_a = table.index({group.a[i], DofKind::u}) >= 0;
      const bool is_free_b = !group.b.empty() && table.index({group.b[i], DofKind::u}) >= 0;
      if (!is_free_a && !is_free_b) continue;  // Such stops are not assembled.
      if (model_.nodes.canonical(group.a[i]) == wanted) column.stops.push_back({stop, -1.0});
      if (!group.b.empty() && model_.nodes.canonical(group.b[i]) == wanted) column.stops.push_back({stop, 1.0});
      ++stop;
    }
}

void ElementForces::add_pieces_at(const model::Element& element, NodalDof dof, double sign, Column& column) {
  model::PartsAt parts(model_.nodes, dof,
                       [&](std::span<const NodalDof> dofs, const model::ElementMatrices& matrices, Index row) {
                         Eigen::VectorXd weights = Eigen::VectorXd::Zero(std::ssize(dofs));
                         weights[row] = sign;
                         column.shares.push_back({add_piece(dofs, matrices), weights});
                       });
  element.assemble(parts);
}

std::size_t ElementForces::add_piece(std::span<const NodalDof> dofs, const model::ElementMatrices& matrices) {
  const model::Damping& damping = dynamics_.system().damping;
  Piece piece;
  for (const NodalDof& dof : dofs) piece.dofs.push_back(dynamics_.system().dofs.index(dof));
  piece.mass = matrices.mass;
  piece.stiffness = matrices.stiffness;
  piece.damping = matrices.damping + damping.mass_proportional * matrices.mass +
                  damping.stiffness_proportional * matrices.stiffness;
  piece.x = piece.v = piece.a = piece.p = Eigen::VectorXd::Zero(std::ssize(dofs));
  has_mass_ = has_mass_ || !piece.mass.isZero(0.0);
  pieces_.push_back(std::move(piece));
  return pieces_.size() - 1;
}

double ElementForces::force_of_stop(Index stop, ConstVectorRef x) {
  dynamics::Contact& contact = dynamics_.contact();
  const Index a = contact.dof_a(stop), b = contact.dof_b(stop);
  return contact.force_of(stop, (a >= 0 ? x[a] : 0.0) - (b >= 0 ? x[b] : 0.0));
}

void ElementForces::evaluate(double t, ConstVectorRef x, ConstVectorRef v, std::span<double> values) {
  if (has_mass_) dynamics_.acceleration(t, x, v, a_);
  for (Piece& piece : pieces_) {
    gather(piece.dofs, x, piece.x);
    gather(piece.dofs, v, piece.v);
    piece.p.noalias() = piece.stiffness * piece.x;
    piece.p.noalias() += piece.damping * piece.v;
    if (!has_mass_) continue;
    gather(piece.dofs, a_, piece.a);
    piece.p.noalias() += piece.mass * piece.a;
  }
  if (has_obstacles_) dynamics_.contact_forces(t, x, v, contacts_);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column& column = columns_[i];
    double sum = 0.0;
    for (const Share& share : column.shares) sum += share.weights.dot(pieces_[share.piece].p);
    for (const LoadShare& load : column.loads) sum += load.weight * load.in_time->value(t);
    for (const StopShare& stop : column.stops) sum += stop.sign * force_of_stop(stop.stop, x);
    sum += sum_of_obstacles(column);
    values[i] = column.factor * (column.is_magnitude ? std::abs(sum) : sum);
  }
}

}  // namespace butee::record
