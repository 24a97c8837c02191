#include "integrators/exponential/derivative_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "integrators/exponential/load_parabola.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

using Eigen::ArrayXd;

// Without contact only its load adds energy to a mode: sqrt(v^2 + omega^2 q^2) grows by at most the
// integral of |f|. Higher derivatives follow from q'' = f - omega^2 q - 2 delta q'.
void DerivativeBounds::find(std::size_t breakpoint) {
  if (known_ == breakpoint) return;
  known_ = breakpoint;
  const double t = breakpoints_.time(breakpoint), h = breakpoints_.time(breakpoint + 1) - t;
  std::array<ArrayXd, 5> load;  // bounds of f and its first four derivatives
  for (ArrayXd& bound : load) bound.setZero(modal_.size());
  for (const dynamics::ModalHarmonic& harmonic : modal_.harmonics()) {
    double factor = 1.0;
    for (ArrayXd& bound : load) {
      bound += factor * (harmonic.cosine.square() + harmonic.sine.square()).sqrt();
      factor *= harmonic.angular_frequency;
    }
  }
  for (const dynamics::ModalSystem::OtherLoad& other : modal_.other_loads()) {
    const LoadParabola f(*other.in_time, t, t + h);
    const double bend = 4.0 * std::abs(f.bend());
    load[0] += f.largest() * other.shape.abs();
    load[1] += (std::abs(f.end - f.begin) + bend) / h * other.shape.abs();
    load[2] += bend / (h * h) * other.shape.abs();
  }
  const ArrayXd &omega = modal_.frequencies(), squares = omega.square();
  const ArrayXd decay = 2.0 * modal_.decay();
  const Eigen::Map<const ArrayXd> q(breakpoints_.q(breakpoint), modal_.size()),
      v(breakpoints_.v(breakpoint), modal_.size());
  of_[1] = (v.square() + squares * q.square()).sqrt() + h * load[0];
  of_[0] = (omega * h > 1.0).select(of_[1] / omega, q.abs() + h * of_[1]);
  of_[2] = load[0] + omega * (omega * of_[0]).min(of_[1]) + decay * of_[1];
  for (std::size_t k = 3; k < of_.size(); ++k) of_[k] = load[k - 2] + squares * of_[k - 2] + decay * of_[k - 1];
}

void DerivativeBounds::departure(double begin, double end, std::span<const Index> dofs, time::Interpolated out) {
  find(breakpoints_.before(begin));
  const double h = end - begin;
  const QuinticError error = quintic_error(h, 1.0);
  const auto& of = of_;
  // The sums of the Hermite functions and of their derivatives also bound the difference from a
  // quintic.
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const auto shape = modal_.shape_rows().col(dofs[i]).array().abs();
    if (!out.x.empty())
      out.x[i] = (shape * (error.x * of[6]).min(2.0 * of[0] + 0.4 * h * of[1] + 0.035 * h * h * of[2])).sum();
    if (!out.v.empty()) out.v[i] = (shape * (error.v * of[6]).min(5.0 * of[1] + 0.3 * h * of[2])).sum();
    if (!out.a.empty()) out.a[i] = (shape * (error.a * of[6]).min(18.0 / h * of[1] + 3.0 * of[2])).sum();
  }
}

}  // namespace butee::integrators
