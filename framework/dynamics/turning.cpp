#include "butee/dynamics/turning.hpp"

#include <limits>

namespace butee::dynamics {
namespace {

/// y += factor A x; does nothing if A is 0 x 0 or the factor is zero.
void add_product(const SparseMatrix& matrix, double factor, const double* x, VectorRef y) {
  if (matrix.size() == 0 || factor == 0.0) return;
  y.noalias() += factor * (matrix * Eigen::Map<const Vector>(x, matrix.cols()));
}

}  // namespace

Turning::Turning(const model::System& system) : system_(system), time_(std::numeric_limits<double>::quiet_NaN()) {}

void Turning::set_time(double t) {
  if (t == time_) return;
  time_ = t;
  const double speed = system_.rotation->speed(t), acceleration = system_.rotation->acceleration(t);
  if (speed == speed_ && acceleration == acceleration_) return;
  speed_ = speed;
  acceleration_ = acceleration;
  ++revision_;
}

void Turning::subtract_forces(const double* x, double velocity_factor, ConstVectorRef v, VectorRef y) const {
  const double on_k = velocity_factor * system_.damping.stiffness_proportional;
  add_product(system_.circulatory, -speed_, x, y);
  add_product(system_.gyroscopic, -acceleration_, x, y);
  add_product(system_.gyroscopic, -velocity_factor * speed_ + on_k * acceleration_, v.data(), y);
  add_product(system_.circulatory, on_k * speed_, v.data(), y);
}

void Turning::add_damping_force(ConstVectorRef v, VectorRef y) const {
  add_product(system_.gyroscopic, speed_, v.data(), y);
}

void Turning::add_elastic_force(ConstVectorRef x, VectorRef y) const {
  add_product(system_.circulatory, speed_, x.data(), y);
  add_product(system_.gyroscopic, acceleration_, x.data(), y);
}

void Turning::subtract_rate(ConstVectorRef x, ConstVectorRef v, VectorRef y) const {
  // Omega'' is zero between the discontinuities of a piecewise linear speed.
  add_product(system_.gyroscopic, -acceleration_, v.data(), y);
  add_product(system_.circulatory, -acceleration_, x.data(), y);
}

void Turning::add_to(double on_d, double on_k, SparseMatrix& matrix) const {
  const double on_both = on_k - on_d * system_.damping.stiffness_proportional;
  if (system_.circulatory.size() > 0) matrix.coeffs() += on_both * speed_ * system_.circulatory.coeffs();
  if (system_.gyroscopic.size() > 0)
    matrix.coeffs() += (on_d * speed_ + on_both * acceleration_) * system_.gyroscopic.coeffs();
}

}  // namespace butee::dynamics
