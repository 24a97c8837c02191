#include "integrators/exponential/fast_velocities.hpp"

#include <cmath>

#include "integrators/quintic.hpp"

namespace butee::integrators {
namespace {

/// The largest sum of motions of many frequencies over their root sum of squares (chosen).
constexpr double kIncoherent = 2.0;

}  // namespace

FastVelocities::FastVelocities(const dynamics::ModalSystem& modal)
    : modal_(modal), rates_(modal.frequencies() + 2.0 * modal.decay()) {}

double FastVelocities::departure(Index dof, double h, const double* v0, const double* v1) const {
  const Eigen::Map<const Eigen::ArrayXd> begin(v0, rates_.size()), end(v1, rates_.size());
  const auto turn = h * rates_;
  const double of_slope = quintic_error(1.0, 1.0).v;
  const double square = (modal_.shape_rows().col(dof).array() * begin.abs().max(end.abs()) *
                         (of_slope * turn.square().square() * turn).min(1.0))
                            .square()
                            .sum();
  return kIncoherent * std::sqrt(square);
}

}  // namespace butee::integrators
