#pragma once

namespace butee::conformance {

/// Number of allocations of this process so far, including those of loaded libraries; -1 under the
/// sanitizers, which use their own allocator and are not counted.
long allocation_count();

}  // namespace butee::conformance
