#pragma once

#include <cstdint>

#include <butee/linalg/counters.hpp>

namespace butee::stress {

/// What bounds runs: evaluations and solves, of which the same scene takes as many on every machine.
inline std::int64_t work_of(const linalg::Counters& c) {
  return c.force_evaluations + c.contact_evaluations + c.solves + c.factorizations;
}

}  // namespace butee::stress
