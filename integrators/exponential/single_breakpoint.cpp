#include "integrators/exponential/single_breakpoint.hpp"

namespace butee::integrators {

ContactPath path_between(const SingleMode& mode, const SingleBreakpoint& from, const SingleBreakpoint& to) {
  return {mode.stop_shape * from.at.q, from.step.hv0, mode.stop_shape * to.at.q, from.step.hv1, from.step.quartic};
}

}  // namespace butee::integrators
