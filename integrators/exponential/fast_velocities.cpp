#include "integrators/exponential/fast_velocities.hpp"

#include <cmath>

namespace butee::integrators {
namespace {

/// The error of the slope of Hermite's quintic is h^5 times the sixth derivative times the maximum of (s^3 (1 - s)^3)'
/// over 6!, 0.0537/720.
constexpr double kOfSlope = 7.5e-5;
/// The largest sum of motions of many frequencies over their root sum of squares (chosen).
constexpr double kIncoherent = 2.0;

}  // namespace

FastVelocities::FastVelocities(const dynamics::ModalSystem& modal)
    : modal_(modal), rates_(modal.frequencies() + 2.0 * modal.decay()) {}

double FastVelocities::departure(Index dof, double h, const double* v0, const double* v1) const {
  const Eigen::Map<const Eigen::ArrayXd> begin(v0, rates_.size()), end(v1, rates_.size());
  const auto turn = h * rates_;
  const double square = (modal_.shape_rows().col(dof).array() * begin.abs().max(end.abs()) *
                         (kOfSlope * turn.square().square() * turn).min(1.0))
                            .square()
                            .sum();
  return kIncoherent * std::sqrt(square);
}

}  // namespace butee::integrators
