#pragma once

#include <functional>

#include "apps/conformance/check.hpp"

namespace butee::conformance {

/// Runs `work` in a separate process: a signal, an exception or more than `time_limit` seconds become failed
/// findings.
Finding run_isolated(const std::function<Finding()>& work, double time_limit);

}  // namespace butee::conformance
