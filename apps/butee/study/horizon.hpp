#pragma once

#include <optional>

#include <butee/core/error.hpp>

#include "../interruption.hpp"
#include "../trust.hpp"

namespace butee::app::studies {

/// Computes the result "trust" of studies.
inline std::optional<double> horizon_of(scene::Scene& scene) {
  try {
    return find_trust(scene).horizon;
  } catch (const RunError&) {
    if (interruption() != nullptr) return std::nullopt;
    throw;
  }
}

}  // namespace butee::app::studies
