// The critical steps that `check` and messages state against the growth of runs.
#include <cmath>
#include <cstdio>
#include <string>

#include <butee/time/diagnosis.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::critical_step_test {
namespace {

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

/// A mass of 1 kg on 100 N/m with a dashpot, in free motion.
std::string oscillator(double damping, double h) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
         "\"m\"\nstiffness = 100.0\ndamping = " +
         text(damping) +
         "\n[initial]\ndisplacement = [{ nodes = \"m\", value = 1.0 }]\n[integrator]\ntype = \"central_differences\"\n"
         "time_step = " +
         text(h) + "\nend_time = " + text(400.0 * h) + "\n";
}

/// Central differences take damping at the step before: (h omega)^2/4 + h c/m <= 1.
TEST(CriticalStep, OfCentralDifferencesCountsDamping) {
  for (const double c : {0.0, 2.0, 18.0}) {
    SceneRun one(oscillator(c, 1e-3));
    const auto critical = time::critical_steps(one.dynamics(), {"central_differences", 2.0, 1.0});
    ASSERT_TRUE(critical);
    const double ratio = c / 20.0, wanted = 2.0 * (std::sqrt(1.0 + 4.0 * ratio * ratio) - 2.0 * ratio) / 10.0;
    EXPECT_NEAR(critical->open, wanted, 1e-9) << c;
    SceneRun below(oscillator(c, 0.99 * critical->open)), above(oscillator(c, 1.03 * critical->open));
    EXPECT_TRUE(below.run().completed);
    EXPECT_LT(std::abs(below.simulation().state().x[0]), 20.0) << c;
    EXPECT_TRUE(!above.run().completed || std::abs(above.simulation().state().x[0]) > 1e3) << c;
  }
}

/// Two overdamped eigenvalues are taken as those of one mode.
TEST(CriticalStep, OfCentralDifferencesHoldsForOverdampedMotion) {
  SceneRun one(oscillator(60.0, 1e-4));
  const auto critical = time::critical_steps(one.dynamics(), {"central_differences", 2.0, 1.0});
  ASSERT_TRUE(critical);
  EXPECT_NEAR(critical->open * critical->open * 25.0 + critical->open * 60.0, 1.0, 1e-9);
  SceneRun below(oscillator(60.0, 0.99 * critical->open)), above(oscillator(60.0, 1.03 * critical->open));
  EXPECT_TRUE(below.run().completed);
  EXPECT_LT(std::abs(below.simulation().state().x[0]), 20.0);
  EXPECT_TRUE(!above.run().completed || std::abs(above.simulation().state().x[0]) > 1e3);
}

}  // namespace
}  // namespace butee::test::critical_step_test
