// Bodies that stick rigidly throughout a run.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::rigid_stick_test {
namespace {

/// A load that never reaches the limit of a rigid stick: all terms of a Taylor series are rounding, which must not grow
/// in long steps; `exact` moved the body by 0.06 m.
TEST(RigidStick, StandsStillUnderAnOscillatingLoad) {
  for (const char* method : {"exact", "dopri5", "extrapolation8"})
    for (const char* stiffness : {"400.0", "50.0"}) {
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 0.3\n[[element]]\ntype = "
          "\"spring\"\nnode = \"m\"\nstiffness = " +
          std::string(stiffness) +
          "\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 30.0\nangular_frequency = "
          "50.0\nphase = 1.0\n[[contact]]\ntype = \"friction\"\nnodes = \"m\"\nnormal_force = "
          "100.0\nfriction = { coefficient = 0.5, stick = \"rigid\" }\n[integrator]\nend_time = 2.0\ntype = \"" +
          method + "\"\n");
      Peak peak(0);
      run.simulation().add(peak);
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      EXPECT_LT(peak.value, 1e-13) << method << " " << stiffness;
      EXPECT_LT(run.simulation().state().v.norm(), 1e-12) << method << " " << stiffness;
    }
}

}  // namespace
}  // namespace butee::test::rigid_stick_test
