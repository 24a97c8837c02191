#pragma once

#include "apps/conformance/check.hpp"

namespace butee::conformance {

// The requirements on an integrator, grouped by file; integrator_checks() describes them.
Finding check_order(const Subject& subject);

Finding check_stability(const Subject& subject);

Finding check_purity(const Subject& subject);
Finding check_restart(const Subject& subject);
Finding check_interpolation(const Subject& subject);
Finding check_allocation(const Subject& subject);

Finding check_end_time(const Subject& subject);
Finding check_agreement(const Subject& subject);
Finding check_overflow(const Subject& subject);
Finding check_independence(const Subject& subject);
Finding check_skipped_contact(const Subject& subject);

}  // namespace butee::conformance
