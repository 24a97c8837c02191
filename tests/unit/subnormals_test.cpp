#include <limits>

#include <butee/core/subnormals.hpp>
#include <gtest/gtest.h>

namespace butee::test::subnormals_test {
namespace {

/// Half of the smallest normal number, computed at run time, not by the compiler.
double half_of_smallest() {
  volatile double smallest = std::numeric_limits<double>::min();
  return 0.5 * smallest;
}

TEST(FlushedSubnormals, AreZeroWhileItLives) {
  ASSERT_GT(half_of_smallest(), 0.0);
  {
    const FlushedSubnormals flushed;
#if defined(__SSE2__) || defined(__aarch64__)
    EXPECT_EQ(half_of_smallest(), 0.0);
    { const FlushedSubnormals inner; }
    EXPECT_EQ(half_of_smallest(), 0.0) << "an inner one leaves it as it was";
#endif
  }
  EXPECT_GT(half_of_smallest(), 0.0);
}

}  // namespace
}  // namespace butee::test::subnormals_test
