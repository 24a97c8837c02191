#include "butee/core/zeros.hpp"

#include <cstdint>
#include <sys/mman.h>

namespace butee {
namespace {

constexpr std::uintptr_t kPage = std::uintptr_t{1} << 12U, kLargePage = std::uintptr_t{1} << 21U;
/// Shorter vectors stay in a cache.
constexpr Index kLong = Index{1} << 18U;
#ifdef MADV_COLLAPSE
constexpr int kCollapse = MADV_COLLAPSE;
#else
constexpr int kCollapse = 25;  // since Linux 6.1; older systems reject this advice
#endif

/// Only advice: systems that do not support it, and neighbouring data on the first and the last
/// page, are not affected. Memory that was used before has small pages, which are merged.
void ask_for_large_pages(Vector& vector) {
  const auto data = reinterpret_cast<std::uintptr_t>(vector.data());
  const std::uintptr_t begin = data & ~(kPage - 1),
                       end = data + static_cast<std::uintptr_t>(vector.size()) * sizeof(double);
  static_cast<void>(madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE));
  vector.setZero();
  for (std::uintptr_t page = data & ~(kLargePage - 1); page < end; page += kLargePage)
    static_cast<void>(madvise(reinterpret_cast<void*>(page), kLargePage, kCollapse));
}

}  // namespace

void make_room(Vector& vector, Index size) {
  if (vector.size() == size) return;
  vector.resize(size);
  if (size >= kLong) ask_for_large_pages(vector);
}

Vector zeros(Index size) {
  Vector vector;
  make_room(vector, size);
  vector.setZero();
  return vector;
}

}  // namespace butee
