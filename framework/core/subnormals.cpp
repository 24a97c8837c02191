#include "butee/core/subnormals.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace butee {

#if defined(__SSE2__)

namespace {
constexpr unsigned kResultsToZero = 0x8000, kOperandsToZero = 0x0040;
}

FlushedSubnormals::FlushedSubnormals() : before_(_mm_getcsr()) {
  _mm_setcsr(static_cast<unsigned>(before_) | kResultsToZero | kOperandsToZero);
}
FlushedSubnormals::~FlushedSubnormals() {
  _mm_setcsr(static_cast<unsigned>(before_));
}

#elif defined(__aarch64__)

namespace {
constexpr std::uint64_t kToZero = std::uint64_t{1} << 24;
}

FlushedSubnormals::FlushedSubnormals() {
  asm volatile("mrs %0, fpcr" : "=r"(before_));
  asm volatile("msr fpcr, %0" : : "r"(before_ | kToZero));
}
FlushedSubnormals::~FlushedSubnormals() {
  asm volatile("msr fpcr, %0" : : "r"(before_));
}

#else

FlushedSubnormals::FlushedSubnormals() {}
FlushedSubnormals::~FlushedSubnormals() {}

#endif

}  // namespace butee
