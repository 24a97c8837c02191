#include "butee/model/system.hpp"

#include <algorithm>

#include "butee/core/error.hpp"

namespace butee::model {
namespace {

using Triplet = Eigen::Triplet<double>;

/// Collects M, K and D with one common sequence of places, so that the three get one pattern.
class TripletSink final : public MatrixSink {
 public:
  explicit TripletSink(const DofTable& dofs) : dofs_(dofs) {}

  void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override {
    for (std::size_t j = 0; j < dofs.size(); ++j) {
      const Index column = dofs_.index(dofs[j]);
      if (column < 0) continue;
      for (std::size_t i = 0; i < dofs.size(); ++i) {
        const Index row = dofs_.index(dofs[i]);
        if (row < 0) continue;
        const auto p = static_cast<Index>(i), q = static_cast<Index>(j);
        add_entry(row, column, matrices.mass(p, q), matrices.stiffness(p, q), matrices.damping(p, q));
      }
    }
  }

  void add_place(Index row, Index column) { add_entry(row, column, 0.0, 0.0, 0.0); }

  void build(System& system) {
    const Index n = dofs_.free_count();
    const auto make = [n](std::vector<Triplet>& triplets) {
      SparseMatrix matrix(n, n);
      matrix.setFromTriplets(triplets.begin(), triplets.end());
      triplets = {};
      return matrix;
    };
    system.mass = make(mass_);
    system.stiffness = make(stiffness_);
    if (has_dashpots_) system.dashpots = make(dashpots_);
  }

 private:
  void add_entry(Index row, Index column, double m, double k, double c) {
    const int i = static_cast<int>(row), j = static_cast<int>(column);
    if (c != 0.0 && !has_dashpots_) {
      has_dashpots_ = true;
      for (const Triplet& place : mass_) dashpots_.emplace_back(place.row(), place.col(), 0.0);
    }
    mass_.emplace_back(i, j, m);
    stiffness_.emplace_back(i, j, k);
    if (has_dashpots_) dashpots_.emplace_back(i, j, c);
  }

  const DofTable& dofs_;
  std::vector<Triplet> mass_, stiffness_, dashpots_;
  bool has_dashpots_ = false;
};

FreeStops reduce(const StopGroup& group, const DofTable& dofs, Index& skipped) {
  FreeStops stops;
  stops.law = group.law.get();
  stops.gap = group.gap;
  stops.sides = group.sides;
  for (std::size_t i = 0; i < group.a.size(); ++i) {
    const Index a = dofs.index({group.a[i], DofKind::u});
    const Index b = group.b.empty() ? FreeStops::kGround : dofs.index({group.b[i], DofKind::u});
    if (a < 0 && b < 0) {
      ++skipped;
      continue;
    }
    stops.a.push_back(std::max(a, FreeStops::kGround));
    stops.b.push_back(std::max(b, FreeStops::kGround));
  }
  return stops;
}

FreeLoad reduce(const Load& load, const DofTable& dofs) {
  FreeLoad free;
  free.in_time = load.in_time.get();
  for (const NodalValue& entry : load.pattern) {
    const Index dof = dofs.index(entry.dof);
    if (dof == DofTable::kAbsent)
      throw InputError("a load acts on " + dofs.name(entry.dof) + ", which no element uses");
    if (dof < 0 || entry.value == 0.0) continue;
    free.dofs.push_back(dof);
    free.weights.push_back(entry.value);
  }
  return free;
}

Vector initial_vector(Vector x, const std::vector<NodalValue>& values, const DofTable& dofs) {
  for (const NodalValue& entry : values) {
    const Index dof = dofs.index(entry.dof);
    if (dof < 0) throw InputError("an initial value is given for " + dofs.name(entry.dof) + ", which is not free");
    x[dof] = entry.value;
  }
  return x;
}

}  // namespace

DofTable number_dofs(const Model& model) {
  DofTable dofs(model.nodes);
  for (const auto& element : model.elements) element->claim(dofs);
  for (const NodalDof& dof : model.fixed) dofs.fix(dof);
  dofs.number();
  return dofs;
}

System assemble(const Model& model) {
  System system(number_dofs(model));
  system.model = &model;
  const DofTable& dofs = system.dofs;
  if (dofs.free_count() == 0) throw InputError("nothing can move: the model has no free degree of freedom");
  for (const NodalDof& dof : dofs.free())
    if (!dofs.has_mass(dof))
      throw InputError("the free " + dofs.name(dof) + " has no mass: give it one, or fix it with a [[support]]");

  for (const StopGroup& group : model.stops) {
    FreeStops stops = reduce(group, dofs, system.skipped_stops);
    if (stops.size() > 0) system.stops.push_back(std::move(stops));
  }
  TripletSink sink(dofs);
  for (const auto& element : model.elements) element->assemble(sink);
  for (const FreeStops& stops : system.stops)
    for (std::size_t i = 0; i < stops.size(); ++i) {
      if (stops.a[i] < 0 || stops.b[i] < 0) continue;
      sink.add_place(stops.a[i], stops.b[i]);
      sink.add_place(stops.b[i], stops.a[i]);
    }
  sink.build(system);
  system.damping = model.damping;

  for (const Load& load : model.loads) {
    FreeLoad free = reduce(load, dofs);
    if (free.dofs.empty() || free.in_time->vanishes())
      ++system.skipped_loads;
    else
      system.loads.push_back(std::move(free));
  }
  const Vector zero = Vector::Zero(dofs.free_count());
  const InitialMotion start = model.initial_motion.value_or(InitialMotion{zero, zero, 0.0});
  require(start.displacement.size() == zero.size() && start.velocity.size() == zero.size(),
          "an initial motion of every free DOF");
  system.initial_displacement = initial_vector(start.displacement, model.initial_displacement, dofs);
  system.initial_velocity = initial_vector(start.velocity, model.initial_velocity, dofs);
  system.initial_time = start.time;
  return system;
}

}  // namespace butee::model
