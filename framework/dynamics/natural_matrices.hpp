#pragma once

#include "butee/core/types.hpp"

namespace butee::dynamics {

class Dynamics;

/// C and K in the natural modes of M and the symmetric part of K, n x n each: q'' + C q' + (K + Q) q = S^T f
/// with x = S q.
struct NaturalMatrices {
  Eigen::MatrixXd shapes;     ///< S, by columns, S^T M S = 1
  Eigen::MatrixXd damping;    ///< S^T C S with the gyroscopic matrix, 1/s
  Eigen::MatrixXd stiffness;  ///< K: S^T of the skew part S, and the stiffness among soft modes, 1/s^2
  Vector squares;             ///< the diagonal Q: squares of the frequencies, 0 for soft modes, 1/s^2
};

/// At the speed of rotation `speed`, rad/s, which must be that of dynamics.set_time(). Entries that are rounding are 0,
/// and slow motion is resolved over `run_time`, s (slow_modes.hpp). Throws InputError if the modes cannot be computed.
NaturalMatrices natural_matrices(Dynamics& dynamics, double speed, double run_time);

}  // namespace butee::dynamics
