#include "butee/dynamics/dynamics.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/Cholesky>

#include "butee/core/blocks.hpp"
#include "butee/core/error.hpp"
#include "butee/core/zeros.hpp"
#include "butee/dynamics/free_motion.hpp"

namespace butee::dynamics {
namespace {

void clear(VectorRef y) {
  if (y.size() == 1)
    y[0] = 0.0;
  else
    y.setZero();
}

}  // namespace

Dynamics::Dynamics(const model::System& system)
    : system_(system),
      stops_(system, counters_),
      obstacles_(system.obstacles.empty() ? nullptr : std::make_unique<Obstacles>(system, counters_)),
      modal_(ModalDamping::of(system)),
      has_damping_(system.damping.is_rayleigh() || system.dashpots.size() > 0 || modal_ != nullptr),
      turning_(system.rotation != nullptr ? std::make_unique<Turning>(system) : nullptr),
      mass_product_(system.mass),
      stiffness_product_(system.stiffness, system.stiffness_is_symmetric),
      load_time_(std::numeric_limits<double>::quiet_NaN()),
      load_values_(system.loads.size()),
      contact_force_(zeros(stops_.size() > 0 ? system.size() : 0)),
      stop_displacement_(Vector::Zero(stops_.size())),
      stop_velocity_(stop_displacement_),
      stop_force_(stop_displacement_),
      other_vector_(Vector::Zero(turning_ ? system.size() : 0)),
      turning_damping_(other_vector_),
      turning_inertia_(other_vector_),
      shifted_(zeros(system.damping.is_rayleigh() ? system.size() : 0)),
      modal_force_(Vector::Zero(modal_ ? system.size() : 0)),
      work_(Vector::Zero(std::min(system.size(), kLargestBlock))),
      other_(work_),
      inertia_(work_),
      damping_(work_) {
  has_stops_.resize(block_count(size()));
  has_loads_ = has_stops_;
  const auto mark = [this](std::vector<bool>& blocks, Index dof) {
    if (dof >= 0) blocks[block_of(dof, size())] = true;
  };
  for (Index i = 0; i < stop_count(); ++i)
    for (const Index dof : {stops_.dof_a(i), stops_.dof_b(i)}) mark(has_stops_, dof);
  if (system.dashpots.size() > 0) dashpot_product_ = linalg::SymmetricProduct(system.dashpots, system.is_symmetric);
  if (modal_ && !system.is_symmetric)
    throw InputError(
        "modal damping is that of the modes of symmetric matrices, but shafts turn here or bearings have cross terms; "
        "give mass_proportional and stiffness_proportional, or damping of bearings and springs");
  if (size() == 1)
    single_damping_ = system.damping.mass_proportional * system.mass.coeff(0, 0) +
                      system.damping.stiffness_proportional * system.stiffness.coeff(0, 0) +
                      (system.dashpots.size() > 0 ? system.dashpots.coeff(0, 0) : 0.0) +
                      (modal_ ? modal_->single() : 0.0);
  for (std::size_t j = 0; j < system.loads.size(); ++j)
    for (std::size_t i = 0; i < system.loads[j].dofs.size(); ++i)
      loaded_dofs_.push_back({system.loads[j].dofs[i], system.loads[j].weights[i], j});
  for (const LoadedDof& part : loaded_dofs_) mark(has_loads_, part.dof);
}

void Dynamics::loads_replaced() {
  stops_ = ElasticStops(system_, counters_);
  loads_changed();
  if (modal_system_) modal_system_->replace_loads(*this);
}

void Dynamics::external_force(double t, VectorRef force) {
  clear(force);
  add_external_force(t, force);
}

void Dynamics::add_external_force(double t, VectorRef force) {
  set_time(t);
  if (t != load_time_) {
    for (std::size_t i = 0; i < load_values_.size(); ++i) load_values_[i] = system_.loads[i].in_time->value(t);
    load_time_ = t;
  }
  for (const LoadedDof& part : loaded_dofs_) force[part.dof] += part.weight * load_values_[part.load];
}

void Dynamics::external_force_rate(double t, double h, VectorRef rate) {
  rate.setZero();
  for (const model::FreeLoad& load : system_.loads) {
    double slope = 0.0;
    if (load.in_time->taylor(t, 1.0, load_series_))
      slope = load_series_[1];
    else
      slope = (load.in_time->value(t + h) - load.in_time->value(t)) / h;
    for (std::size_t i = 0; i < load.dofs.size(); ++i) rate[load.dofs[i]] += load.weights[i] * slope;
  }
}

void Dynamics::add_contact_force(ConstVectorRef x, VectorRef force) {
  if (stop_count() == 0) return;
  stops_.displacement(x, stop_displacement_);
  stops_.force(stop_displacement_, stop_force_);
  stops_.scatter(stop_force_, force);
}

void Dynamics::elastic_force(ConstVectorRef x, VectorRef y) const {
  stiffness_product_.multiply(x.data(), y.data());
  if (turning_) turning_->add_elastic_force(x, y);
}
void Dynamics::inertia_force(ConstVectorRef a, VectorRef y) const {
  mass_product_.multiply(a.data(), y.data());
}

void Dynamics::damping_force(ConstVectorRef v, VectorRef y) {
  in_blocks(size(), [&](Index begin, Index count) { damping_rows(v, begin, count, y.data() + begin); });
  if (modal_) modal_->add_force(v, y);
  if (turning_) turning_->add_damping_force(v, y);
}

void Dynamics::damping_rows(ConstVectorRef v, Index begin, Index count, double* y) {
  const double on_mass = system_.damping.mass_proportional, on_stiffness = system_.damping.stiffness_proportional;
  Eigen::Map<Vector> sum(y, count);
  if (on_mass != 0.0) {
    mass_product_.multiply(v.data(), begin, count, y);
    sum *= on_mass;
  } else {
    sum.setZero();
  }
  if (on_stiffness != 0.0) {
    stiffness_product_.multiply(v.data(), begin, count, other_.data());
    sum += on_stiffness * other_.head(count);
  }
  if (system_.dashpots.size() > 0) {
    dashpot_product_.multiply(v.data(), begin, count, other_.data());
    sum += other_.head(count);
  }
}

void Dynamics::subtract_internal_force(ConstVectorRef x, ConstVectorRef v, VectorRef r) {
  if (size() == 1) {
    r[0] -= single_damping_ * v[0] + stiffness_product_.first() * x[0];
    return;
  }
  const bool has_local_damping = has_damping_ && !modal_;
  in_blocks(size(), [&](Index begin, Index count) {
    auto rows = r.segment(begin, count);
    stiffness_product_.multiply(x.data(), begin, count, work_.data());
    rows -= work_.head(count);
    if (!has_local_damping) return;
    damping_rows(v, begin, count, damping_.data());
    rows -= damping_.head(count);
  });
  if (turning_) {
    other_vector_.setZero();
    turning_->add_elastic_force(x, other_vector_);
    turning_->add_damping_force(v, other_vector_);
    r -= other_vector_;
  }
  if (!modal_) return;
  damping_force(v, modal_force_);
  r -= modal_force_;
}

void Dynamics::subtract_products(From from, const double* x, double velocity_factor, ConstVectorRef v, VectorRef r) {
  in_blocks(size(), [&](Index begin, Index count) {
    auto rows = r.segment(begin, count);
    const auto product = work_.head(count);
    stiffness_product_.multiply(x, begin, count, work_.data());
    if (from == From::nothing)
      rows = -product;
    else
      rows -= product;
    if (system_.dashpots.size() == 0) return;
    dashpot_product_.multiply(v.data(), begin, count, work_.data());
    rows -= velocity_factor * product;
  });
  if (turning_) turning_->subtract_forces(x, velocity_factor, v, r);
}

const double* Dynamics::shifted(ConstVectorRef x, double shift, ConstVectorRef v) {
  if (shift == 0.0) return x.data();
  shifted_ = x + shift * v;
  return shifted_.data();
}

void Dynamics::total_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef r) {
  ++counters_.force_evaluations;
  external_force(t, r);
  add_contact_force(x, r);
  add_obstacle_force(t, x, v, r);
  subtract_internal_force(x, v, r);
}

