#pragma once

#include <optional>

#include "butee/model/system.hpp"

namespace butee::solve {

/// The lowest and the highest natural frequency of a system without damping, rad/s. Rigid-body motion has frequency 0.
struct FrequencyRange {
  double lowest = 0.0;
  double highest = 0.0;
};

enum class StopState { open, closed };

/// The range with all stops open or all of them closed (K + S^T k_c S). Dense for small systems, Lanczos for large ones
/// (relative accuracy about 1e-6); nothing where Lanczos did not converge.
BUTEE_EXPORT std::optional<FrequencyRange> frequency_range(const model::System& system, StopState stops);

/// K, or K + S^T k_c S with all stops closed.
BUTEE_EXPORT SparseMatrix stiffness_with_stops(const model::System& system, StopState stops);

}  // namespace butee::solve
