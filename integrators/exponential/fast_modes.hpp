#pragma once

#include <Eigen/Core>

#include "butee/dynamics/damped_modes.hpp"
#include "butee/time/dense_output.hpp"

namespace butee::integrators {

/// The smallest ratio of a scale of the error control at the start of a step to that at its end, at least a thousandth.
double least_growth(const time::State& from, const time::State& to);

/// Finds the highest frequency of the damped modes that contributes to an output.
class FastModes {
 public:
  FastModes(const dynamics::DampedModes& modes, double tolerance);

  double highest() const { return highest_; }  ///< |lambda|, 1/s
  /// The highest |lambda| above `slow` of a mode that has to be resolved between breakpoints;
  /// `slow` if there is none, 1/s. Breakpoints that are kMostTurn/|lambda| apart leave out faster
  /// modes, which move outputs of the step, and the quintic between breakpoints, by less than the
  /// tolerance, as far as `detail` requires. With time::Detail::power faster modes have less than
  /// tolerance^2 of the energy. `amplitudes` holds that of each mode beside its quasi-static response.
  double find(const time::State& from, const time::State& to, double slow, const Eigen::ArrayXd& amplitudes,
              time::Detail detail) const;
  /// Largest phase angle of the fastest motion between breakpoints, rad: the error of a quintic is
  /// then 4e-4 of the motion and 6e-4 of its speed.
  static constexpr double kMostTurn = 1.5;

 private:
  /// The scales of x, v and a of all DOFs in a step, times the tolerance.
  struct Scales {
    Eigen::ArrayXd x, v, a;
  };
  Scales scales(const time::State& from, const time::State& to) const;

  const dynamics::DampedModes& modes_;
  double tolerance_, highest_;
  Eigen::MatrixXd shape_, speed_shape_;  ///< |r_k| and |lambda_k r_k| for each DOF and mode, n x p
};

}  // namespace butee::integrators
