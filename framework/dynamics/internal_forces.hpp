#pragma once

#include <memory>
#include <vector>

#include "butee/dynamics/modal_damping.hpp"
#include "butee/dynamics/turning.hpp"
#include "butee/linalg/force_balance.hpp"
#include "butee/linalg/symmetric_product.hpp"

namespace butee::dynamics {

/// M a, C v and K x of a system, in blocks of rows that stay in the cache.
class InternalForces {
 public:
  /// `system` must outlive this object. Throws InputError if modes with modal damping could not be
  /// computed, or are to be damped in a system without symmetry.
  explicit InternalForces(const model::System& system);

  bool has_damping() const { return has_damping_; }
  /// Null without modal damping, and unless the speed of rotation varies.
  const ModalDamping* modal() const { return modal_.get(); }
  Turning* turning() const { return turning_.get(); }

  /// y := K x, M a, C v
  void elastic(ConstVectorRef x, VectorRef y) const;
  void inertia(ConstVectorRef a, VectorRef y) const;
  void damping(ConstVectorRef v, VectorRef y);
  /// The entries of a system with one DOF.
  double single_stiffness() const { return stiffness_.first(); }
  double single_mass() const { return mass_.first(); }
  double single_damping() const { return single_damping_; }

  /// r -= C v + K x
  void subtract(ConstVectorRef x, ConstVectorRef v, VectorRef r);
  /// r -= modal damping part of C v
  void subtract_modal(ConstVectorRef v, VectorRef r);

  /// What r holds before a subtraction: a value, or anything, taken as 0.
  enum class From { given, nothing };
  /// r -= C v + K x without mass-proportional and modal damping, which solve_less() of the mass
  /// solver and ModalDamping::subtract_deceleration() treat
  void subtract_from(From from, ConstVectorRef x, ConstVectorRef v, VectorRef r) {
    if (system_.size() == 1)
      r[0] = (from == From::given ? r[0] : 0.0) - (single_damping_ * v[0] + stiffness_.first() * x[0]);
    else
      subtract_products(from, shifted(x, system_.damping.stiffness_proportional, v), 1.0, v, r);
  }
  /// r := -(K (x + shift v) + velocity_factor D v) with the dashpots D
  void set_shifted(ConstVectorRef x, double shift, double velocity_factor, ConstVectorRef v, VectorRef r) {
    subtract_products(From::nothing, shifted(x, shift, v), velocity_factor, v, r);
  }

  /// A force of all DOFs, null if zero everywhere, and the blocks of rows in which it is not zero.
  struct BlockForce {
    const double* force;
    const std::vector<bool>& in_block;
  };
  /// r := the sum of both forces - M a - C v - K x
  linalg::ForceBalance balance(const BlockForce& load, const BlockForce& contact, ConstVectorRef x, ConstVectorRef v,
                               ConstVectorRef a, VectorRef r);

 private:
  const double* shifted(ConstVectorRef x, double shift, ConstVectorRef v);
  void subtract_products(From from, const double* x, double velocity_factor, ConstVectorRef v, VectorRef r);
  /// y := a block of the rows of C v without modal damping
  void damping_rows(ConstVectorRef v, Index begin, Index count, double* y);
  linalg::ForceBalance single_balance(const double* load, const double* contact, double x, double v, double a,
                                      double* r) const;

  const model::System& system_;
  std::unique_ptr<const ModalDamping> modal_;
  std::unique_ptr<Turning> turning_;
  bool has_damping_;
  double single_damping_ = 0.0;
  linalg::SymmetricProduct mass_, stiffness_, dashpots_;
  Vector other_vector_, turning_damping_, turning_inertia_;  ///< if the speed of rotation varies
  Vector shifted_, modal_force_;                             ///< x + s v, and C v with modal damping
  Vector work_, other_, inertia_, damping_;                  ///< of a block of rows
};

}  // namespace butee::dynamics
