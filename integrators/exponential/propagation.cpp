#include "integrators/exponential/propagation.hpp"

namespace butee::integrators {
namespace {

/// In a step shorter than this fraction of the time, the load in the middle is taken as the mean of
/// those at the ends, since rounding would move the middle by more than 1e-9 of h.
constexpr double kShortest = 2e-7;

}  // namespace

void propagate(const dynamics::ModalSystem& modal, const dynamics::ModalPropagator& flow, const PropagationStart& start,
               double t_end, Eigen::ArrayXd& q, Eigen::ArrayXd* v) {
  const double t = start.t;
  q = flow.qq() * start.q + flow.qv() * start.v;
  if (v != nullptr) *v = flow.vq() * start.q + flow.vv() * start.v;
  if (start.constant_force != nullptr) {
    q += *start.constant_force * flow.force_q(0);
    if (v != nullptr) *v += *start.constant_force * flow.force_v(0);
  }
  for (std::size_t j = 0; j < start.phases.size(); ++j) {
    const auto [c, s] = start.phases[j];
    q += c * flow.harmonic_q(j, 0) - s * flow.harmonic_q(j, 1);
    if (v != nullptr) *v += c * flow.harmonic_v(j, 0) - s * flow.harmonic_v(j, 1);
  }
  for (const dynamics::ModalSystem::OtherLoad& load : modal.other_loads()) {
    const double f0 = load.in_time->value(t), f2 = load.in_time->value(t_end),
                 f1 = t_end - t < kShortest * t_end ? 0.5 * (f0 + f2) : load.in_time->value(0.5 * (t + t_end));
    // The parabola through three values, in P_0, P_1 and P_2.
    const double p0 = (f0 + 4.0 * f1 + f2) / 6.0, p1 = 0.5 * (f2 - f0), p2 = (f0 - 2.0 * f1 + f2) / 3.0;
    q += load.shape * (p0 * flow.force_q(0) + p1 * flow.force_q(1) + p2 * flow.force_q(2));
    if (v != nullptr) *v += load.shape * (p0 * flow.force_v(0) + p1 * flow.force_v(1) + p2 * flow.force_v(2));
  }
}

}  // namespace butee::integrators
