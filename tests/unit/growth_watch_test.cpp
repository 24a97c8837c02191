// Messages of a failing run: each states the place, the cause and a remedy.
#include <cmath>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::growth_watch_test {
namespace {

/// Two masses in a row, 1 kg and 0.01 kg, on springs; omega_max is about sqrt(1e6/0.01) = 1e4 rad/s.
std::string row_of_masses(const std::string& integrator, const std::string& more = "") {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"big\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
         "\"small\"\nmass = 0.01\n[[element]]\ntype = \"spring\"\nnode = \"big\"\nstiffness = 1e4\n[[element]]\ntype = "
         "\"spring\"\nnodes = [\"big\", \"small\"]\nstiffness = 1e6\n[initial]\nvelocity = [{nodes = \"big\", value = "
         "1.0}]\n[integrator]\nend_time = 10.0\n" +
         integrator + more;
}

/// RunReport::message of a run that fails.
std::string failure_of(const std::string& scene) {
  SceneRun run(scene);
  const time::RunReport& report = run.run();
  EXPECT_FALSE(report.completed);
  EXPECT_TRUE(run.simulation().state().x.allFinite());
  return report.message;
}

void expect_holds(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

constexpr double kHighest = 10050.0;  ///< rad/s, highest frequency of row_of_masses

/// Cross terms of a bearing feed a whirl at the rate ((|k + i q| - k)/2m)^(1/2) until stops limit it.
TEST(GrowthWatch, LetsCrossTermsFeedTheMotion) {
  const double k = 1e4, q = 3e3, rate = std::sqrt(0.5 * (std::hypot(k, q) - k));
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"d\"\nmass = 1.0\ndiametral_inertia = 0.01\npolar_inertia = "
      "0.02\n[[element]]\ntype = \"bearing\"\nnode = \"d\"\nstiffness = [[1e4, 3e3], [-3e3, 1e4]]\n[[contact]]\ntype = "
      "\"stop\"\nnodes = \"d\"\ndof = \"uy\"\ngap = 1.0\nstiffness = 1e6\n[initial]\ndisplacement = [{ nodes = \"d\", "
      "dof = "
      "\"uy\", value = 1e-6 }]\n[integrator]\nend_time = 0.9\n";
  for (const std::string method : {"type = \"auto\"\ntolerance = 1e-5\n", "type = \"rk4\"\ntime_step = 1e-4\n"}) {
    SceneRun run(scene + method);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    const Vector& x = run.simulation().state().x;
    // Half of the disturbance is in the whirl that grows.
    EXPECT_NEAR(std::log(std::hypot(x[run.dof("d", DofKind::uy)], x[run.dof("d", DofKind::uz)]) / 0.5e-6), rate * 0.9,
                0.1)
        << method;
  }
}

TEST(GrowthWatch, StopsAnUnstableRunLongBeforeItOverflows) {
  const double h = 2.9 / kHighest;  // RK4 grows by 19 % in each step
  SceneRun run(row_of_masses("type = \"rk4\"\ntime_step = " + to_text(h) + "\n"));
  const time::RunReport& report = run.run();
  EXPECT_FALSE(report.completed);
  EXPECT_LT(report.steps, 600);
  EXPECT_LT(run.simulation().state().v.lpNorm<Eigen::Infinity>(), 1e6);
  expect_holds(report.message, {"t = ", "step ", "h = ", "grows without a physical cause", "u of small",
                                "critical step of rk4", "time_step of", "newmark"});
}

/// The number behind "critical step of NAME, ".
double critical_step_in(const std::string& message) {
  const std::string mark = "critical step of ";
  const std::size_t at = message.find(mark);
  if (at == std::string::npos) return 0.0;
  return std::stod(message.substr(message.find(", ", at) + 2));
}

TEST(GrowthWatch, NamesTheCriticalStep) {
  for (const auto& [method, limit] : {std::pair{"rk4", 2.8284271}, std::pair{"central_differences", 2.0}}) {
    const std::string type = "type = \"" + std::string(method) + "\"\ntime_step = ";
    const double h = 1.3 * limit / kHighest;
    const double named = critical_step_in(failure_of(row_of_masses(type + to_text(h) + "\n")));
    EXPECT_NEAR(named, limit / kHighest, 1e-2 * named) << method;
    // A run with the recommended step completes.
    SceneRun stable(row_of_masses(type + to_text(0.9 * named) + "\n"), {"integrator.end_time=0.3"});
    EXPECT_TRUE(stable.run().completed) << stable.simulation().report().message;
  }
}

/// Motion that has decayed by ten decades consists of errors, which may grow at a stop by any factor.
TEST(GrowthWatch, LeavesErrorsWithinTheToleranceAlone) {
  for (const double damping : {20.0, 60.0})
    for (const double tolerance : {1e-1, 3e-2, 1e-2, 1e-3}) {
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
          "\"a\"\nstiffness = 1000.0\ndamping = " +
          to_text(damping) +
          "\n[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 1e-6\nstiffness = 2000.0\n[initial]\nvelocity = "
          "[{nodes = \"a\", value = 1.0}]\n[integrator]\ntype = \"dopri5\"\nend_time = 5.0\ntolerance = " +
          to_text(tolerance) + "\n");
      EXPECT_TRUE(run.run().completed) << damping << " " << tolerance << ": " << run.simulation().report().message;
    }
}

TEST(GrowthWatch, SeesGrowthThatIsTooSlowToOverflow) {
  // 2.83 is slightly above 2 sqrt 2: the spectral radius is 1.009.
  const std::string message =
      failure_of(row_of_masses("type = \"rk4\"\ntime_step = " + to_text(2.832 / kHighest) + "\n"));
  expect_holds(message, {"grows without a physical cause", "critical step"});
}

TEST(GrowthWatch, SeesWhatIsBeyondAnyNumberAtItsFirstLook) {
  // Ten decades in each step: the energy after the sixteenth is inf - inf.
  const double h = 1e3 / kHighest;
  SceneRun run(row_of_masses("type = \"rk4\"\ntime_step = " + to_text(h) + "\n"),
               {"integrator.end_time=" + to_text(16.0 * h)});
  EXPECT_FALSE(run.run().completed);
  expect_holds(run.simulation().report().message,
               {"grows without a physical cause", "beyond the range of numbers", "critical step"});
}

/// Gains much over 256 steps and loses little over the next 256, so that no sequence of checks shows
/// continuous growth.
class Ratchet final : public time::Integrator {
 public:
  using Integrator::Integrator;

