#pragma once

namespace butee::conformance {

/// The allocations of this process so far, those of the libraries that it loads among them; -1 where they are not
/// counted: under the sanitizers, which have an allocator of their own.
long allocation_count();

}  // namespace butee::conformance
