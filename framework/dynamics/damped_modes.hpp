#pragma once

#include <vector>

#include <Eigen/Core>
#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::dynamics {

class Dynamics;
struct NaturalMatrices;

/// The damped modes of any linear system M a + C v + K x = f(t), with any damping, turning parts or
/// cross terms:
///
///     z_k' = lambda_k z_k + b_k . f(t),    x = Re sum_k r_k z_k,    v = Re sum_k lambda_k r_k z_k
///
/// Of each complex pair one mode is kept, with twice its shape. Columns of 2 p numbers hold the
/// real parts of all p modes and then the imaginary parts, so that sums over modes are real
/// products. Modes ascend in |lambda|.
///
/// The natural modes of M and the symmetric part of K that are coupled by C and the rest of K form
/// blocks, each with its own eigenvalue problem. Rigid motion and critical damping have no basis of
/// eigenvectors; their stiffness is changed by kNudge times the larger of omega^2 and 1/T^2 (1e-15
/// times for rigid motion without damping), which changes the motion over the run time T by less
/// than 1e-9 of itself. Checked against the matrix exponential in
/// tests/verification/damped_modes_test.cpp.
class BUTEE_EXPORT DampedModes {
 public:
  /// The largest number of DOFs; the matrices are full.
  static constexpr Index kMost = 600;
  static constexpr double kNudge = 1e-10;

  /// `run_time` is T, s. If the speed of rotation varies, the modes are those at its value at T/2. Throws InputError if
  /// there are too many DOFs, more than `most_coupled` modes in a block or no basis of modes.
  DampedModes(Dynamics& dynamics, double run_time, Index most_coupled = kMost);

  /// The speed of rotation of these modes, rad/s, if it varies in the system; else 0.
  double reference_speed() const { return reference_speed_; }
  /// The largest |V| |V^-1| of the blocks, V the eigenvectors, in Frobenius norms: motion that is
  /// transformed to the modes and back has relative rounding errors of this times epsilon.
  double condition() const { return condition_; }
  /// The relative error that rounding in the modes causes in motion over the run time: T |V Lambda V^-1 - A| in the
  /// largest entry, for y' = A y in coordinates y of equal size.
  double rounding() const { return rounding_; }
  Index count() const { return decay_.size(); }           ///< p
  const Eigen::ArrayXd& decay() const { return decay_; }  ///< Re lambda, 1/s
  const Eigen::ArrayXd& turn() const { return turn_; }    ///< Im lambda >= 0, rad/s
  const Eigen::ArrayXd& speed() const { return speed_; }  ///< |lambda|, 1/s, ascending

  /// The largest kinetic energy of each mode alone for |z| = 1, J
  const Eigen::ArrayXd& kinetic() const { return kinetic_; }

  const Eigen::MatrixXd& displacement() const { return displacement_; }  ///< 2p x n: x_d = column d . z
  const Eigen::MatrixXd& velocity() const { return velocity_; }          ///< 2p x n
  const Eigen::MatrixXd& input() const { return input_; }                ///< 2p x n: z' gets column d times f_d

  /// The natural modes that the damped ones combine: with the coordinates q of natural modes, x = shapes q, q =
  /// displacement^T z, q' = velocity^T z, and forces f add input shapes^T f to z'.
  struct Natural {
    Eigen::MatrixXd shapes;                      ///< n x n, column i is natural mode i
    SparseMatrix displacement, velocity, input;  ///< 2p x n
    /// DOFs and the natural modes that move them alone, such as those of one plane.
    struct Part {
      std::vector<Index> dofs, modes;
    };
    std::vector<Part> parts;
  };
  const Natural& natural() const { return natural_; }

  /// re + i im = e^(lambda t) of the modes from `first` on, as many as there is room for.
  void turn_by(double t, Index first, Eigen::Ref<Eigen::ArrayXd> re, Eigen::Ref<Eigen::ArrayXd> im) const;
  /// z, 2p numbers, of the motion (x, v).
  void to_modal(ConstVectorRef x, ConstVectorRef v, Eigen::Ref<Eigen::VectorXd> z) const;

 private:
  /// Natural modes that are coupled, and their part of the eigenvector basis.
  struct Block {
    std::vector<Index> modes;  ///< natural modes
    Eigen::ArrayXd scale;      ///< s_i, 1/s, of the coordinates (s q, q')
    Eigen::VectorXcd values;
    Eigen::MatrixXcd vectors, inverse;
    double error = 0.0;  ///< |V Lambda V^-1 - A| in the largest entry, 1/s
  };
  static std::vector<Block> blocks_of(const NaturalMatrices& natural, double run_time, Index most_coupled);
  /// Finds the basis of the block's modes, if necessary with slightly separated frequencies.
  static void find_basis(const NaturalMatrices& natural, double run_time, Block& block);
  static bool solve(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& damping, Block& block);
  void set_modes(const std::vector<Block>& blocks, const Eigen::MatrixXd& shapes, const SparseMatrix& mass);

  Eigen::ArrayXd decay_, turn_, speed_, kinetic_;
  Eigen::MatrixXd displacement_, velocity_, input_, from_x_, from_v_;
  Natural natural_;
  double condition_ = 1.0, rounding_ = 0.0, reference_speed_ = 0.0;
};

}  // namespace butee::dynamics
