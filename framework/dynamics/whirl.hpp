#pragma once

#include <complex>
#include <vector>

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// The displacements that hold a mode's kinetic energy; lateral unless nearly all of it is in the others.
enum class ModeMotion { lateral, torsional, axial };

/// A damped mode of a structure with turning parts: x(t) = Re(shape e^(lambda t)).
struct BUTEE_EXPORT WhirlMode {
  std::complex<double> lambda;  ///< 1/s, rad/s; Im >= 0
  Eigen::VectorXcd shape;       ///< of the free DOFs, largest entry 1
  /// From +1 (circular orbits about +x) through 0 (motion along a line) to -1 (circular orbits the
  /// opposite way); 0 without orbits. Of the turning axes, if the mode only tilts them.
  double direction = 0.0;
  bool is_mixed = false;  ///< some nodes whirl forward, others backward
  ModeMotion motion = ModeMotion::lateral;

  double frequency() const { return lambda.imag(); }  ///< rad/s
  double damping_ratio() const;                       ///< -Re lambda / |lambda|
  double logarithmic_decrement() const;               ///< 2 pi (-Re lambda) / Im lambda; infinite without oscillation
};

/// Keeps the `count` modes of lowest |lambda|, in their order.
BUTEE_EXPORT void keep_lowest(std::vector<WhirlMode>& modes, Index count);

/// Critical speed: a mode has `order` periods in each turn of the shaft.
struct CriticalSpeed {
  double speed = 0.0;      ///< rad/s
  double direction = 0.0;  ///< of the mode, as in WhirlMode
  ModeMotion motion = ModeMotion::lateral;
};

/// A speed at which a mode begins or ceases to grow.
struct StabilityBorder {
  double speed = 0.0;  ///< rad/s
  bool begins = true;  ///< it grows above the speed
  WhirlMode mode;      ///< on the side where it grows
};

/// The modes at a speed of a Campbell diagram.
struct ModesAtSpeed {
  double speed = 0.0;             ///< rad/s
  std::vector<WhirlMode> lowest;  ///< as of Whirl::modes()
  /// Those with Im >= 0, of all modes if the problem is dense, else of `lowest`.
  std::vector<std::complex<double>> eigenvalues;
};

/// The eigenvalue problem (lambda^2 M + lambda (C + Omega G) + K + Omega W) x = 0 of a model at any speed Omega.
///
/// Up to a number of free DOFs (kDense unless stated) all modes are found densely, in the modes of M and K at rest,
/// which keeps the low ones exact to rounding of the highest frequency; for more DOFs, or if that rounding exceeds 1e-7
/// of the lowest frequency, the lowest modes are found by Arnoldi's method (Spectra) on the inverse, factorized by KLU.
/// Checked against closed forms and published rotors in tests/verification/rotor_test.cpp.
class BUTEE_EXPORT Whirl {
 public:
  static constexpr Index kDense = 400;
  /// For searches along the speed, which take hundreds of eigenvalue problems: some 20 s (chosen).
  static constexpr Index kDenseSearch = 160;

  /// `model` must outlive this object; `dense` <= kDense. Modal damping is dense up to kDense DOFs in any case; throws
  /// InputError for more.
  explicit Whirl(const model::Model& model, Index dense = kDense);

  Index size() const { return system_.size(); }
  const model::System& system() const { return system_; }  ///< at rest, with G and W separate
  bool is_dense() const { return size() <= dense_; }

  /// The `count` modes of lowest |lambda| at a speed, rad/s, in ascending frequency; modes without
  /// oscillation, overdamped or rigid, come first. Throws RunError if the iteration did not
  /// converge.
  std::vector<WhirlMode> modes(double speed, Index count) const;
  ModesAtSpeed modes_at(double speed, Index count) const;

  /// The number of lowest modes that includes all with |lambda| of up to `reach`, rad/s, at both speeds, but at most
  /// kMostLowest; `count` or more.
  static constexpr Index kMostLowest = 160;
  Index count_to(double reach, double from, double to, Index count) const;

  /// The critical speeds of `order` in [from, to], rad/s, ascending, to rounding: speeds at which
  /// the frequency of a mode equals order times the speed, found on a grid of `steps` intervals and
  /// by secants within them. All modes are examined if the problem is dense, else `count`.
  std::vector<CriticalSpeed> critical_speeds(double from, double to, Index steps, double order, Index count) const;

  /// The speeds, rad/s, ascending, at which a mode begins or ceases to grow, to 1e-8: between neighbours of `grid`
  /// (ascending speeds), by secants. All modes are examined if the problem is dense, else the `count` lowest, which
  /// those of `grid` have to be.
  std::vector<StabilityBorder> stability_borders(const std::vector<ModesAtSpeed>& grid, Index count) const;
  /// True if motion e^(lambda t) grows by more than rounding.
  bool grows(std::complex<double> lambda) const { return growth(lambda) > 0.0; }

 private:
  struct Eigenvalue {
    std::complex<double> lambda;
    Index place;  ///< of its vector
  };

  ModesAtSpeed dense_modes(double speed, Index count) const;
  std::vector<WhirlMode> lowest_modes(double speed, Index count) const;
  /// The matrix of the first-order form in the modes at rest.
  Eigen::MatrixXd modal_motion(double speed) const;
  /// Those of `values` with Im >= 0, the smallest first; rigid motion has exactly 0.
  std::vector<Eigenvalue> in_order(const Eigen::VectorXcd& values) const;
  /// The eigenvalues of the modes of lowest |lambda|.
  std::vector<std::complex<double>> eigenvalues(double speed, Index count) const;
  /// The speed near `side`, where `mode` grows, at which its Re lambda is zero.
  double border_near(double side, const WhirlMode& mode, Index count) const;
  /// Re lambda less what may be rounding.
  double growth(std::complex<double> lambda) const;
  /// The lowest of frequencies_ above 0, rad/s; infinite if there is none.
  double slowest() const;
  /// The rounding of dense eigenvalues at a speed, 1/s; 0 if they are not dense.
  double rounding(double speed) const;
  WhirlMode finished(std::complex<double> lambda, Eigen::VectorXcd shape) const;

  model::System system_;
  Index dense_;  ///< the largest number of DOFs for dense matrices; -1: rounding does not allow them
  SparseMatrix damping_, stiffness_, skew_;  ///< C, the symmetric part of K and its skew part, at rest
  // For dense problems, in the modes of M and the symmetric part of K at rest:
  Vector frequencies_;  ///< rad/s, 0 for rigid motion
  Eigen::MatrixXd shapes_, modal_damping_, modal_stiffness_, modal_gyroscopic_, modal_circulatory_;
};

}  // namespace butee::dynamics
