#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/state.hpp"

namespace butee::record {

/// The accelerations of a state for output. A step ends before a jump of the loads; where they jump, the values are
/// those after the jump, as are those of loads, reactions and section forces.
class Accelerations {
 public:
  /// `dynamics` must outlive this object.
  explicit Accelerations(dynamics::Dynamics& dynamics) : dynamics_(dynamics) {}

  /// Valid until the next call.
  const Vector& of(const time::State& state) {
    if (!discontinuities_) discontinuities_ = dynamics_.load_discontinuities();
    if (!std::binary_search(discontinuities_->begin(), discontinuities_->end(), state.t) ||
        !dynamics_.loads_jump(state.t))
      return state.a;
    after_.resize(state.x.size());
    dynamics_.acceleration(state.t, state.x, state.v, after_);
    return after_;
  }

 private:
  dynamics::Dynamics& dynamics_;
  std::optional<std::vector<double>> discontinuities_;  ///< of the loads, s; found when they are needed
  Vector after_;
};

}  // namespace butee::record
