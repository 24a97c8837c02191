#include "apps/conformance/allocation_count.hpp"

#include <atomic>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

namespace butee::conformance {
long allocation_count() {
  return -1;
}
}  // namespace butee::conformance

#else

namespace {
std::atomic<long> allocations{0};
}

// The program's own malloc overrides that of the C library, also for all libraries that the program loads.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);

__attribute__((visibility("default"))) void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
__attribute__((visibility("default"))) void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
__attribute__((visibility("default"))) void* realloc(void* old, std::size_t size) {
  ++allocations;
  return __libc_realloc(old, size);
}
}

namespace butee::conformance {
long allocation_count() {
  return allocations;
}
}  // namespace butee::conformance

#endif