 private:
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override {
    const double factor = std::pow(++count_ / 256 % 2 == 0 ? 5.0 : 0.9, 1.0 / 256.0);
    to.x = factor * from.x;
    to.v = factor * from.v;
    dynamics().acceleration(step.t_end, to.x, to.v, to.a);
    return {};
  }

  int count_ = 0;
};

TEST(GrowthWatch, SeesGrowthThatFallsBackNowAndThen) {
  const std::string stop =
      "[[contact]]\ntype = \"stop\"\nnodes = \"big\"\ngap = 1e3\nlaw = \"linear\"\nstiffness = 1e4\n";
  SceneRun scene(row_of_masses("type = \"discrete_gradient\"\ntime_step = 1e-3\n", stop));
  Ratchet ratchet(scene.dynamics());
  time::Simulation simulation(scene.dynamics(), ratchet, {1e-3, 100.0, {}});
  EXPECT_FALSE(simulation.run().completed);
  EXPECT_LT(simulation.report().steps, 5000);
  expect_holds(simulation.report().message, {"from t = 0 s", "grows without a physical cause"});
}

TEST(GrowthWatch, LetsLoadsDoTheirWork) {
  // Resonance without damping for a thousand periods, and a load that starts after a long rest.
  for (const std::string load :
       {"type = \"harmonic\"\namplitude = 5.0\nangular_frequency = 100.0\n",
        "type = \"table\"\ntimes = [0.0, 30.0, 30.001, 30.002]\nvalues = [0.0, 0.0, 1e6, 0.0]\n"})
    for (const std::string method : {"rk4", "central_differences"}) {
      SceneRun run(
          "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
          "\"m\"\nstiffness = 1e4\n[initial]\nvelocity = [{nodes = \"m\", value = 1e-6}]\n[[load]]\nnode = \"m\"\n" +
          load + "[integrator]\nend_time = 60.0\ntime_step = 1e-4\ntype = \"" + method + "\"\n");
      EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    }
}

TEST(GrowthWatch, WarnsOfStepsThatAreStableButTooLong) {
  SceneRun coarse(
      row_of_masses("type = \"newmark\"\ntime_step = 0.02\nresidual_tolerance = 1e-9\nincrement_tolerance "
                    "= 1e-9\nmax_iterations = 20\n"));
  ASSERT_TRUE(coarse.run().completed);
  ASSERT_EQ(coarse.simulation().report().warnings.size(), 1U);
  expect_holds(coarse.simulation().report().warnings[0],
               {"newmark", "steps of 0.02 s", "too long", "time_step of", "auto"});
  SceneRun fine(row_of_masses("type = \"newmark\"\ntime_step = 2e-5\nresidual_tolerance = 1e-9\nincrement_tolerance = "
                              "1e-9\nmax_iterations = 20\n"),
                {"integrator.end_time=0.5"});
  ASSERT_TRUE(fine.run().completed);
  EXPECT_TRUE(fine.simulation().report().warnings.empty());
}

TEST(GrowthWatch, WarnsOfImpactsShorterThanAStep) {
  const std::string stop =
      "[[contact]]\ntype = \"stop\"\nnodes = \"big\"\ngap = 1e-3\nlaw = \"linear\"\nstiffness = 1e10\n";
  SceneRun run(row_of_masses("type = \"discrete_gradient\"\ntime_step = 2e-5\n", stop), {"integrator.end_time=0.5"});
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  ASSERT_FALSE(run.simulation().report().warnings.empty());
  expect_holds(run.simulation().report().warnings.back(), {"impact", "time_step of"});
}

TEST(Diagnosis, NamesTheLoadThatOverflows) {
  const std::string load =
      "[[load]]\ntype = \"table\"\nnode = \"small\"\ntimes = [0.0, 0.1, 0.1001]\nvalues = [0.0, 0.0, 1e308]\n";
  for (const std::string method : {"rk4", "central_differences", "discrete_gradient"}) {
    const std::string message = failure_of(row_of_masses("type = \"" + method + "\"\ntime_step = 1e-4\n", load));
    expect_holds(message, {"t = 0.1", "the load on u of small", "[[load]]"});
  }
}

TEST(Diagnosis, NamesTheLoadThatOverflowsAtTheStart) {
  const std::string message = failure_of(row_of_masses(
      "type = \"rk4\"\ntime_step = 1e-4\n", "[[load]]\ntype = \"constant\"\nnode = \"small\"\nvalue = 1e307\n"));
  expect_holds(message, {"initial acceleration", "the load on u of small"});
}

TEST(Diagnosis, NamesTheDofWhereNewtonFails) {
  const std::string message = failure_of(
      row_of_masses("type = \"newmark\"\ntime_step = 1e-4\nresidual_tolerance = 1e-30\nincrement_tolerance = "
                    "1e-30\nmax_iterations = 3\n"));
  expect_holds(message, {"Newton's iteration", "3 solves", "residual is largest in u of ", "time_step of 2.5e-05 s",
                         "on_newton_failure"});
}

TEST(Diagnosis, SaysWhyAStepFellBelowItsFloor) {
  const std::string load =
      "[[load]]\ntype = \"table\"\nnode = \"small\"\ntimes = [0.0, 0.1, 0.1001]\nvalues = [0.0, 0.0, 1e308]\n";
  const std::string message = failure_of(row_of_masses("type = \"rodas4\"\n", load));
  expect_holds(message, {"floor", "t = 0.1", "u of small"});
}

/// Makes almost no progress: after a first step of half the run it requests very short steps of one length.
class Crawler final : public time::Integrator {
 public:
  Crawler(dynamics::Dynamics& dynamics, double h) : Integrator(dynamics), controller_(h) {}
  const time::StepController* controller() const override { return &controller_; }

