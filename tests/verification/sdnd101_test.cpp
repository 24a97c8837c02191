#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"
#include "verification/turning_points.hpp"

namespace butee::test::sdnd101_test {
namespace {

/// The published numbers have 7 digits.
constexpr double kPrinted = 2e-7;
/// Newmark lengthens a period by (omega h)^2/12 and has an error of O(h^2) in the instant of a contact
/// change: h = 1e-5 s here.
constexpr double kNewmark = 1e-5;

/// A mass moves against an elastic stop without a gap. Source: the validation case SDND101 of code_aster. Its
/// numbers follow from half sines: contact lasts pi/w1, free flight pi/w0, the peak force is k_c v0/w1, the
/// impulse is 2 k_c v0/w1^2, w0 = sqrt(k/m), w1 = sqrt((k + k_c)/m).
constexpr const char* kScene = R"(
schema = 1

[[element]]
type = "mass"
name = "ball"
mass = 100.0

[[element]]
type      = "spring"
node      = "ball"
stiffness = 1.0e4

[[contact]]
type      = "stop"
nodes     = "ball"
sides     = "positive"
gap       = 0.0
law       = "linear"
stiffness = 1.0e6

[initial]
velocity = [{ nodes = "ball", value = 1.0 }]

[integrator]
type      = "rk4"
time_step = 1.0e-5
end_time  = 0.5

[integrator.newmark]
residual_tolerance  = 1.0e-10
increment_tolerance = 1.0e-10
max_iterations      = 20
)";

class Sdnd101 : public testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(Sdnd101, ContactsForcesAndPeaksAreThePublishedOnes) {
  const auto [method, tolerance] = GetParam();
  SceneRun scene(kScene, {std::string("integrator.type=") + method});
  record::ImpactRecorder recorder(scene.dynamics());
  TurningPoints peaks(scene.dof("ball"));
  scene.simulation().add(recorder);
  scene.simulation().add(peaks);
  ASSERT_TRUE(scene.run().completed);

  const auto impacts = recorder.impacts();
  ASSERT_EQ(impacts.size(), 2U);
  for (const record::Impact& impact : impacts) {
    EXPECT_EQ(impact.node, "ball");
    EXPECT_EQ(impact.side, 1);
    ASSERT_TRUE(impact.t_out.has_value());
    EXPECT_NEAR(*impact.t_out - impact.t_in, 0.0312600, tolerance * 0.5);
    EXPECT_NEAR(impact.peak_force, 9950.372, tolerance * 9950.372);
    EXPECT_NEAR(impact.impulse, 198.0198, tolerance * 198.0198);
    EXPECT_NEAR(impact.impact_speed, 1.0, tolerance);
  }
  ASSERT_EQ(peaks.t.size(), 2U);
  EXPECT_NEAR(peaks.t[0], 0.0156300, tolerance * 0.5);
  EXPECT_NEAR(peaks.t[1], 0.3610493, tolerance * 0.5);

  const double w0 = std::sqrt(1e4 / 100), w1 = std::sqrt(1.01e6 / 100);
  EXPECT_NEAR(impacts[1].t_in, std::numbers::pi * (1 / w0 + 1 / w1), tolerance);
}

TEST(Sdnd101File, ImpactsCsvHoldsThePublishedNumbers) {
  const TemporaryFolder folder;
  folder.write("scene.toml", std::string(kScene) + "\n[output]\nimpacts = true\n");
  const Outcome outcome = run_program({"run", "scene.toml", "-o", "out"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const CsvTable impacts(folder.file("out/impacts.csv"));
  ASSERT_EQ(impacts.rows(), 2U);
  EXPECT_EQ(impacts.text_column("node"), (std::vector<std::string>{"ball", "ball"}));
  for (std::size_t i = 0; i < impacts.rows(); ++i) {
    EXPECT_EQ(impacts.column("side")[i], 1.0);
    EXPECT_NEAR(impacts.column("t_out")[i] - impacts.column("t_in")[i], 0.0312600, kPrinted * 0.5);
    EXPECT_NEAR(impacts.column("peak_force")[i], 9950.372, kPrinted * 9950.372);
    EXPECT_NEAR(impacts.column("impulse")[i], 198.0198, kPrinted * 198.0198);
    EXPECT_NEAR(impacts.column("impact_speed")[i], 1.0, kPrinted);
  }
}

INSTANTIATE_TEST_SUITE_P(methods, Sdnd101, testing::Values(std::pair("rk4", kPrinted), std::pair("newmark", kNewmark)),
                         [](const auto& instance) { return std::string(instance.param.first); });

}  // namespace
}  // namespace butee::test::sdnd101_test
