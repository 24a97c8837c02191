#pragma once

#include <cstdint>

#include <butee/linalg/counters.hpp>

namespace butee::stress {

/// Measure of work that limits runs: evaluations and solves; their number is the same on every machine.
inline std::int64_t work_of(const linalg::Counters& c) {
  return c.force_evaluations + c.contact_evaluations + c.solves + c.factorizations;
}

}  // namespace butee::stress
