#include "butee/record/element_forces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "butee/core/error.hpp"
#include "butee/model/element_choice.hpp"
#include "butee/model/parts_at.hpp"
#include "butee/model/turning_matrices.hpp"

namespace butee::record {
namespace {

using model::NodalDof;

void gather(const std::vector<Index>& dofs, ConstVectorRef from, Eigen::VectorXd& to) {
  for (std::size_t i = 0; i < dofs.size(); ++i) to[static_cast<Index>(i)] = dofs[i] >= 0 ? from[dofs[i]] : 0.0;
}

void sort_once(std::vector<Index>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
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
      add_springs({node, kind_of(quantity)}, element, column.sums.front());
      break;
    case model::Source::support:
      add_reaction({node, kind_of(quantity)}, column.sums.front());
      break;
    case model::Source::contacts:
      add_states(quantity, node, column.sums.front());
      break;
    case model::Source::stops:
      add_contacts({node, contact_kind(model_, node, quantity)}, 1.0, column.sums.front());
      break;
    case model::Source::motion:
      throw LogicError("no force of an element");
  }
  columns_.push_back(std::move(column));
}

bool ElementForces::turns(std::size_t element) const {
  return model_.rotation != nullptr && element < model_.turns.size() && model_.turns[element];
}

void ElementForces::add_section_force(model::Quantity quantity, model::NodeId node, const std::string& element,
                                      Column& column) {
  const model::CutChoice choice = choose_cut(model_, node, element);
  require(choice.beam != nullptr, "section forces of a beam");
  const model::SectionCut cut = choice.beam->cut(choice.part, choice.at_end).value();
  std::size_t number = 0;
  while (model_.elements[number].get() != choice.beam) ++number;
  const std::size_t piece = add_piece(cut.dofs, cut.matrices, turns(number));
  const auto fill = [&](Index row, Sum& sum) {
    const Eigen::VectorXd weights = cut.resultants.row(row);
    if (row == 0) sum.constant = cut.preload;
    if (weights.isZero(0.0)) return;
    sum.shares.push_back({piece, weights});
    add_loads_of_part(choice.beam, cut, weights, sum);
  };
  if (quantity != model::Quantity::von_mises) {
    fill(resultant_row(quantity).value(), column.sums.front());
    if (quantity == model::Quantity::bending_stress) column.factor = 1.0 / cut.modulus.value();
    return;
  }
  column.stress =
      FibreStress{cut.area, cut.modulus_y.value_or(1.0), cut.modulus.value(), cut.torsion_modulus.value_or(0.0)};
  column.sums.resize(4);
  for (const auto& [place, row] : {std::pair(0, 0), std::pair(1, 3), std::pair(2, 4), std::pair(3, 5)})
    fill(row, column.sums[static_cast<std::size_t>(place)]);
}

double ElementForces::FibreStress::of(std::span<const double> forces) const {
  const bool is_round = torsion_modulus > 0.0;
  const double bending = is_round ? std::hypot(forces[2], forces[3]) / modulus_z
                                  : std::abs(forces[2]) / modulus_y + std::abs(forces[3]) / modulus_z;
  const double sigma = std::abs(forces[0]) / area + bending, tau = is_round ? forces[1] / torsion_modulus : 0.0;
  return tau == 0.0 ? sigma : std::sqrt(sigma * sigma + 3.0 * tau * tau);
}

void ElementForces::add_loads_of_part(const model::Element* beam, const model::SectionCut& cut,
                                      const Eigen::VectorXd& weights, Sum& sum) {
  for (const model::Load& load : model_.loads) {
    if (load.line == beam)
      sum.loads.push_back(
          {load.in_time.get(), -load.per_length * weights.dot(cut.line_loads.col(axis_of(load.along)))});
    if (load.acceleration.isZero(0.0)) continue;
    Eigen::VectorXd translation = Eigen::VectorXd::Zero(weights.size());
    for (std::size_t i = 0; i < cut.dofs.size(); ++i)
      if (!is_rotation(cut.dofs[i].kind))
        translation[static_cast<Index>(i)] = load.acceleration[axis_of(cut.dofs[i].kind)];
    sum.loads.push_back({load.in_time.get(), -weights.dot(cut.matrices.mass * translation)});
  }
}

void ElementForces::need(Index obstacle) {
  obstacles_.push_back(obstacle);
  sort_once(obstacles_);
}

void ElementForces::add_contacts(NodalDof dof, double part, Sum& sum) {
  sum.contacts = contacts_on(model_, dynamics_.system().dofs, dof);
  sum.part = part;
  for (const ContactsOn::Obstacle& one : sum.contacts.obstacles) need(one.contact);
}

void ElementForces::add_states(model::Quantity quantity, model::NodeId node, Sum& sum) {
  sum.quantity = quantity;
  sum.states = obstacles_at(model_, dynamics_.system().dofs, node);
  for (const Index i : sum.states) need(i);
}

std::vector<Index> ElementForces::dofs() const {
  std::vector<Index> needed;
  if (!pieces_.empty() || (!obstacles_.empty() && dynamics_.obstacles()->has_rigid_friction())) {
    needed.resize(static_cast<std::size_t>(dynamics_.size()));
    std::iota(needed.begin(), needed.end(), Index{0});
    return needed;
  }
  const auto take = [&needed](Index dof) {
    if (dof >= 0) needed.push_back(dof);
  };
  for (const Index i : obstacles_)
    for (const auto& ends : {dynamics_.obstacles()->ends_of(i).a, dynamics_.obstacles()->ends_of(i).b})
      for (const Index dof : ends) take(dof);
  for (const Column& column : columns_)
    for (const Sum& sum : column.sums)
      for (const ContactsOn::Stop& stop : sum.contacts.stops)
        for (const Index dof : {dynamics_.stops().dof_a(stop.stop), dynamics_.stops().dof_b(stop.stop)}) take(dof);
  sort_once(needed);
  return needed;
}

void ElementForces::evaluate_contacts(double t, ConstVectorRef x, ConstVectorRef v) {
  if (obstacles_.empty()) return;
  dynamics::Obstacles& all = *dynamics_.obstacles();
  if (all.has_rigid_friction()) return dynamics_.contact_forces(t, x, v, contacts_);
  contacts_.resize(static_cast<std::size_t>(all.size()));
  for (const Index i : obstacles_) contacts_[static_cast<std::size_t>(i)] = all.forces(i, t, x, v);
}

double ElementForces::sum_of_states(const Sum& of) const {
  if (of.states.empty()) return 0.0;
  const dynamics::Obstacles& obstacles = *dynamics_.obstacles();
  const auto is_closed = [&](Index i, const dynamics::ContactForces& now) {
    if (obstacles.group_of(i).shape == nullptr) return true;
    return obstacles.is_live() ? now.penetration >= 0.0 : obstacles.phase(i).touches();
  };
  double sum = 0.0;
  for (const Index i : of.states) {
    const dynamics::ContactForces& now = contacts_[static_cast<std::size_t>(i)];
    switch (of.quantity) {
      case model::Quantity::contact_normal:
        sum += now.normal;
        break;
      case model::Quantity::contact_friction:
        sum += now.friction;
        break;
      case model::Quantity::contact_slip:
        if (is_closed(i, now) && now.normal >= 0.0) sum += now.slip_speed;
        break;
      default:
        sum += std::max(0.0, now.normal) * std::abs(now.slip_speed);
    }
  }
  return sum;
}

void ElementForces::add_springs(NodalDof dof, const std::string& element, Sum& sum) {
  for (std::size_t i = 0; i < model_.elements.size(); ++i)
    if (is_spring_on(model_, i, dof, element)) add_pieces_at(i, dof, -1.0, sum);
}

void ElementForces::add_reaction(NodalDof dof, Sum& sum) {
  for (std::size_t i = 0; i < model_.elements.size(); ++i) add_pieces_at(i, dof, 1.0, sum);
  const auto same = [&](NodalDof other) {
    return other.kind == dof.kind && model_.nodes.canonical(other.node) == model_.nodes.canonical(dof.node);
  };
  // A preload pulls at both ends of its part.
  for (const auto& element : model_.elements)
    for (Index part = 0; part < std::ssize(element->preload()); ++part)
      for (const bool at_end : {false, true}) {
        const std::optional<model::SectionCut> cut = element->cut(part, at_end);
        for (std::size_t i = 0; cut && cut->preload != 0.0 && i < cut->dofs.size(); ++i)
          if (same(cut->dofs[i])) sum.constant += cut->preload * cut->resultants(0, static_cast<Index>(i));
      }
  for (const model::Load& load : model_.loads) {
    for (const model::NodalValue& entry : load.pattern)
      if (same(entry.dof)) sum.loads.push_back({load.in_time.get(), -entry.value});
    if (load.acceleration.isZero(0.0)) continue;
    // The pattern omits forces on supports.
    double weight = 0.0;
    model::PartsAt parts(
        model_.nodes, dof, [&](std::span<const NodalDof> dofs, const model::ElementMatrices& matrices, Index row) {
          for (std::size_t j = 0; j < dofs.size(); ++j)
            if (!is_rotation(dofs[j].kind))
              weight -= matrices.mass(row, static_cast<Index>(j)) * load.acceleration[axis_of(dofs[j].kind)];
        });
    for (const auto& element : model_.elements) element->assemble(parts);
    sum.loads.push_back({load.in_time.get(), weight});
  }
  add_contacts(dof, -1.0, sum);
}

void ElementForces::add_pieces_at(std::size_t element, NodalDof dof, double sign, Sum& sum) {
  const bool turns = this->turns(element);
  model::PartsAt parts(
      model_.nodes, dof,
      [&](std::span<const NodalDof> dofs, const model::ElementMatrices& matrices, Index row) {
        Eigen::VectorXd weights = Eigen::VectorXd::Zero(std::ssize(dofs));
        weights[row] = sign;
        sum.shares.push_back({add_piece(dofs, matrices, turns), weights});
      },
      turns);
  model_.elements[element]->assemble(parts);
}

std::size_t ElementForces::add_piece(std::span<const NodalDof> dofs, const model::ElementMatrices& matrices,
                                     bool turns) {
  const model::System& system = dynamics_.system();
  const model::Damping& damping = system.damping;
  Piece piece;
  for (const NodalDof& dof : dofs) piece.dofs.push_back(system.dofs.index(dof));
  piece.mass = matrices.mass;
  piece.stiffness = matrices.stiffness;
  piece.damping = matrices.damping + damping.mass_proportional * matrices.mass +
                  damping.stiffness_proportional * matrices.stiffness;
  if (turns) {
    const Eigen::MatrixXd turning = model::rotating_damping_of(matrices, model_.rotating_damping);
    piece.damping += turning;
    piece.circulatory = model::circulatory_of(dofs, turning);
    piece.gyroscopic = matrices.gyroscopic.size() > 0 ? matrices.gyroscopic : Eigen::MatrixXd(0.0 * matrices.mass);
  }
  const bool is_still = model_.base_frame == model::BaseFrame::still;
  for (std::size_t i = 0; i < dofs.size() && is_still; ++i)
    for (const int order : {0, 1, 2})
      // Forces of stiffness and damping depend on the motion relative to the base, inertia forces
      // on the motion in space.
      for (const model::BaseShare& share : base_shares(model_, system.dofs, dofs[i], order, order == 2))
        piece.base.push_back({static_cast<Index>(i), order, share});
  piece.x = piece.v = piece.a = piece.p = Eigen::VectorXd::Zero(std::ssize(dofs));
  has_mass_ = has_mass_ || !piece.mass.isZero(0.0);
  pieces_.push_back(std::move(piece));
  return pieces_.size() - 1;
}

double ElementForces::force_of_stop(Index stop, ConstVectorRef x) {
  dynamics::ElasticStops& contact = dynamics_.stops();
  const Index a = contact.dof_a(stop), b = contact.dof_b(stop);
  return contact.force_of(stop, (a >= 0 ? x[a] : 0.0) - (b >= 0 ? x[b] : 0.0));
}

void ElementForces::evaluate_pieces(double t, ConstVectorRef x, ConstVectorRef v) {
  if (has_mass_) dynamics_.acceleration(t, x, v, a_);
  const double speed = model_.rotation != nullptr ? model_.rotation->speed(t) : 0.0;
  const double rate = model_.rotation != nullptr ? model_.rotation->acceleration(t) : 0.0;
  for (Piece& piece : pieces_) {
    gather(piece.dofs, x, piece.x);
    gather(piece.dofs, v, piece.v);
    if (has_mass_) gather(piece.dofs, a_, piece.a);
    for (const BaseTerm& term : piece.base) {
      Eigen::VectorXd& motion = term.order == 0 ? piece.x : term.order == 1 ? piece.v : piece.a;
      motion[term.place] += term.share.factor * term.share.motion->value(t);
    }
    piece.p.noalias() = piece.stiffness * piece.x;
    piece.p.noalias() += piece.damping * piece.v;
    if (has_mass_) piece.p.noalias() += piece.mass * piece.a;
    if (piece.gyroscopic.size() == 0) continue;
    piece.p.noalias() += speed * (piece.gyroscopic * piece.v);
    piece.p.noalias() += speed * (piece.circulatory * piece.x);
    piece.p.noalias() += rate * (piece.gyroscopic * piece.x);
  }
}

double ElementForces::value_of(const Sum& sum, double t, ConstVectorRef x) {
  double value = sum.constant;
  for (const Share& share : sum.shares) value += share.weights.dot(pieces_[share.piece].p);
  for (const LoadShare& load : sum.loads) value += load.weight * load.in_time->value(t);
  for (const ContactsOn::Stop& stop : sum.contacts.stops) value += sum.part * stop.sign * force_of_stop(stop.stop, x);
  for (const ContactsOn::Obstacle& one : sum.contacts.obstacles)
    value += sum.part * one.of(contacts_[static_cast<std::size_t>(one.contact)]);
  return value + sum_of_states(sum);
}

void ElementForces::evaluate(double t, ConstVectorRef x, ConstVectorRef v, std::span<double> values) {
  evaluate_pieces(t, x, v);
  evaluate_contacts(t, x, v);
  std::array<double, 4> forces{};
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const Column& column = columns_[i];
    for (std::size_t k = 0; k < column.sums.size(); ++k) forces[k] = value_of(column.sums[k], t, x);
    values[i] = column.stress ? column.stress->of(forces) : column.factor * forces[0];
  }
}

}  // namespace butee::record
