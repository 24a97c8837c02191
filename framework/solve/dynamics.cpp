#include "butee/solve/dynamics.hpp"

#include "butee/core/error.hpp"

namespace butee::solve {
namespace {

/// y := A x for a symmetric A stored in full: its columns are its rows.
void multiply(const SparseMatrix& matrix, ConstVectorRef x, VectorRef y) {
  const int* start = matrix.outerIndexPtr();
  const int* index = matrix.innerIndexPtr();
  const double* value = matrix.valuePtr();
  for (Index i = 0; i < matrix.outerSize(); ++i) {
    double sum = 0.0;
    for (int k = start[i]; k < start[i + 1]; ++k) sum += value[k] * x[index[k]];
    y[i] = sum;
  }
}

}  // namespace

Dynamics::Dynamics(const model::System& system)
    : system_(system),
      contact_(system, counters_),
      has_damping_(system.damping.mass_proportional != 0.0 || system.damping.stiffness_proportional != 0.0 ||
                   system.dashpots.size() > 0),
      work_(Vector::Zero(system.size())),
      other_(work_),
      stop_displacement_(Vector::Zero(contact_.size())),
      stop_force_(stop_displacement_) {}

void Dynamics::external_force(double t, VectorRef force) const {
  force.setZero();
  for (const model::FreeLoad& load : system_.loads) {
    const double value = load.in_time->value(t);
    for (std::size_t i = 0; i < load.dofs.size(); ++i) force[load.dofs[i]] += load.weights[i] * value;
  }
}

void Dynamics::add_contact_force(ConstVectorRef x, VectorRef force) {
  if (stop_count() == 0) return;
  contact_.displacement(x, stop_displacement_);
  contact_.force(stop_displacement_, stop_force_);
  contact_.scatter(stop_force_, force);
}

void Dynamics::elastic_force(ConstVectorRef x, VectorRef y) const {
  multiply(system_.stiffness, x, y);
}
void Dynamics::inertia_force(ConstVectorRef a, VectorRef y) const {
  multiply(system_.mass, a, y);
}

void Dynamics::damping_force(ConstVectorRef v, VectorRef y) {
  const double on_mass = system_.damping.mass_proportional, on_stiffness = system_.damping.stiffness_proportional;
  if (on_mass != 0.0) {
    multiply(system_.mass, v, y);
    y *= on_mass;
  } else {
    y.setZero();
  }
  if (on_stiffness != 0.0) {
    multiply(system_.stiffness, v, other_);
    y += on_stiffness * other_;
  }
  if (system_.dashpots.size() > 0) {
    multiply(system_.dashpots, v, other_);
    y += other_;
  }
}

void Dynamics::acceleration(double t, ConstVectorRef x, ConstVectorRef v, VectorRef a) {
  ++counters_.force_evaluations;
  const double on_mass = system_.damping.mass_proportional, on_stiffness = system_.damping.stiffness_proportional;
  external_force(t, a);
  add_contact_force(x, a);
  if (on_stiffness != 0.0) {
    other_ = x + on_stiffness * v;
    multiply(system_.stiffness, other_, work_);
  } else {
    multiply(system_.stiffness, x, work_);
  }
  a -= work_;
  if (system_.dashpots.size() > 0) {
    multiply(system_.dashpots, v, work_);
    a -= work_;
  }
  mass_factor().solve(a);
  if (on_mass != 0.0) a -= on_mass * v;
}

SymmetricFactor& Dynamics::mass_factor() {
  if (!mass_factor_) {
    mass_factor_.emplace(system_.mass, counters_);
    if (!mass_factor_->factorize(system_.mass))
      throw InputError("the mass matrix is not positive definite: check the masses and the sections of the scene");
  }
  return *mass_factor_;
}

EffectiveSolver& Dynamics::effective() {
  if (!effective_) effective_.emplace(system_, contact_, counters_);
  return *effective_;
}

std::string Dynamics::dof_name(Index dof) const {
  return system_.dofs.name(system_.dofs.free()[static_cast<std::size_t>(dof)]);
}

}  // namespace butee::solve
