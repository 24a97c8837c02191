#include "butee/model/system.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/error.hpp"
#include "butee/model/matrix_collector.hpp"

namespace butee::model {
namespace {

/// Sets D and K for a constant speed, or the data from which Dynamics computes them at every
/// instant.
void apply_rotation(const Model& model, System& system) {
  const bool has_gyroscopic = system.gyroscopic.size() > 0, has_circulatory = system.circulatory.size() > 0;
  if (!has_gyroscopic && !has_circulatory) return;
  require(model.rotation != nullptr, "a rotation where parts turn");
  const double speed = model.rotation->speed(0.0);
  if (model.rotation->is_constant() && speed == 0.0) {
    system.gyroscopic = system.circulatory = {};
    return;
  }
  system.is_symmetric = false;
  system.stiffness_is_symmetric = system.stiffness_is_symmetric && !has_circulatory;
  if (system.dashpots.size() == 0) system.dashpots = 0.0 * system.mass;
  if (!model.rotation->is_constant()) {
    system.rotation = model.rotation.get();
    return;
  }
  if (has_gyroscopic) system.dashpots.coeffs() += speed * system.gyroscopic.coeffs();
  if (has_circulatory) {
    system.stiffness.coeffs() += speed * system.circulatory.coeffs();
    system.dashpots.coeffs() -= system.damping.stiffness_proportional * speed * system.circulatory.coeffs();
  }
  system.gyroscopic = system.circulatory = {};
}

FreeStops reduce(const StopGroup& group, const DofTable& dofs, Index& skipped) {
  FreeStops stops;
  stops.law = group.law.get();
  stops.play = group.play;
  for (std::size_t i = 0; i < group.a.size(); ++i) {
    const Index a = dofs.index({group.a[i], group.dof});
    const Index b = group.b.empty() ? FreeStops::kGround : dofs.index({group.b[i], group.dof});
    if (a < 0 && b < 0) {
      ++skipped;
      continue;
    }
    stops.a.push_back(std::max(a, FreeStops::kGround));
    stops.b.push_back(std::max(b, FreeStops::kGround));
  }
  return stops;
}

FreeObstacles reduce(const ObstacleGroup& group, const DofTable& dofs, const NodeTable& nodes, Index& skipped) {
  FreeObstacles free;
  free.group = &group;
  for (std::size_t i = 0; i < group.a.size(); ++i) {
    FreeObstacles::Ends ends;
    ends.a.fill(FreeStops::kGround);
    ends.b.fill(FreeStops::kGround);
    bool moves = false;
    for (std::size_t k = 0; k < group.directions.size(); ++k) {
      ends.a[k] = std::max(dofs.index({group.a[i], group.directions[k]}), FreeStops::kGround);
      if (!group.b.empty()) ends.b[k] = std::max(dofs.index({group.b[i], group.directions[k]}), FreeStops::kGround);
      moves = moves || ends.a[k] >= 0 || ends.b[k] >= 0;
    }
    if (group.twists()) {
      ends.a[2] = std::max(dofs.index({group.a[i], DofKind::rx}), FreeStops::kGround);
      if (!group.b.empty()) ends.b[2] = std::max(dofs.index({group.b[i], DofKind::rx}), FreeStops::kGround);
      moves = moves || ends.a[2] >= 0 || ends.b[2] >= 0;
    }
    if (!moves) {
      ++skipped;
      continue;
    }
    free.ends.push_back(ends);
    std::string& name = free.names.emplace_back(nodes.name(group.a[i]));
    if (!group.b.empty()) name.append("|").append(nodes.name(group.b[i]));
  }
  return free;
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

std::vector<FreeLoad> reduce_loads(const Model& model, const DofTable& dofs, Index& skipped) {
  std::vector<FreeLoad> all;
  for (const Load& load : model.loads) {
    FreeLoad free = reduce(load, dofs);
    if (free.dofs.empty() || free.in_time->vanishes())
      ++skipped;
    else
      all.push_back(std::move(free));
  }
  return all;
}

void set_start(const Model& model, System& system) {
  const Vector zero = Vector::Zero(system.dofs.free_count());
  const InitialMotion start = model.initial_motion.value_or(InitialMotion{zero, zero, 0.0});
  require(start.displacement.size() == zero.size() && start.velocity.size() == zero.size(),
          "an initial motion of every free DOF");
  system.initial_displacement = initial_vector(start.displacement, model.initial_displacement, system.dofs);
  system.initial_velocity = initial_vector(start.velocity, model.initial_velocity, system.dofs);
  system.initial_contact = start.contact;
  system.initial_time = start.time;
  // The given motion is relative to the base.
  system.initial_displacement += motion_with_base(model, system.dofs, 0, system.initial_time);
  system.initial_velocity += motion_with_base(model, system.dofs, 1, system.initial_time);
}

}  // namespace

std::vector<std::string> contact_names(const Model& model, const DofTable& dofs) {
  std::vector<std::string> names;
  Index skipped = 0;
  for (const ObstacleGroup& group : model.obstacles)
    for (const std::string& name : reduce(group, dofs, model.nodes, skipped).names) {
      names.push_back(group.kind + " " + name);
      for (const DofKind along : group.directions)
        names.back().append(1, ' ').append(std::to_string(static_cast<int>(along)));
      names.back().append(1, ' ').append(std::to_string(static_cast<int>(group.friction.rule)));
    }
  return names;
}

DofTable number_dofs(const Model& model) {
  DofTable dofs(model.nodes);
  for (const auto& element : model.elements) element->claim(dofs);
  for (const auto& element : model.elements) element->claim_shared(dofs);
  for (const NodalDof& dof : model.fixed) dofs.fix(dof);
  dofs.number();
  return dofs;
}

std::vector<NodalValue> inertia_pattern(const Model& model, const Eigen::Vector3d& acceleration) {
  /// Sums M r of the elements at the nodes.
  class Sum final : public MatrixSink {
   public:
    Sum(const NodeTable& nodes, const Eigen::Vector3d& r)
        : nodes_(nodes), r_(r), forces(static_cast<std::size_t>(nodes.size())) {}
    void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override {
      for (std::size_t j = 0; j < dofs.size(); ++j) {
        if (is_rotation(dofs[j].kind)) continue;
        const double r = r_[axis_of(dofs[j].kind)];
        for (std::size_t i = 0; i < dofs.size() && r != 0.0; ++i)
          forces[static_cast<std::size_t>(nodes_.canonical(dofs[i].node))][static_cast<std::size_t>(dofs[i].kind)] +=
              matrices.mass(static_cast<Index>(i), static_cast<Index>(j)) * r;
      }
    }

   private:
    const NodeTable& nodes_;
    const Eigen::Vector3d& r_;

   public:
    std::vector<std::array<double, kDofKinds>> forces;
  };
  Sum sum(model.nodes, acceleration);
  for (const auto& element : model.elements) element->assemble(sum);
  const DofTable dofs = number_dofs(model);
  std::vector<NodalValue> pattern;
  for (const NodalDof& dof : dofs.free())
    if (const double force = sum.forces[static_cast<std::size_t>(dof.node)][static_cast<std::size_t>(dof.kind)];
        force != 0.0)
      pattern.push_back({dof, force});
  return pattern;
}

System assemble(const Model& model, TurningParts turning) {
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
  for (const ObstacleGroup& group : model.obstacles) {
    FreeObstacles free = reduce(group, dofs, model.nodes, system.skipped_stops);
    if (!free.ends.empty()) system.obstacles.push_back(std::move(free));
  }
  MatrixCollector sink(dofs, model.rotating_damping);
  for (std::size_t i = 0; i < model.elements.size(); ++i) {
    sink.begin_element(model.rotation != nullptr && i < model.turns.size() && model.turns[i]);
    model.elements[i]->assemble(sink);
  }
  for (const FreeStops& stops : system.stops)
    for (std::size_t i = 0; i < stops.size(); ++i) {
      if (stops.a[i] < 0 || stops.b[i] < 0) continue;
      sink.add_place(stops.a[i], stops.b[i]);
      sink.add_place(stops.b[i], stops.a[i]);
    }
  sink.build(system);
  system.damping = model.damping;
  if (turning == TurningParts::included) apply_rotation(model, system);

  system.loads = reduce_loads(model, dofs, system.skipped_loads);
  set_start(model, system);
  return system;
}

bool replace_loads(const Model& model, System& system) {
  if (!model.obstacles.empty() || !system.obstacles.empty()) return false;
  Index skipped_stops = 0, skipped_loads = 0;
  std::vector<FreeStops> stops;
  for (const StopGroup& group : model.stops)
    if (FreeStops free = reduce(group, system.dofs, skipped_stops); free.size() > 0) stops.push_back(std::move(free));
  std::vector<FreeLoad> loads = reduce_loads(model, system.dofs, skipped_loads);
  const bool same_stops = std::equal(stops.begin(), stops.end(), system.stops.begin(), system.stops.end(),
                                     [](const FreeStops& a, const FreeStops& b) { return a.a == b.a && a.b == b.b; });
  const bool same_loads =
      std::equal(loads.begin(), loads.end(), system.loads.begin(), system.loads.end(),
                 [](const FreeLoad& a, const FreeLoad& b) { return a.dofs == b.dofs && a.weights == b.weights; });
  if (!same_stops || !same_loads) return false;
  system.stops = std::move(stops);
  system.loads = std::move(loads);
  system.skipped_stops = skipped_stops;
  system.skipped_loads = skipped_loads;
  system.model = &model;
  set_start(model, system);
  return true;
}

}  // namespace butee::model
