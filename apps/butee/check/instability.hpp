#pragma once

#include <optional>

#include <butee/model/model.hpp>
#include <butee/model/system.hpp>

namespace butee::app::check {

/// A mode whose motion grows without contact, as e^(rate t).
struct Instability {
  double rate = 0.0;       ///< 1/s
  double frequency = 0.0;  ///< rad/s
  double speed = 0.0;      ///< speed of rotation, rad/s
};

/// The mode that grows fastest at the largest speed of rotation, if it grows by more than a factor of e in `end_time`.
/// Only scenes of up to kMostForInstability free DOFs whose damping or non-symmetric stiffness could feed motion are
/// examined.
inline constexpr Index kMostForInstability = 200;
std::optional<Instability> fastest_growth(const model::Model& model, const model::System& system, double end_time);

}  // namespace butee::app::check