 private:
  class Controller final : public time::StepController {
   public:
    explicit Controller(double h) : h_(h) {}
    time::StepDecision decide(double, const time::StepReport&) const override { return {true, h_}; }

   private:
    double h_;
  };

  time::StepReport do_step(const time::State& from, const time::Step&, time::State& to) override {
    to.x = from.x;
    to.v = from.v;
    to.a = from.a;
    return {};
  }

  Controller controller_;
};

TEST(Diagnosis, StopsARunThatWouldNeverEnd) {
  SceneRun scene(row_of_masses("type = \"rk4\"\ntime_step = 1e-3\n"));
  for (const auto& [h, part] :
       {std::pair{1e-15, "too little to reach the end"}, std::pair{1e-30, "below the rounding"}}) {
    Crawler crawler(scene.dynamics(), h);
    time::Simulation simulation(scene.dynamics(), crawler, {0.5, 1.0, {}});
    EXPECT_FALSE(simulation.run().completed);
    expect_holds(simulation.report().message, {"t = 0.5", part, "u of "});
  }
}

TEST(Diagnosis, NamesTheMotionThatNoMassResists) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1e300\n[[element]]\ntype = \"mass\"\nname = "
      "\"b\"\nmass = 1e-320\n[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 1e-300\n"
      "[integrator]\ntype = \"rk4\"\ntime_step = 1e-3\nend_time = 1.0\n";
  try {
    SceneRun run(scene);
    run.run();
    FAIL() << "ran";
  } catch (const InputError& error) {
    expect_holds(error.what(), {"mass matrix is not positive definite", "u of b"});
  }
}

}  // namespace
}  // namespace butee::test::growth_watch_test
