#pragma once

#include <array>
#include <vector>

#include "integrators/exponential/contact_newton.hpp"
#include "integrators/exponential/single_mode.hpp"

namespace butee::integrators {

/// A dynamics::ContactPropagator for one mode and one stop, in scalars.
struct SingleFlow {
  int index = 0;
  double h = 0.0;  ///< s; 0: not filled yet
  double qq, qv, vq, vv, half_qq, half_qv;
  double hermite_q, hermite_v, hermite_loads;  ///< Hermite interpolation errors per q and v, and of the loads
  std::array<double, 3> force_q, force_v;
  PathCoupling coupling;
  ContactNewton::Matrix closed_inverse;
  double unresolved;  ///< h^2 times the stop's shape squared times unresolved_part()
  struct Harmonic {
    std::array<double, 6> load;  ///< response of q, v and half_q to its cosine and its sine
    Phase turn;                  ///< phase angle of the load over the step
  };
  std::vector<Harmonic> harmonics;
};

/// The propagators of one mode for steps of the grid, of which recent ones are cached, and for a
/// step of any length.
class SingleFlows {
 public:
  /// All must outlive it.
  SingleFlows(dynamics::ModalSystem& modal, const SingleMode& mode, const ContactNewton& newton)
      : modal_(modal), mode_(mode), newton_(newton) {}

  const SingleFlow& on_grid(int index) {
    SingleFlow& flow = flows_[static_cast<std::size_t>(index & 7)];
    if (flow.h == 0.0 || flow.index != index) {
      fill(modal_.propagator(index), flow);
      flow.index = index;
    }
    return flow;
  }
  const SingleFlow& odd(double h) {
    fill(modal_.odd(h), odd_);
    return odd_;
  }

 private:
  void fill(dynamics::ContactPropagator& from, SingleFlow& flow) const;

  dynamics::ModalSystem& modal_;
  const SingleMode& mode_;
  const ContactNewton& newton_;
  std::array<SingleFlow, 8> flows_;  ///< cache, indexed by the last three bits of the grid index
  SingleFlow odd_;
};

}  // namespace butee::integrators
