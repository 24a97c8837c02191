#include "integrators/exponential/propagation.hpp"

#include "butee/dynamics/load_parabola.hpp"

namespace butee::integrators {

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
    const dynamics::LoadParabola f(*load.in_time, t, t_end);
    // In P_0, P_1 and P_2.
    const double p0 = (f.begin + 4.0 * f.middle + f.end) / 6.0, p1 = 0.5 * (f.end - f.begin), p2 = f.bend() / 3.0;
    q += load.shape * (p0 * flow.force_q(0) + p1 * flow.force_q(1) + p2 * flow.force_q(2));
    if (v != nullptr) *v += load.shape * (p0 * flow.force_v(0) + p1 * flow.force_v(1) + p2 * flow.force_v(2));
  }
}

}  // namespace butee::integrators
