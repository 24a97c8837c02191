#include "integrators/exponential/hidden_modes.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

/// Hidden modes move every stop by less than this part of their largest displacement (chosen). Errors of other modes
/// are 20 times those at the stops at most.
constexpr double kHidden = 0.05;
/// Their error between breakpoints as a part of the error bound of outputs (chosen).
constexpr double kPart = 0.05;
/// Far more than a step of any run needs; the number must fit into an int.
constexpr double kMostParts = 16777216.0;

}  // namespace

HiddenModes::HiddenModes(const dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal, double tolerance)
    : allowed_(kPart * tolerance) {
  if (modal.stop_count() == 0) return;
  double fastest_load = 0.0;
  for (const dynamics::ModalHarmonic& harmonic : modal.harmonics())
    fastest_load = std::max(fastest_load, std::abs(harmonic.angular_frequency));
  sizes_.setZero(modal.size());
  Index dof = 0;
  for (const model::NodalDof& free : dynamics.system().dofs.free()) {
    if (!is_rotation(free.kind)) sizes_ = sizes_.max(modal.shape_rows().col(dof).array().abs());
    ++dof;
  }
  const Eigen::ArrayXd at_stops = modal.stop_shapes().matrix().cwiseAbs().rowwise().maxCoeff();
  for (Index k = 0; k < modal.size(); ++k)
    if (at_stops[k] < kHidden * sizes_[k])
      modes_.push_back({k, modal.frequencies()[k] + 2.0 * modal.decay()[k] + fastest_load});
}

int HiddenModes::parts(const State& from, const State& to, Through polynomial) const {
  if (modes_.empty()) return 1;
  // The error of Hermite's polynomials is h^4/384 of the fourth derivative, or h^6/46080 of the sixth.
  const double power = polynomial == Through::speeds ? 4.0 : 6.0,
               divisor = polynomial == Through::speeds ? 384.0 : 46080.0, h = to.t - from.t;
  const auto amplitude = [&](const Mode& mode) {
    const Index k = mode.index;
    const double by_speed = std::max(std::abs(from.v[k]), std::abs(to.v[k]));
    return sizes_[k] *
           (std::max(std::abs(from.q[k]), std::abs(to.q[k])) + (mode.rate > 0.0 ? by_speed / mode.rate : 0.0));
  };
  const Eigen::Map<const Eigen::ArrayXd> q0(from.q, sizes_.size()), q1(to.q, sizes_.size());
  const double allowed = allowed_ * (sizes_ * q0.abs().max(q1.abs())).sum();
  if (!(allowed > 0.0)) return 1;
  for (double parts = 1.0;;) {
    double error = 0.0;
    for (const Mode& mode : modes_) {
      const double turn = mode.rate * h / parts, square = turn * turn;
      error +=
          amplitude(mode) * std::min(1.0, square * square * (polynomial == Through::speeds ? 1.0 : square) / divisor);
    }
    if (!(error > allowed)) return static_cast<int>(parts);
    if (parts >= kMostParts) return static_cast<int>(kMostParts);
    parts = std::clamp(std::ceil(parts * std::pow(error / allowed, 1.0 / power)), parts + 1.0, kMostParts);
  }
}

}  // namespace butee::integrators
