// Methods with `type` and `end_time` alone, and `--set integrator.type` on scenes with keys of another method.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::method_choice_test {
namespace {

/// A mass that a triangular impulse of 0.2 ns drives against its stops: v0 = 1e9 N 1e-10 s/1 kg = 0.1 m/s.
std::string struck(const std::string& integrator) {
  return R"(
    schema = 1
    [[element]]
    type = "mass"
    name = "m"
    mass = 1.0
    [[element]]
    type = "spring"
    node = "m"
    stiffness = 1e4
    [[contact]]
    type = "stop"
    nodes = "m"
    gap = 5e-4
    law = "linear"
    stiffness = 1e6
    [[load]]
    node = "m"
    type = "table"
    times = [0.25, 0.2500000001, 0.2500000002]
    values = [0.0, 1e9, 0.0]
    [integrator]
    end_time = 0.26
)" + integrator;
}

double last_displacement(const std::string& toml) {
  SceneRun run(toml);
  EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
  return run.simulation().state().x[0];
}

TEST(MethodChoice, ExactIgnoresTheToleranceOfAScene) {
  // Instants near 0.25 s have a spacing of 5.6e-17 s: the three instants of the load are exact to 1e-6 of its
  // length.
  constexpr double kInstants = 3e-6;
  const double w = 100.0, closed = std::sqrt(1e6 + 1e4), v0 = 0.1, gap = 5e-4;
  // Closed form: free motion to the gap, then oscillation about the closed stop's rest position.
  const double t1 = std::asin(gap * w / v0) / w, v1 = v0 * std::cos(w * t1), rest = 1e6 * gap / (1e6 + 1e4);
  const double amplitude = std::hypot(gap - rest, v1 / closed), phase = std::atan2(gap - rest, v1 / closed);
  const double contact = (std::acos(-1.0) - 2.0 * phase) / closed;
  const double t = 0.01 - 1e-10 - t1 - contact;  // time since it left the stop with velocity -v1
  ASSERT_GT(t, 0.0);
  ASSERT_GT(amplitude, 0.0);
  const double expected = gap * std::cos(w * t) - v1 / w * std::sin(w * t);
  for (const std::string key : {"", "tolerance = 1e-4\n", "tolerance = 0.1\n", "tolerance = 1e-4\ntime_step = 0.1\n"})
    EXPECT_NEAR(last_displacement(struck("type = \"exact\"\n" + key)), expected, kInstants * gap) << key;
  const double one = last_displacement(struck("type = \"exact\"\n"));
  EXPECT_EQ(last_displacement(struck("type = \"exact\"\ntolerance = 1e-2\n")), one);
  EXPECT_NE(last_displacement(struck("type = \"exact\"\nseries_tolerance = 1e-2\n")), one);
}

TEST(MethodChoice, ExactSaysInOneLineThatAToleranceIsIgnored) {
  const TemporaryFolder folder;
  folder.write("scene.toml", struck("tolerance = 1e-4\n"));
  const Outcome outcome = run_program({"run", "scene.toml", "-q", "--set", "integrator.type=exact"}, folder.path());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.errors.find("integrator.tolerance: is ignored by exact"), std::string::npos) << outcome.errors;
  EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
}

/// A mass driven against its stops by a load.
std::string driven(const std::string& integrator) {
  return R"(
    schema = 1
    [[element]]
    type = "mass"
    name = "m"
    mass = 1.0
    [[element]]
    type = "spring"
    node = "m"
    stiffness = 1e4
    [[contact]]
    type = "stop"
    nodes = "m"
    gap = 5e-4
    law = "linear"
    stiffness = 1e6
    [[load]]
    node = "m"
    type = "harmonic"
    amplitude = 20.0
    angular_frequency = 60.0
    [integrator]
    end_time = 0.2
)" + integrator;
}

TEST(MethodChoice, NewmarksIterationHasDefaults) {
  const std::string given = "residual_tolerance = 1e-9\nincrement_tolerance = 1e-9\nmax_iterations = 20\n";
  for (const std::string method :
       {"type = \"NM1\"\ntime_step = 1e-5\n", "type = \"NM2\"\ntime_step = 1e-5\ntarget_error = 1e-3\n"})
    EXPECT_EQ(last_displacement(driven(method)), last_displacement(driven(method + given))) << method;
}

TEST(MethodChoice, BySetPutsKeysOfOtherMethodsAside) {
  const TemporaryFolder folder;
  folder.write("scene.toml", driven("type = \"NM2\"\ntime_step = 1e-4\ntarget_error = 1e-3\nmax_iterations = 9\n"));
  const Outcome outcome = run_program({"run", "scene.toml", "-q", "--set", "integrator.type=rk4"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("--set integrator.type=rk4: the file's keys target_error, max_iterations are ignored, "
                                "because rk4 does not have them"),
            std::string::npos)
      << outcome.errors;
  // The written scene can be run again unchanged.
  EXPECT_EQ(run_program({"run", "scene-results/model.toml", "-q", "-o", "again"}, folder.path()).errors, "");
  // An overridden key that belongs to another method, or to none, is still an error.
  for (const char* wrong : {"integrator.beta=0.3", "integrator.colour=3"}) {
    const Outcome refused =
        run_program({"run", "scene.toml", "--set", "integrator.type=rk4", "--set", wrong}, folder.path());
    EXPECT_EQ(refused.status, 2) << wrong;
  }
  folder.write("wrong.toml", struck("type = \"rk4\"\ntime_step = 1e-4\nmax_iterations = 9\n"));
  const Outcome refused = run_program({"run", "wrong.toml"}, folder.path());
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.errors.find("is no parameter of rk4; it belongs to newmark, newmark_adaptive"), std::string::npos)
      << refused.errors;
}

TEST(MethodChoice, BySetPutsKeysAsideInACompareToo) {
  const TemporaryFolder folder;
  folder.write("scene.toml", driven("type = \"NM2\"\ntime_step = 1e-4\ntarget_error = 1e-3\n") +
                                 "[[output.probe]]\nlabel = \"m\"\nnode = \"m\"\nquantities = [\"u\"]\n");
  folder.write("study.toml",
               "schema = 1\n[study]\nscenes = [\"scene.toml\"]\nset = [\"integrator.type=rk4\"]\n"
               "[[study.method]]\ntype = \"rk4\"\nsweep = \"time_step\"\nvalues = [1e-4]\n");
  const Outcome outcome = run_program({"compare", "study.toml", "-q"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("the file's key target_error is ignored"), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace butee::test::method_choice_test
