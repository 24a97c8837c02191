#include "butee/solve/dynamics.hpp"

#include <algorithm>
#include <limits>

#include "butee/core/error.hpp"
#include "butee/solve/force_balance.hpp"
#include "butee/solve/free_motion.hpp"

namespace butee::solve {
Dynamics::Dynamics(const model::System& system)
    : system_(system),
      contact_(system, counters_),
      modal_(ModalDamping::of(system)),
      has_damping_(system.damping.is_rayleigh() || system.dashpots.size() > 0 || modal_ != nullptr),
      mass_product_(system.mass),
      stiffness_product_(system.stiffness),
      load_time_(std::numeric_limits<double>::quiet_NaN()),
      load_values_(system.loads.size()),
      work_(Vector::Zero(system.size())),
      other_(work_),
      inertia_(work_),
      damping_(work_),
      contact_force_(work_),
      stop_displacement_(Vector::Zero(contact_.size())),
      stop_force_(stop_displacement_) {
  if (system.dashpots.size() > 0) dashpot_product_ = SymmetricProduct(system.dashpots);
  if (size() == 1)
    single_damping_ = system.damping.mass_proportional * system.mass.coeff(0, 0) +
                      system.damping.stiffness_proportional * system.stiffness.coeff(0, 0) +
                      (system.dashpots.size() > 0 ? system.dashpots.coeff(0, 0) : 0.0) +
                      (modal_ ? modal_->single() : 0.0);
  for (std::size_t j = 0; j < system.loads.size(); ++j)
    for (std::size_t i = 0; i < system.loads[j].dofs.size(); ++i)
      loaded_dofs_.push_back({system.loads[j].dofs[i], system.loads[j].weights[i], j});
}

void Dynamics::external_force(double t, VectorRef force) {
  if (t != load_time_) {
    for (std::size_t i = 0; i < load_values_.size(); ++i) load_values_[i] = system_.loads[i].in_time->value(t);
    load_time_ = t;
  }
  force.setZero();
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
  contact_.displacement(x, stop_displacement_);
  contact_.force(stop_displacement_, stop_force_);
  contact_.scatter(stop_force_, force);
}

void Dynamics::elastic_force(ConstVectorRef x, VectorRef y) const {
  stiffness_product_.multiply(x.data(), y.data());
}
void Dynamics::inertia_force(ConstVectorRef a, VectorRef y) const {
  mass_product_.multiply(a.data(), y.data());
}

void Dynamics::damping_force(ConstVectorRef v, VectorRef y) {
  const double on_mass = system_.damping.mass_proportional, on_stiffness = system_.damping.stiffness_proportional;
  if (on_mass != 0.0) {
    mass_product_.multiply(v.data(), y.data());
    y *= on_mass;
  } else {
    y.setZero();
  }
  if (on_stiffness != 0.0) {
    stiffness_product_.multiply(v.data(), other_.data());
    y += on_stiffness * other_;
  }
  if (system_.dashpots.size() > 0) {
    dashpot_product_.multiply(v.data(), other_.data());
    y += other_;
  }
  if (modal_) modal_->add_force(v, y);
}

void Dynamics::subtract_internal_force(ConstVectorRef x, ConstVectorRef v, VectorRef r) {
  if (size() == 1) {
    elastic_force(x, work_);
    r[0] -= single_damping_ * v[0] + work_[0];
    return;
  }
  elastic_force(x, work_);
  r -= work_;
  if (!has_damping_) return;
  damping_force(v, work_);
  r -= work_;
}

void Dynamics::total_force(double t, ConstVectorRef x, ConstVectorRef v, VectorRef r) {
  ++counters_.force_evaluations;
  external_force(t, r);
  add_contact_force(x, r);
  subtract_internal_force(x, v, r);
}

void Dynamics::secant_contact(ConstVectorRef x, VectorRef kappa, VectorRef c) {
  contact_.displacement(x, stop_displacement_);
  contact_.secant(stop_displacement_, kappa, c);
}

void Dynamics::secant_forces(double t, ConstVectorRef kappa, ConstVectorRef c, ConstVectorRef x, ConstVectorRef v,
                             VectorRef r) {
  external_force(t, r);
  if (stop_count() > 0) {
    contact_.displacement(x, stop_displacement_);
    stop_force_ = c - kappa.cwiseProduct(stop_displacement_);
    contact_.scatter(stop_force_, r);
  }
  subtract_internal_force(x, v, r);
}

double Dynamics::residual(ConstVectorRef load, ConstVectorRef stop_force, ConstVectorRef x, ConstVectorRef v,
                          ConstVectorRef a, VectorRef r) {
  const bool has_stops = stop_count() > 0;
  if (has_stops) {
    contact_force_.setZero();
    contact_.scatter(stop_force, contact_force_);
  }
  inertia_force(a, inertia_);
  if (has_damping_) damping_force(v, damping_);
  elastic_force(x, work_);
  return force_balance({load.data(), has_stops ? contact_force_.data() : nullptr, inertia_.data(),
                        has_damping_ ? damping_.data() : nullptr, work_.data()},
                       size(), r.data());
}

void Dynamics::acceleration(double t, ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  external_force(t, a);
  add_contact_force(x, a);
  respond(x, v, a);
}

void Dynamics::respond(ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  ++counters_.force_evaluations;
  const double on_mass = system_.damping.mass_proportional, on_stiffness = system_.damping.stiffness_proportional;
  if (on_stiffness != 0.0) {
    other_ = x + on_stiffness * v;
    stiffness_product_.multiply(other_.data(), work_.data());
  } else {
    stiffness_product_.multiply(x.data(), work_.data());
  }
  a -= work_;
  if (system_.dashpots.size() > 0) {
    dashpot_product_.multiply(v.data(), work_.data());
    a -= work_;
  }
  mass_solver().solve(a);
  if (on_mass != 0.0) a -= on_mass * v;
  if (modal_) modal_->subtract_deceleration(v, a);
}

LinearSolver& Dynamics::mass_solver() {
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
  if (!effective_) effective_.emplace(system_, contact_, counters_, modal_.get());
  return *effective_;
}

ModalSystem& Dynamics::modal(Index count) {
  if (!modal_system_) modal_system_ = std::make_unique<ModalSystem>(*this, count);
  return *modal_system_;
}

std::vector<double> Dynamics::load_kinks() const {
  std::vector<double> all;
  for (const model::FreeLoad& load : system_.loads) {
    const auto kinks = load.in_time->kinks();
    all.insert(all.end(), kinks.begin(), kinks.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::string Dynamics::dof_name(Index dof) const {
  return system_.dofs.name(system_.dofs.free()[static_cast<std::size_t>(dof)]);
}

}  // namespace butee::solve
