#include "butee/dynamics/contact_propagator.hpp"

#include <algorithm>
#include <cmath>

#include "butee/dynamics/kernel/stop_response.hpp"
#include "butee/linalg/kernel/dense.hpp"

namespace butee::dynamics {
namespace {

/// The error of cubic Hermite interpolation is at most this times (omega h)^4 times the amplitude,
/// and at most twice the amplitude.
constexpr double kHermite = 1.0 / 384.0;

/// Number of forces whose responses are summed before they are added to the result.
constexpr std::size_t kTogether = 32;

kernel::Motion to_add_to(StopMotion& motion) {
  return {motion.end.data(), motion.speed.data(), motion.middle.data()};
}

}  // namespace

StopShapes::StopShapes(Eigen::MatrixXd shapes) : shapes_(std::move(shapes)) {
  if (count() == 0) return;
  if (count() <= linalg::DenseProduct::kMostRows) to_stops_ = linalg::DenseProduct(shapes_.transpose());
  if (modes() <= linalg::DenseProduct::kMostRows) to_modes_ = linalg::DenseProduct(shapes_);
}

void StopShapes::displacement(const double* q, double* w) const {
  if (!to_stops_.empty()) return to_stops_.multiply(q, w);
  Eigen::Map<Vector>(w, count()).noalias() = shapes_.transpose() * Eigen::Map<const Vector>(q, modes());
}

void StopShapes::displacement(const double* q, const double* v, double* w, double* wv) const {
  if (!to_stops_.empty()) return to_stops_.multiply(q, v, w, wv);
  displacement(q, w);
  displacement(v, wv);
}

void StopShapes::force(std::span<const Index> stops, const double* f, double* r) const {
  if (!to_modes_.empty()) return to_modes_.multiply(stops, f, r);
  Eigen::Map<Vector> sum(r, modes());
  sum.setZero();
  for (const Index i : stops) sum += f[i] * shapes_.col(i);
}

ContactPropagator::ContactPropagator(ModalPropagator whole_flow, ModalPropagator half_flow, const StopShapes& stops,
                                     const Eigen::ArrayXd& frequencies, const std::vector<ModalHarmonic>& harmonics)
    : whole(std::move(whole_flow)),
      half(std::move(half_flow)),
      kernels_(&kernel::stop_response()),
      stops_(stops),
      columns_(static_cast<std::size_t>(stops.count())),
      derived_(columns_.size()) {
  if (stops.count() == 0) return;
  const Eigen::ArrayXd angle = h() * frequencies, shape = stops.matrix().cwiseAbs().rowwise().maxCoeff().array();
  // A cubic that matches the velocities of a fast mode departs from its motion by more than its
  // amplitude.
  swing_q = (kHermite * angle.square().square()).min(2.0 + 0.25 * angle) * shape;
  swing_v = (frequencies > 0.0).select(swing_q / frequencies, 0.0);
  // Within a step a force moves a mode by at most this (also in resonance), and away from the cubic
  // by at most h^4/384 times the fourth derivative, f'' - omega^2 f. f'' of a parabola is 4 bend/h^2.
  const Eigen::ArrayXd most = h() * h() * (angle > 2.0).select((angle + 2.0) / angle.square().max(1.0), 1.0) * shape;
  swing_force = most * (kHermite * angle.square()).min(2.0 + 0.25 * angle);
  swing_bend = 4.0 * kHermite * most;
  for (const ModalHarmonic& harmonic : harmonics) {
    const double turn = h() * harmonic.angular_frequency;
    swing_harmonics += (most * (kHermite * (angle.square() + turn * turn)).min(2.0 + 0.25 * angle) *
                        (harmonic.cosine.square() + harmonic.sine.square()).sqrt())
                           .sum();
  }
}

Index ContactPropagator::padded(Index stops) {
  return linalg::kernel::chunks_for(stops) * linalg::kernel::kChunk;
}

Index ContactPropagator::next_register(Index begin) {
  return begin + linalg::kernel::kChunk;
}

const Eigen::ArrayXXd& ContactPropagator::compute_columns(Index i) {
  Eigen::ArrayXXd& columns = columns_[static_cast<std::size_t>(i)];
  columns.setZero(padded(stops_.count()), 9);
  const auto shape = stops_.of(i).array();
  Eigen::ArrayXd q(shape.size()), v(shape.size());
  for (int k = 0; k < 3; ++k) {
    q = whole.force_q(k) * shape;
    v = h() * whole.force_v(k) * shape;
    stops_.displacement(q.data(), v.data(), columns.col(3 * k).data(), columns.col(3 * k + 1).data());
    // P_k of the step, expressed by those of its first half.
    if (k == 0) q = half.force_q(0) * shape;
    if (k == 1) q = 0.5 * (half.force_q(1) - half.force_q(0)) * shape;
    if (k == 2) q = (0.25 * half.force_q(2) - 0.75 * half.force_q(1)) * shape;
    stops_.displacement(q.data(), columns.col(3 * k + 2).data());
  }
  return columns;
}

const Eigen::ArrayXd& ContactPropagator::mobilities() {
  if (mobilities_.size() == 0)
    mobilities_ = (stops_.matrix().array().square().matrix().transpose() * whole.force_q(0).matrix()).array();
  return mobilities_;
}

ContactPropagator::Coupling ContactPropagator::own_coupling(Index i) {
  const Eigen::ArrayXXd& all = columns(i);
  Coupling own{};
  for (Index row = 0; row < 3; ++row)
    for (Index k = 0; k < 3; ++k) own[static_cast<std::size_t>(row)][static_cast<std::size_t>(k)] = all(i, 3 * k + row);
  return own;
}

double ContactPropagator::add_force(Index i, const std::array<double, 3>& force, double speed_weight,
                                    std::span<const Index> registers, StopMotion& motion) {
  const Eigen::ArrayXXd& all = columns(i);
  const double most =
      kernels_->add_force({{all.data(), all.rows()}, force}, speed_weight, registers, to_add_to(motion));
  return std::isfinite(motion.end[i]) ? most : most + motion.end[i];
}

void ContactPropagator::add_forces(std::span<const Index> stops, const std::array<Eigen::ArrayXd, 3>& force,
                                   std::span<const Index> registers, StopMotion& motion) {
  std::array<kernel::StopForce, kTogether> some;
  for (std::size_t first = 0; first < stops.size(); first += kTogether) {
    const auto these = stops.subspan(first, std::min(kTogether, stops.size() - first));
    std::transform(these.begin(), these.end(), some.begin(), [&](Index i) {
      const Eigen::ArrayXXd& all = columns(i);
      return kernel::StopForce{{all.data(), all.rows()}, {force[0][i], force[1][i], force[2][i]}};
    });
    kernels_->add_forces({some.data(), these.size()}, registers, to_add_to(motion));
  }
}

}  // namespace butee::dynamics