void Dynamics::acceleration(double t, ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  set_time(t);
  subtract_from(From::nothing, x, v, a);
  add_external_force(t, a);
  add_contact_force(x, a);
  add_obstacle_force(t, x, v, a);
  solve_mass(v, a);
  if (obstacles_ && obstacles_->has_rigid_friction()) hold_sticks(t, a);
}

bool Dynamics::prepare_sticks() {
  std::vector<Index> sticks = obstacles_->rigid_sticks();
  if (sticks.empty() || sticks == sticks_) return !sticks.empty();
  const auto count = static_cast<Index>(sticks.size());
  sticks_ = std::move(sticks);
  stick_motion_ = Eigen::MatrixXd::Zero(size(), count);
  stick_compliance_.resize(count, count);
  for (Index j = 0; j < count; ++j) {
    const Index contact = sticks_[static_cast<std::size_t>(j)];
    obstacles_->scatter(contact, obstacles_->tangent_of(contact), stick_motion_.col(j));
    mass_solver().solve(stick_motion_.col(j));
  }
  for (Index i = 0; i < count; ++i) {
    const Index contact = sticks_[static_cast<std::size_t>(i)];
    for (Index j = 0; j < count; ++j)
      stick_compliance_(i, j) = obstacles_->tangent_of(contact).dot(obstacles_->gather(contact, stick_motion_.col(j)));
  }
  return true;
}

