#include "integrators/exponential/hidden_modes.hpp"

#include <algorithm>
#include <cmath>

namespace butee::integrators {
namespace {

/// Hidden modes move every stop by less than this part of their largest displacement, or rotation for stops on
/// rotations (chosen). Errors of other modes are 20 times those at the stops at most.
constexpr double kHidden = 0.05;
/// A mode with less than this part of its kinetic energy in displacements, or in rotations, has but rounding there.
constexpr double kNoShare = 1e-20;
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
  const model::System& system = dynamics.system();
  const Vector masses = system.mass.diagonal();
  std::array<Eigen::ArrayXd, 2> energies, at_stops;
  for (auto* arrays : {&sizes_, &energies, &at_stops})
    for (Eigen::ArrayXd& of_kind : *arrays) of_kind.setZero(modal.size());
  Index dof = 0;
  for (const model::NodalDof& free : system.dofs.free()) {
    const std::size_t kind = is_rotation(free.kind) ? 1 : 0;
    const auto shape = modal.shape_rows().col(dof).array();
    sizes_[kind] = sizes_[kind].max(shape.abs());
    energies[kind] += masses[dof] * shape.square();
    ++dof;
  }
  Index stop = 0;
  for (const model::FreeStops& group : system.stops) {
    const auto some_end = static_cast<std::size_t>(std::max(group.a.front(), group.b.front()));
    Eigen::ArrayXd& of_kind = at_stops[is_rotation(system.dofs.free()[some_end].kind) ? 1 : 0];
    for (std::size_t i = 0; i < group.size(); ++i)
      of_kind = of_kind.max(modal.stop_shapes().matrix().col(stop++).array().abs());
  }
  for (std::size_t kind = 0; kind < 2; ++kind) {
    const auto is_none = energies[kind] <= kNoShare * (energies[0] + energies[1]);
    sizes_[kind] = is_none.select(0.0, sizes_[kind]);
    at_stops[kind] = is_none.select(0.0, at_stops[kind]);
  }
  const auto is_seen = [&](Index k, std::size_t kind) {
    return at_stops[kind][k] > 0.0 && at_stops[kind][k] >= kHidden * sizes_[kind][k];
  };
  for (Index k = 0; k < modal.size(); ++k)
    if (!is_seen(k, 0) && !is_seen(k, 1))
      modes_.push_back({k, modal.frequencies()[k] + 2.0 * modal.decay()[k] + fastest_load});
}

int HiddenModes::parts(const State& from, const State& to, Through polynomial) const {
  if (modes_.empty()) return 1;
  return static_cast<int>(std::max(parts(from, to, polynomial, sizes_[0]), parts(from, to, polynomial, sizes_[1])));
}

double HiddenModes::parts(const State& from, const State& to, Through polynomial, const Eigen::ArrayXd& sizes) const {
  // The error of Hermite's polynomials is h^4/384 of the fourth derivative, or h^6/46080 of the sixth.
  const double power = polynomial == Through::speeds ? 4.0 : 6.0,
               divisor = polynomial == Through::speeds ? 384.0 : 46080.0, h = to.t - from.t;
  const auto amplitude = [&](const Mode& mode) {
    const Index k = mode.index;
    const double by_speed = std::max(std::abs(from.v[k]), std::abs(to.v[k]));
    return sizes[k] *
           (std::max(std::abs(from.q[k]), std::abs(to.q[k])) + (mode.rate > 0.0 ? by_speed / mode.rate : 0.0));
  };
  const Eigen::Map<const Eigen::ArrayXd> q0(from.q, sizes.size()), q1(to.q, sizes.size());
  const double allowed = allowed_ * (sizes * q0.abs().max(q1.abs())).sum();
  if (!(allowed > 0.0)) return 1.0;
  for (double parts = 1.0;;) {
    double error = 0.0;
    for (const Mode& mode : modes_) {
      const double turn = mode.rate * h / parts, square = turn * turn;
      error +=
          amplitude(mode) * std::min(1.0, square * square * (polynomial == Through::speeds ? 1.0 : square) / divisor);
    }
    if (!(error > allowed)) return parts;
    if (parts >= kMostParts) return kMostParts;
    parts = std::clamp(std::ceil(parts * std::pow(error / allowed, 1.0 / power)), parts + 1.0, kMostParts);
  }
}

}  // namespace butee::integrators
