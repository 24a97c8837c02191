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
/// with the Legendre polynomials P_k of the step. It is the motion that ModalPropagator gives at the end of a step,
/// without its tables: slow modes by a Taylor series, decaying oscillations by sine, cosine and exponential, the few
/// others (overdamped and fast, in resonance with a load without damping, or turning thousands of times a step) by a
/// ModalPropagator of their own. Its error is rounding. Checked against ModalPropagator in
/// tests/unit/modal_motion_test.cpp.
class BUTEE_EXPORT ModalMotion {
 public:
  /// `modal` must outlive it.
  explicit ModalMotion(const ModalSystem& modal);
  /// Takes modes with omega and delta in 1/s, which ascend in omega but for the last few. All must outlive it.
  ModalMotion(const Eigen::ArrayXd& omega, const Eigen::ArrayXd& delta, const std::vector<ModalHarmonic>& harmonics,
              const std::vector<ModalSystem::OtherLoad>& other_loads);
  ~ModalMotion();

  /// The size of arrays of `modes` here: whole registers, filled up with zeros.
  static Index padded(Index modes);

  /// Begins a step of length h at t, from q and v and the forces moments[k] P_k; nullptr: none. Padded, all of them.
  void begin(double t, double h, const double* q, const double* v, const double* const* moments);
  /// Adds the forces f_k P_k over [0, part h] along a modal shape.
  void add_force(Eigen::Ref<const Eigen::VectorXd> shape, const std::array<double, 3>& f, double part);
  /// Fills q() and v() for the time t + part h, 0 < part <= 1.
  void find(double part);
  const double* q() const;
  const double* v() const;

  /// shape . q, shape . v and weight . q, both padded, and q and v as well.
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
