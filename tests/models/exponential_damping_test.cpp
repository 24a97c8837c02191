// exponential where dashpots make modes decay within a step.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::exponential_damping_test {
namespace {

/// 10 t on a dashpot with a time constant of 0.23 ms, which a load of 113.8 rad/s moves against a stop and away from
/// it; `more` adds elements. Steps with contact may be longer than the time constant.
std::string overdamped(const std::string& amplitude, const std::string& more) {
  return R"(schema = 1
[[element]]
type = "mass"
name = "m"
mass = 10406.9
[[element]]
type = "spring"
node = "m"
stiffness = 2.63647e9
damping = 4.57016e7
[[contact]]
type = "stop"
nodes = "m"
sides = "both"
gap = 7.29554e-9
stiffness = 8.73899e8
law = "linear"
[integrator]
end_time = 0.08
[[load]]
node = "m"
type = "harmonic"
angular_frequency = 113.765
amplitude = )" +
         amplitude + "\n" + more;
}

/// With one DOF (SingleStep), and with a second one (ExponentialStep).
TEST(Exponential, FollowsOverdampedMotionAwayFromAStop) {
  const std::string second = R"([[element]]
type = "mass"
name = "n"
mass = 1e3
[[element]]
type = "spring"
node = "n"
stiffness = 1e6
)";
  std::vector<double> times;
  for (int i = 1; i < 40; ++i) times.push_back(2e-3 * i);
  for (const std::string& more : {std::string(), second})
    for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6}) {
      double worst = 0.0;
      for (int amplitude = 100; amplitude < 300; amplitude += 10) {
        const std::string scene = overdamped(std::to_string(amplitude), more);
        SceneRun ours(scene, {"integrator.type=exponential", "integrator.tolerance=" + std::to_string(tolerance)}),
            reference(scene, {"integrator.type=exact"});
        const Index m = reference.dof("m");
        Sampler found(m, times), wanted(m, times);
        ours.simulation().add(found);
        reference.simulation().add(wanted);
        ASSERT_TRUE(ours.run().completed) << ours.simulation().report().message;
        ASSERT_TRUE(reference.run().completed);
        double largest = 0.0, error = 0.0;
        for (std::size_t i = 0; i < times.size(); ++i) {
          largest = std::max(largest, std::abs(wanted.v[i]));
          error = std::max(error, std::abs(found.v[i] - wanted.v[i]));
        }
        worst = std::max(worst, error / largest);
      }
      EXPECT_LT(worst, 10.0 * tolerance) << (more.empty() ? "one DOF" : "two DOFs");
    }
}

}  // namespace
}  // namespace butee::test::exponential_damping_test
