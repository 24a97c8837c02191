#pragma once

#include <span>
#include <vector>

#include "integrators/exponential/modal_loads.hpp"

namespace butee::integrators {

/// The acceleration of one DOF within a step, without dz/dt of all modes:
///
///     a = sum_k Re(lambda_k r_k dz_k/dt),    dz_k/dt = lambda_k z_k + sum_r g_kr s^r + harmonic loads
class DofAcceleration {
 public:
  /// cos(Omega t) and sin(Omega t) of a harmonic load.
  struct Phase {
    double cosine, sine;
  };

  /// `polynomial` holds the coefficients of 1, s, ..., s^6 of the force in the step one after the other, 2p numbers
  /// each.
  DofAcceleration(const dynamics::DampedModes& modes, const ModalLoads& loads, Index dof, const double* polynomial);

  /// The acceleration at a position of the step, where the modal coordinates are `z` and the harmonic loads have these
  /// phases.
  double at(double place, const Eigen::Ref<const Eigen::VectorXd>& z, std::span<const Phase> phases) const;

 private:
  Eigen::VectorXd row_;  ///< of z
  StepNodes::Row polynomial_;
  std::vector<Phase> harmonics_;  ///< amplitudes of cosine and sine
};

}  // namespace butee::integrators
