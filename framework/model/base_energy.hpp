#pragma once

#include <vector>

#include "butee/model/system.hpp"

namespace butee::model {

/// The contribution of moving supports to the energies of a structure whose x is measured in space (BaseFrame::still),
/// J.
///
/// With x the free degrees of freedom and s = sum_b s_b D_b(t) what the base motions prescribe, the strain energy is
/// (x + s).K (x + s)/2 over all degrees of freedom, of which x.K_ff x/2 is known; likewise the kinetic energy with M
/// and the rate of dissipation with 2 C. For motions of single supports s is their displacement. If all supports and
/// the ground move, springs and dashpots see x - r D on the free degrees of freedom. Damping by modes is that of x
/// alone.
class BUTEE_EXPORT BaseEnergy {
 public:
  /// Empty if x is relative to the base, or nothing moves. `system` must outlive this object.
  explicit BaseEnergy(const System& system);

  bool is_empty() const { return motions_.empty(); }

  struct Parts {
    double kinetic = 0.0, strain = 0.0;  ///< J
    double damping = 0.0;                ///< W, dissipated
  };
  Parts at(double t, ConstVectorRef x, ConstVectorRef v) const;

 private:
  class Sum;
  /// One of the three quadratic forms: A_fs s_b for every base motion b, one column each, and s_a.A s_b.
  struct Form {
    Eigen::MatrixXd of_free, among;

    /// z.A_fs s D + D.(s.A s) D/2 for the values D of the motions.
    double value(ConstVectorRef z, ConstVectorRef d) const;
  };

  std::vector<const BaseMotion*> motions_;
  Form mass_, damping_, stiffness_;
};

}  // namespace butee::model
