#pragma once

#include <vector>

#include <Eigen/Core>

#include "butee/dynamics/damped_modes.hpp"
#include "integrators/exponential/step_nodes.hpp"

namespace butee::integrators {

/// A load amplitude cos(Omega t + phase) on all modes: the coefficients of e^(i Omega t) and e^(-i
/// Omega t), 2p numbers each.
struct TurningLoad {
  double angular_frequency;  ///< rad/s
  Eigen::VectorXd forth, back;
};

/// The motion of damped modes at one position c h of a step of length h, without truncation error:
///
///     z(t + c h) = e^(lambda c h) z(t) + sum_r moment_r g_r + harmonics,   g_r the coefficient of s^r in the force
///
/// For small |lambda c h| the moments follow from a series and a downward recurrence, for large
/// ones from the upward recurrence; each recurrence is stable in its range. Checked in
/// tests/verification/damped_modes_test.cpp.
class PlaceResponse {
 public:
  /// Handles all modes.
  PlaceResponse(const dynamics::DampedModes& modes, const std::vector<TurningLoad>& loads, double place, double h)
      : PlaceResponse(modes, loads, place, h, 0, modes.count()) {}
  /// Handles the modes from `first` to `last` - 1; the member functions leave the others unchanged.
  PlaceResponse(const dynamics::DampedModes& modes, const std::vector<TurningLoad>& loads, double place, double h,
                Index first, Index last);

  /// out := z at the position. `z` holds 2p numbers; `g` holds the coefficients of 1, s, ..., s^6
  /// one after the other, 2p numbers each, or is null if only harmonic loads act.
  void move(double t, const double* z, const double* g, Eigen::Ref<Eigen::VectorXd> out) const;
  /// Adds the response to the force `g` to `out`.
  void add_force(const double* g, Eigen::Ref<Eigen::VectorXd> out) const;

 private:
  using ConstArrayRef = Eigen::Ref<const Eigen::ArrayXd>;
  void find_moments(ConstArrayRef decay, ConstArrayRef turn, ConstArrayRef speed, double place, double h);
  void add_harmonics(ConstArrayRef decay, ConstArrayRef turn, const TurningLoad& load, double length);

  Index first_, count_;
  Eigen::ArrayXXd propagator_;  ///< p x 2
  Eigen::ArrayXXd moments_;     ///< p x 14: real and imaginary parts of each moment
  struct Harmonic {
    double angular_frequency;
    Eigen::VectorXd forth, back;
  };
  std::vector<Harmonic> harmonics_;
};

/// The motion of fast damped modes within one step, without truncation error:
///
///     z(t + s h) = e^(lambda s h) c + sum_r p_r s^r + harmonics,   p_r = ((r + 1) p_(r+1)/h - g_r)/lambda
///
/// The constants are found once for a step, so that an instant costs an exponential function and a
/// polynomial for each mode. Checked in tests/verification/damped_modes_test.cpp.
class FastMotion {
 public:
  /// The smallest |lambda| h: the terms of p_0 are up to 6!/kLeast^6 times g/lambda, so that at
  /// most three digits cancel.
  static constexpr double kLeast = 1.0;

  /// Both must outlive it.
  FastMotion(const dynamics::DampedModes& modes, const std::vector<TurningLoad>& loads)
      : modes_(modes), loads_(loads) {}

  /// Sets the step of length h from t, for the modes from `first` on; arguments as for
  /// PlaceResponse::move(). Free motion of mode k with |c| below silent[k] is left out. False if a
  /// load nearly resonates with one of the modes: digits would then cancel.
  bool begin(double t, double h, const double* z, const double* g, Index first, const Eigen::ArrayXd& silent);
  /// Fills the entries of these modes in `z` (2p) with the motion at a position of the step.
  void move(double place, Eigen::VectorXd& z) const;

 private:
  /// The smallest |i Omega - lambda| h.
  static constexpr double kResonant = 0.1;

  const dynamics::DampedModes& modes_;
  const std::vector<TurningLoad>& loads_;
  double t_ = 0.0, h_ = 0.0;  ///< s
  Index first_ = 0;
  Eigen::ArrayXd silent_;                       ///< bounds of |c|
  Eigen::ArrayXcd free_;                        ///< c
  Eigen::ArrayXXcd polynomial_, forth_, back_;  ///< p_r; responses to e^(i Omega t), e^(-i Omega t), one column each
};

/// The responses at all nodes of a step except its start.
class StepResponse {
 public:
  StepResponse(const dynamics::DampedModes& modes, const std::vector<TurningLoad>& loads, double h);

  double h() const { return h_; }
  /// Fills the columns of `nodes` (2p x 7) with z at the nodes; arguments as for
  /// PlaceResponse::move().
  void move(double t, const double* z, const double* g, Eigen::MatrixXd& nodes) const;
  /// Adds the response to the force `g` to all columns of `nodes` except the start.
  void add_force(const double* g, Eigen::MatrixXd& nodes) const;

 private:
  double h_;
  std::vector<PlaceResponse> places_;
};

}  // namespace butee::integrators
