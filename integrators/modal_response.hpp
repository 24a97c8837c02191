#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "butee/dynamics/damped_modes.hpp"

namespace butee::integrators {

/// Places in a step at which forces are taken: 0, 1 and the zeros of P'_5 (Lobatto's rule of six points), and the
/// middle.
struct StepNodes {
  static constexpr Index kCount = 7, kMiddle = 3, kEnd = 6;
  static const std::array<double, kCount> kPlaces;
  /// From values at the nodes to the coefficients of 1, s, ..., s^6: by all of them, or without the middle one, whose
  /// row is then zero. f (n x 7) times it.
  using Matrix = Eigen::Matrix<double, kCount, kCount>;
  static const Matrix& with_middle();
  static const Matrix& without_middle();
  /// Lagrange's polynomials at a place.
  static Eigen::Matrix<double, kCount, 1> lagrange(double place);
};

/// A load amplitude cos(Omega t + phase) on all modes: the factors of e^(i Omega t) and e^(-i Omega t), 2p numbers
/// each.
struct TurningLoad {
  double angular_frequency;  ///< rad/s
  Eigen::VectorXd forth, back;
};

/// The motion of damped modes at one place c h of a step of length h, without error:
///
///     z(t + c h) = e^(lambda c h) z(t) + sum_r moment_r g_r + harmonics,    g_r the factor of s^r in the force
///
/// For small lambda c h the moments come from a series and a recurrence downwards, for large ones from the recurrence
/// upwards, each of which is stable there. Checked in tests/unit/modal_response_test.cpp against quadrature.
class PlaceResponse {
 public:
  /// Of the modes from `first` on; the others are left alone by what follows.
  PlaceResponse(const dynamics::DampedModes& modes, const std::vector<TurningLoad>& loads, double place, double h,
                Index first = 0);

  /// out := z at the place; `z` holds 2p numbers and `g` the factors of 1, s, ..., s^6 one after the other, 2p each;
  /// null: no force but the harmonics.
  void move(double t, const double* z, const double* g, Eigen::Ref<Eigen::VectorXd> out) const;
  /// out += the moments of `g`.
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

}  // namespace butee::integrators