void Dynamics::solve_sticks(VectorRef y) {
  stick_force_ = Eigen::LLT<Eigen::MatrixXd>(stick_compliance_).solve(stick_force_).eval();
  y += stick_motion_ * stick_force_;
}

void Dynamics::hold_sticks(double t, VectorRef a) {
  if (!obstacles_->has_rigid_friction() || !prepare_sticks()) return;
  stick_force_.resize(static_cast<Index>(sticks_.size()));
  for (Index i = 0; i < stick_force_.size(); ++i) {
    const Index contact = sticks_[static_cast<std::size_t>(i)];
    stick_force_[i] = -obstacles_->surface_acceleration(contact, t) -
                      obstacles_->tangent_of(contact).dot(obstacles_->gather(contact, a));
  }
  solve_sticks(a);
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
    const Obstacles::Coordinates tangent = obstacles_->tangent_of(sticks[k]);
    forces.force -= forces.friction * tangent.head<2>();
    forces.torque -= forces.friction * tangent[2];
  }
}

void Dynamics::stop_sliding(double t, VectorRef v) {
  if (!obstacles_ || !prepare_sticks()) return;
  stick_force_.resize(static_cast<Index>(sticks_.size()));
  for (Index i = 0; i < stick_force_.size(); ++i)
    stick_force_[i] = -obstacles_->forces(sticks_[static_cast<std::size_t>(i)], t, v, v).slip_speed;
  solve_sticks(v);
}

const Vector& Dynamics::stick_forces(double t, ConstVectorRef x, ConstVectorRef v) {
  stick_force_.resize(0);
  stick_acceleration_.resize(size());
  acceleration(t, x, v, stick_acceleration_);
  return stick_force_;
}

void Dynamics::solve_acceleration(ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  subtract_from(From::given, x, v, a);
  solve_mass(v, a);
}

void Dynamics::subtract_from(From from, ConstVectorRef x, ConstVectorRef v, VectorRef r) {
  ++counters_.force_evaluations;
  if (size() == 1)
    r[0] = (from == From::given ? r[0] : 0.0) - (single_damping_ * v[0] + stiffness_product_.first() * x[0]);
  else
    subtract_products(from, shifted(x, system_.damping.stiffness_proportional, v), 1.0, v, r);
}

void Dynamics::solve_mass(ConstVectorRef v, VectorRef a) {
  if (size() == 1) return mass_solver().solve(a);
  mass_solver().solve_less(a, system_.damping.mass_proportional, v);
  if (modal_) modal_->subtract_deceleration(v, a);
}

linalg::LinearSolver& Dynamics::mass_solver() {
  if (!mass_solver_) {
    mass_solver_.emplace(system_.mass, counters_);
    if (!mass_solver_->factorize(system_.mass))
      throw InputError(
          "the mass matrix is not positive definite: no mass, or too little beside the others, resists the motion of " +
          describe_softest_motion(system_.mass, system_.dofs) + "; check the masses and sections there");
  }
  return *mass_solver_;
}

EffectiveSolver& Dynamics::effective() {
  if (!effective_) effective_.emplace(system_, stops_, counters_, modal_.get(), turning_.get());
  return *effective_;
}

ModalSystem& Dynamics::modal(Index count) {
  if (!modal_system_) modal_system_ = std::make_unique<ModalSystem>(*this, count);
  return *modal_system_;
}

std::vector<double> Dynamics::load_discontinuities() const {
  std::vector<double> all;
  for (const model::FreeLoad& load : system_.loads) {
    const auto instants = load.in_time->discontinuities();
    all.insert(all.end(), instants.begin(), instants.end());
  }
  if (system_.rotation != nullptr) {
    const auto instants = system_.rotation->discontinuities();
    all.insert(all.end(), instants.begin(), instants.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::string Dynamics::dof_name(Index dof) const {
  return system_.dofs.name(system_.dofs.free()[static_cast<std::size_t>(dof)]);
}

}  // namespace butee::dynamics
