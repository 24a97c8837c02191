#pragma once

#include "butee/model/system.hpp"
#include "integrators/exponential/modal_response.hpp"

namespace butee::integrators {

/// The loads of a system on its damped modes: harmonic loads, which are integrated exactly, and
/// piecewise parabolic loads, which are polynomials over a step between their discontinuities.
class ModalLoads {
 public:
  /// Throws InputError for other loads, except those of VaryingForces. `modes` and `system` must outlive it.
  ModalLoads(const dynamics::DampedModes& modes, const model::System& system);

  const std::vector<HarmonicLoad>& harmonic() const { return harmonic_; }
  /// The highest frequency of a harmonic load, rad/s; 0 without one.
  double highest_frequency() const;
  /// Bounds for a step of length h, m.
  struct Resolution {
    double missed = 0.0;   ///< difference between the motion and the polynomial through its values at the nodes
    double reached = 0.0;  ///< displacement that one mode reaches in the step from rest
  };
  /// Those of the motion driven by harmonic loads; reach[k] is the displacement of mode k for |z| = 1.
  Resolution resolution(double h, const Eigen::ArrayXd& reach) const;
  bool has_others() const { return !others_.empty(); }
  /// The coefficients of 1, s, ..., s^6 of the other loads over a step of length h from t, 2p x 7.
  const Eigen::MatrixXd& polynomial(double t, double h);
  /// Adds the harmonic loads at time t to dz/dt in `rate`.
  void add_harmonic_rate(double t, Eigen::VectorXd& rate) const;

 private:
  struct Other {
    const model::TimeFunction* in_time;
    Eigen::VectorXd shape;  ///< 2p
  };
  void add_harmonic(const model::Harmonic& harmonic, const Eigen::VectorXd& shape);

  /// The modal forces of a term e^(i Omega t) and how far it is from resonance.
  struct Response {
    double angular_frequency;        ///< |Omega|, rad/s
    Eigen::ArrayXd force, slowness;  ///< of each mode: |f|, and 1/|i Omega - lambda|, s
    Eigen::ArrayXd displacement;     ///< half of the steady displacement of each mode, relative to its shape
  };

  const dynamics::DampedModes& modes_;
  std::vector<HarmonicLoad> harmonic_;
  std::vector<Response> responses_;  ///< two for each harmonic load
  std::vector<Other> others_;
  Eigen::MatrixXd polynomial_;
};

}  // namespace butee::integrators
