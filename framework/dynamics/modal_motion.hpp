#pragma once

#include <array>
#include <memory>
#include <vector>

#include "butee/dynamics/modal_system.hpp"

namespace butee::dynamics {

/// The motion of a modal system at any instant within a step, in closed form.
///
///     q'' + 2 delta q' + omega^2 q = f_0 P_0 + f_1 P_1 + f_2 P_2 + loads
///
/// with the Legendre polynomials P_k of the step. It is the motion that ModalPropagator gives at
/// the end of a step, but without its tables: slow modes by a Taylor series, decaying oscillations
/// by sine, cosine and exponential, overdamped modes by two exponentials, the few others (near to critical damping, in
/// undamped resonance with a load, or with thousands of periods per step) by a ModalPropagator of their own. The error
/// is at the level of rounding. Checked against ModalPropagator in tests/unit/modal_motion_test.cpp.
class BUTEE_EXPORT ModalMotion {
 public:
  /// `modal` must outlive this object.
  explicit ModalMotion(const ModalSystem& modal);
  /// For modes with omega and delta in 1/s, ascending in omega except for the last few. All
  /// arguments must outlive this object.
  ModalMotion(const Eigen::ArrayXd& omega, const Eigen::ArrayXd& delta, const std::vector<ModalHarmonic>& harmonics,
              const std::vector<ModalSystem::OtherLoad>& other_loads);
  ~ModalMotion();

  /// The size of arrays of `modes` here: padded with zeros to whole registers.
  static Index padded(Index modes);

  /// Begins a step of length h at t, from q and v, with the forces moments[k] P_k (nullptr: none).
  /// All arrays are padded.
  void begin(double t, double h, const double* q, const double* v, const double* const* moments);
  /// Adds the forces f_k P_k over [0, part h] along a modal shape.
  void add_force(Eigen::Ref<const Eigen::VectorXd> shape, const std::array<double, 3>& f, double part);
  /// Computes q() and v() at the time t + part h, 0 < part <= 1.
  void find(double part);
  const double* q() const;
  const double* v() const;

  /// shape . q, shape . v and weight . q. All arrays are padded.
  static std::array<double, 3> products(const Eigen::VectorXd& shape, const Eigen::VectorXd& weight, const double* q,
                                        const double* v);
  std::array<double, 3> products(const Eigen::VectorXd& shape, const Eigen::VectorXd& weight) const {
    return products(shape, weight, q(), v());
  }

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace butee::dynamics
