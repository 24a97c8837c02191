#include "butee/dynamics/dynamics.hpp"

#include "butee/core/error.hpp"
#include "butee/dynamics/dynamics_parts.hpp"
#include "butee/dynamics/free_motion.hpp"

namespace butee::dynamics {
namespace {

using From = InternalForces::From;

void clear(VectorRef y) {
  if (y.size() == 1)
    y[0] = 0.0;
  else
    y.setZero();
}

}  // namespace

Dynamics::Parts::Parts(const model::System& system)
    : stops(system, counters),
      obstacles(system.obstacles.empty() ? nullptr : std::make_unique<Obstacles>(system, counters)),
      loads(system),
      internal(system),
      has_stops(block_count(system.size())),
      contact_force(zeros(stops.size() > 0 ? system.size() : 0)),
      stop_displacement(Vector::Zero(stops.size())),
      stop_velocity(stop_displacement),
      stop_force(stop_displacement) {
  has_loads = has_stops;
  const auto mark = [&system](std::vector<bool>& blocks, Index dof) {
    if (dof >= 0) blocks[block_of(dof, system.size())] = true;
  };
  for (Index i = 0; i < stops.size(); ++i)
    for (const Index dof : {stops.dof_a(i), stops.dof_b(i)}) mark(has_stops, dof);
  for (const ExternalForces::Entry& entry : loads.entries()) mark(has_loads, entry.dof);
  if (obstacles && obstacles->has_rigid_friction()) sticks.emplace(*obstacles);
}

Dynamics::Dynamics(const model::System& system)
    : system_(system),
      parts_(std::make_unique<Parts>(system)),
      counters_(&parts_->counters),
      stops_(&parts_->stops),
      obstacles_(parts_->obstacles.get()) {
  if (parts_->sticks) parts_->sticks->check_supports(mass_solver());
}

Dynamics::~Dynamics() = default;

bool Dynamics::has_damping() const {
  return parts_->internal.has_damping();
}

void Dynamics::set_time(double t) {
  if (Turning* turning = parts_->internal.turning()) turning->set_time(t);
}

void Dynamics::subtract_matrix_rate(ConstVectorRef x, ConstVectorRef v, VectorRef rate) const {
  if (const Turning* turning = parts_->internal.turning()) turning->subtract_rate(x, v, rate);
}

void Dynamics::loads_changed() {
  parts_->loads.changed();
}

void Dynamics::loads_replaced() {
  parts_->stops = ElasticStops(system_, *counters_);
  parts_->loads.replaced();
  if (parts_->modal) parts_->modal->replace_loads(*this);
}

void Dynamics::external_force(double t, VectorRef force) {
  set_time(t);
  clear(force);
  parts_->loads.add(t, 0.0, force);
}

void Dynamics::external_force_rate(double t, double h, VectorRef rate) {
  parts_->loads.rate(t, h, rate);
}

std::vector<double> Dynamics::load_discontinuities() const {
  return parts_->loads.discontinuities();
}

bool Dynamics::loads_jump(double t) const {
  return parts_->loads.jump_at(t);
}

void Dynamics::add_contact_force(ConstVectorRef x, VectorRef force) {
  if (stop_count() == 0) return;
  stops_->displacement(x, parts_->stop_displacement);
  stops_->force(parts_->stop_displacement, parts_->stop_force);
  stops_->scatter(parts_->stop_force, force);
}

void Dynamics::elastic_force(ConstVectorRef x, VectorRef y) const {
  parts_->internal.elastic(x, y);
}

void Dynamics::inertia_force(ConstVectorRef a, VectorRef y) const {
  parts_->internal.inertia(a, y);
}

void Dynamics::damping_force(ConstVectorRef v, VectorRef y) {
  parts_->internal.damping(v, y);
}

void Dynamics::total_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef r) {
  total_force(t, 0.0, x, v, r);
}

void Dynamics::total_force(double t, double after, ConstVectorRef x, ConstVectorRef v, VectorRef r) {
  set_time(t + after);
  ++counters_->force_evaluations;
  clear(r);
  parts_->loads.add(t, after, r);
  add_contact_force(x, r);
  add_obstacle_force(t + after, x, v, r);
  parts_->internal.subtract(x, v, r);
}

