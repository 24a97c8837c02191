#include "butee/dynamics/internal_forces.hpp"

#include <algorithm>

#include "butee/core/blocks.hpp"
#include "butee/core/error.hpp"
#include "butee/core/zeros.hpp"

namespace butee::dynamics {

InternalForces::InternalForces(const model::System& system)
    : system_(system),
      modal_(ModalDamping::of(system)),
      turning_(system.rotation != nullptr ? std::make_unique<Turning>(system) : nullptr),
      has_damping_(system.damping.is_rayleigh() || system.dashpots.size() > 0 || modal_ != nullptr),
      mass_(system.mass),
      stiffness_(system.stiffness, system.stiffness_is_symmetric),
      other_vector_(Vector::Zero(turning_ ? system.size() : 0)),
      turning_damping_(other_vector_),
      turning_inertia_(other_vector_),
      shifted_(zeros(system.damping.is_rayleigh() ? system.size() : 0)),
      modal_force_(Vector::Zero(modal_ ? system.size() : 0)),
      work_(Vector::Zero(std::min(system.size(), kLargestBlock))),
      other_(work_),
      inertia_(work_),
      damping_(work_) {
  if (system.dashpots.size() > 0) dashpots_ = linalg::SymmetricProduct(system.dashpots, system.is_symmetric);
  if (modal_ && !system.is_symmetric)
    throw InputError(
        "modal damping requires symmetric matrices, but here shafts turn, or bearings or given matrices have cross "
        "terms; give "
        "mass_proportional and stiffness_proportional, or damping of bearings and springs");
  if (system.size() == 1)
    single_damping_ = system.damping.mass_proportional * system.mass.coeff(0, 0) +
                      system.damping.stiffness_proportional * system.stiffness.coeff(0, 0) +
                      (system.dashpots.size() > 0 ? system.dashpots.coeff(0, 0) : 0.0) +
                      (modal_ ? modal_->single() : 0.0);
}

void InternalForces::elastic(ConstVectorRef x, VectorRef y) const {
  stiffness_.multiply(x.data(), y.data());
  if (turning_) turning_->add_elastic_force(x, y);
}

void InternalForces::inertia(ConstVectorRef a, VectorRef y) const {
  mass_.multiply(a.data(), y.data());
}

void InternalForces::damping(ConstVectorRef v, VectorRef y) {
  in_blocks(system_.size(), [&](Index begin, Index count) { damping_rows(v, begin, count, y.data() + begin); });
  if (modal_) modal_->add_force(v, y);
  if (turning_) turning_->add_damping_force(v, y);
}

void InternalForces::subtract_modal(ConstVectorRef v, VectorRef r) {
  if (!modal_) return;
  modal_force_.setZero();
  modal_->add_force(v, modal_force_);
  r -= modal_force_;
}

void InternalForces::damping_rows(ConstVectorRef v, Index begin, Index count, double* y) {
  const double on_mass = system_.damping.mass_proportional, on_stiffness = system_.damping.stiffness_proportional;
  Eigen::Map<Vector> sum(y, count);
  if (on_mass != 0.0) {
    mass_.multiply(v.data(), begin, count, y);
    sum *= on_mass;
  } else {
    sum.setZero();
  }
  if (on_stiffness != 0.0) {
    stiffness_.multiply(v.data(), begin, count, other_.data());
    sum += on_stiffness * other_.head(count);
  }
  if (system_.dashpots.size() > 0) {
    dashpots_.multiply(v.data(), begin, count, other_.data());
    sum += other_.head(count);
  }
}

void InternalForces::subtract(ConstVectorRef x, ConstVectorRef v, VectorRef r) {
  if (system_.size() == 1) {
    r[0] -= single_damping_ * v[0] + stiffness_.first() * x[0];
    return;
  }
  const bool has_local_damping = has_damping_ && !modal_;
  in_blocks(system_.size(), [&](Index begin, Index count) {
    auto rows = r.segment(begin, count);
    stiffness_.multiply(x.data(), begin, count, work_.data());
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
  damping(v, modal_force_);
  r -= modal_force_;
}

void InternalForces::subtract_products(From from, const double* x, double velocity_factor, ConstVectorRef v,
                                       VectorRef r) {
  in_blocks(system_.size(), [&](Index begin, Index count) {
    auto rows = r.segment(begin, count);
    const auto product = work_.head(count);
    stiffness_.multiply(x, begin, count, work_.data());
    if (from == From::nothing)
      rows = -product;
    else
      rows -= product;
    if (system_.dashpots.size() == 0) return;
    dashpots_.multiply(v.data(), begin, count, work_.data());
    rows -= velocity_factor * product;
  });
  if (turning_) turning_->subtract_forces(x, velocity_factor, v, r);
}

const double* InternalForces::shifted(ConstVectorRef x, double shift, ConstVectorRef v) {
  if (shift == 0.0) return x.data();
  shifted_ = x + shift * v;
  return shifted_.data();
}

linalg::ForceBalance InternalForces::single_balance(const double* load, const double* contact, double x, double v,
                                                    double a, double* r) const {
  linalg::ForceBalance balance;
  const double inertia = mass_.first() * a, damping = single_damping_ * v, elastic = stiffness_.first() * x;
  balance.add({load, contact, &inertia, has_damping_ ? &damping : nullptr, &elastic}, 1, r);
  return balance;
}

linalg::ForceBalance InternalForces::balance(const BlockForce& load, const BlockForce& contact, ConstVectorRef x,
                                             ConstVectorRef v, ConstVectorRef a, VectorRef r) {
  if (system_.size() == 1) return single_balance(load.force, contact.force, x[0], v[0], a[0], r.data());
  linalg::ForceBalance balance;
  if (modal_) damping(v, modal_force_);
  if (turning_) {
    // The turning part is a product over all rows, so the forces are summed at once, not block by
    // block.
    damping(v, turning_damping_);
    elastic(x, other_vector_);
    inertia(a, turning_inertia_);
    balance.add({load.force, contact.force, turning_inertia_.data(), turning_damping_.data(), other_vector_.data()},
                system_.size(), r.data());
    return balance;
  }
  in_blocks(system_.size(), [&](Index begin, Index count) {
    linalg::ForceTerms terms{nullptr, nullptr, inertia_.data(), nullptr, work_.data()};
    mass_.multiply(a.data(), begin, count, inertia_.data());
    stiffness_.multiply(x.data(), begin, count, work_.data());
    if (load.in_block[block_of(begin, system_.size())]) terms.load = load.force + begin;
    if (contact.force != nullptr && contact.in_block[block_of(begin, system_.size())])
      terms.contact = contact.force + begin;
    if (modal_) {
      terms.damping = modal_force_.data() + begin;
    } else if (has_damping_) {
      damping_rows(v, begin, count, damping_.data());
      terms.damping = damping_.data();
    }
    balance.add(terms, count, r.data() + begin);
  });
  return balance;
}

}  // namespace butee::dynamics
