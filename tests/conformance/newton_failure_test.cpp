#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::newton_failure_test {
namespace {

SceneRun strangled(const std::string& method, const std::string& reaction) {
  return SceneRun::of_model(
      "beam4", {"integrator.type=" + method, "integrator.max_iterations=1", "integrator.residual_tolerance=1e-15",
                "integrator.end_time=0.01", "integrator.on_newton_failure=" + reaction});
}

TEST(NewtonFailure, StopsAFixedStepWithADiagnosis) {
  SceneRun run = strangled("newmark", "stop");
  const auto& report = run.run();
  EXPECT_FALSE(report.completed);
  EXPECT_EQ(report.newton_failures, 1);
  EXPECT_NE(report.message.find("on_newton_failure"), std::string::npos) << report.message;
}

TEST(NewtonFailure, IsCountedWhereItIsKept) {
  SceneRun run = strangled("newmark", "keep");
  const auto& report = run.run();
  EXPECT_TRUE(report.completed) << report.message;
  EXPECT_EQ(report.steps, 1000);
  EXPECT_GT(report.newton_failures, 0);
}

TEST(NewtonFailure, HalvesAnAdaptiveStepDownToItsFloor) {
  SceneRun run = strangled("newmark_adaptive", "stop");
  const auto& report = run.run();
  EXPECT_FALSE(report.completed);
  EXPECT_EQ(report.rejected, report.newton_failures);
  EXPECT_LT(report.rejected, 60);
  EXPECT_NE(report.message.find("floor"), std::string::npos) << report.message;
}

}  // namespace
}  // namespace butee::test::newton_failure_test