void Dynamics::acceleration(double t, ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  acceleration(t, 0.0, x, v, a);
}

void Dynamics::acceleration(double t, double after, ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  set_time(t + after);
  ++counters_->force_evaluations;
  parts_->internal.subtract_from(From::nothing, x, v, a);
  parts_->loads.add(t, after, a);
  add_contact_force(x, a);
  add_obstacle_force(t + after, x, v, a);
  solve_mass(v, a);
  hold_sticks(t + after, a);
}

void Dynamics::solve_acceleration(ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  ++counters_->force_evaluations;
  parts_->internal.subtract_from(From::given, x, v, a);
  solve_mass(v, a);
}

void Dynamics::solve_mass(ConstVectorRef v, VectorRef a) {
  if (size() == 1) return mass_solver().solve(a);
  mass_solver().solve_less(a, system_.damping.mass_proportional, v);
  if (const ModalDamping* modal = parts_->internal.modal()) modal->subtract_deceleration(v, a);
}

linalg::LinearSolver& Dynamics::mass_solver() {
  auto& solver = parts_->mass_solver;
  if (!solver) {
    solver.emplace(system_.mass, *counters_);
    if (!solver->factorize(system_.mass))
      throw InputError(
          "the mass matrix is not positive definite: no mass, or too small a mass relative to the others, resists the "
          "motion of " +
          describe_softest_motion(system_.mass, system_.dofs) + "; check the masses and sections there");
  }
  return *solver;
}

void Dynamics::hold_sticks(std::optional<double> t, VectorRef a) {
  if (parts_->sticks) parts_->sticks->hold(t, mass_solver(), a);
}

void Dynamics::stop_sliding(double t, VectorRef v) {
  if (parts_->sticks) parts_->sticks->stop(t, mass_solver(), v);
}

const Vector& Dynamics::stick_forces(double t, ConstVectorRef x, ConstVectorRef v) {
  if (!parts_->sticks) throw LogicError("stick_forces() needs contacts that stick rigidly");
  parts_->sticks->clear();
  parts_->stick_acceleration.resize(size());
  acceleration(t, x, v, parts_->stick_acceleration);
  return parts_->sticks->forces();
}

void Dynamics::contact_forces(double t, ConstVectorRef x, ConstVectorRef v, std::vector<ContactForces>& all) {
  all.resize(static_cast<std::size_t>(obstacles_->size()));
  for (Index i = 0; i < obstacles_->size(); ++i) all[static_cast<std::size_t>(i)] = obstacles_->forces(i, t, x, v);
  const std::vector<Index> sticks = obstacles_->rigid_sticks();
  if (sticks.empty()) return;
  const Vector& held = stick_forces(t, x, v);
  for (std::size_t k = 0; k < sticks.size(); ++k) {
    ContactForces& forces = all[static_cast<std::size_t>(sticks[k])];
    forces.friction = -held[static_cast<Index>(k)];
    forces.force -= forces.friction * obstacles_->tangent_of(sticks[k]).head<2>();
  }
}

void Dynamics::add_held_contact_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef force) {
  add_contact_force(x, force);
  if (obstacles_ == nullptr) return;
  std::vector<ContactForces> all;
  contact_forces(t, x, v, all);
  for (std::size_t i = 0; i < all.size(); ++i) obstacles_->scatter(static_cast<Index>(i), all[i].along_all(), force);
}

EffectiveSolver& Dynamics::effective() {
  auto& solver = parts_->effective;
  if (!solver) solver.emplace(system_, *stops_, *counters_, parts_->internal.modal(), parts_->internal.turning());
  return *solver;
}

ModalSystem& Dynamics::modal(Index count) {
  if (!parts_->modal) parts_->modal = std::make_unique<ModalSystem>(*this, count);
  return *parts_->modal;
}

std::string Dynamics::dof_name(Index dof) const {
  return system_.dofs.name(system_.dofs.free()[static_cast<std::size_t>(dof)]);
}

}  // namespace butee::dynamics
