#pragma once

#include "../trust.hpp"

namespace butee::app::studies {

/// For the result "trust" of studies.
inline double horizon_of(scene::Scene& scene) {
  return find_trust(scene).horizon;
}

}  // namespace butee::app::studies
