#pragma once

#include <vector>

#include <Eigen/Core>

#include "butee/dynamics/damped_modes.hpp"
#include "integrators/exponential/step_nodes.hpp"

namespace butee::integrators {

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

/// The responses at all nodes of a step but its start.
class StepResponse {
 public:
  StepResponse(const dynamics::DampedModes& modes, const std::vector<TurningLoad>& loads, double h);

  double h() const { return h_; }
  /// Fills the columns of `nodes` (2p x 7) with z at the nodes; arguments as of PlaceResponse::move().
  void move(double t, const double* z, const double* g, Eigen::MatrixXd& nodes) const;
  /// nodes += the moments of `g`, but for the start.
  void add_force(const double* g, Eigen::MatrixXd& nodes) const;
  /// out += the moments of `g` at the end.
  void add_force_at_end(const double* g, Eigen::VectorXd& out) const { places_.back().add_force(g, out); }

 private:
  double h_;
  std::vector<PlaceResponse> places_;
};

}  // namespace butee::integrators
