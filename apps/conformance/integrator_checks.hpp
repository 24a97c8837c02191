#pragma once

#include "apps/conformance/check.hpp"

namespace butee::conformance {

// The demands on an integrator, each in a file with its like; see integrator_checks() for what they say.
Finding check_order(const Subject& subject);

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
