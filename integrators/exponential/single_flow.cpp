#include "integrators/exponential/single_flow.hpp"

#include "integrators/exponential/error_indicators.hpp"

namespace butee::integrators {

void SingleFlows::fill(dynamics::ContactPropagator& from, SingleFlow& flow) const {
  const dynamics::ModalPropagator &whole = from.whole, &half = from.half;
  flow.h = from.h();
  flow.qq = whole.qq()[0];
  flow.qv = whole.qv()[0];
  flow.vq = whole.vq()[0];
  flow.vv = whole.vv()[0];
  flow.half_qq = half.qq()[0];
  flow.half_qv = half.qv()[0];
  flow.hermite_q = from.swing_q[0];
  flow.hermite_v = from.swing_v[0];
  flow.hermite_loads = from.swing_harmonics;
  for (std::size_t k = 0; k < 3; ++k) {
    flow.force_q[k] = whole.force_q(static_cast<int>(k))[0] * mode_.stop_shape;
    flow.force_v[k] = whole.force_v(static_cast<int>(k))[0] * mode_.stop_shape;
  }
  flow.coupling = from.own_coupling(0);
  flow.closed_inverse = newton_.closed_inverse(flow.coupling);
  const double rate = std::sqrt(mode_.square + 4.0 * mode_.decay * mode_.decay);
  flow.unresolved = flow.h * flow.h * mode_.stop_shape * mode_.stop_shape * unresolved_part(flow.h * rate);
  flow.harmonics.clear();
  for (std::size_t j = 0; j < mode_.harmonics.size(); ++j) {
    const double angle = mode_.harmonics[j].angular_frequency * flow.h;
    flow.harmonics.push_back({{whole.harmonic_q(j, 0)[0], -whole.harmonic_q(j, 1)[0], whole.harmonic_v(j, 0)[0],
                               -whole.harmonic_v(j, 1)[0], half.harmonic_q(j, 0)[0], -half.harmonic_q(j, 1)[0]},
                              {std::cos(angle), std::sin(angle)}});
  }
}

}  // namespace butee::integrators
