// A pipe that rotates in rings along its length: methods of different families agree in bending and torsion.
#include <cmath>
#include <memory>

#include <butee/record/energy.hpp>
#include <butee/record/history.hpp>
#include <butee/time/contact_events.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::whirling_pipe_test {
namespace {

/// A rotating pipe that rubs on rings along its length. Methods of three families agree, more closely with
/// smaller tolerances, and the energy balance holds.
TEST(WhirlingPipe, IsTheSameForMethodsOfDifferentFamilies) {
  const std::string toml = TurningPipe{"string", "lateral", "35.0", 10, "0.01", "0.01", "3.0"}.scene(R"(
[damping]
mass_proportional = 0.03
[integrator]
type = "exact"
end_time = 0.3
)");
  SceneRun exact(toml);
  ASSERT_TRUE(exact.run().completed) << exact.simulation().report().message;
  const Vector& wanted = exact.simulation().state().x;
  for (const char* method : {"rodas4", "dopri5", "extrapolation8"}) {
    SceneRun run(toml, {std::string("integrator.type=") + method, "integrator.tolerance=1e-5"});
    record::EnergyRecorder energy(run.dynamics());
    run.simulation().add(energy);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_LT((run.simulation().state().x - wanted).norm(), 1e-6 * wanted.norm()) << method;
    EXPECT_NEAR(energy.balance_error(), 0.0, 1e-6) << method;
  }
  // rk4 evaluates contacts at its stages only, and loses accuracy if they change within a step.
  SceneRun fixed(toml, {"integrator.type=rk4", "integrator.time_step=5e-5"});
  ASSERT_TRUE(fixed.run().completed) << fixed.simulation().report().message;
  EXPECT_LT((fixed.simulation().state().x - wanted).norm(), 1e-3 * wanted.norm());
}

/// A pipe that is symmetric about its middle: pairs of rings close and open within 1e-9 s of each other.
const std::string kSymmetricPipe = TurningPipe{"string", "lateral", "35.0", 34, "0.01", "0.01", "3.0"}.scene(R"(
[damping]
mass_proportional = 0.03
[integrator]
type = "exponential"
end_time = 0.3
)");

/// Changes of two contacts almost at the same instant are located once each, whatever the tolerance.
TEST(WhirlingPipe, TakesNotMoreStepsAtALooserTolerance) {
  // Steps and their repetitions; the change of a contact costs about two.
  const auto tried_steps = [](const char* tolerance) {
    SceneRun run(kSymmetricPipe, {std::string("integrator.tolerance=") + tolerance});
    const time::RunReport& report = run.run();
    EXPECT_TRUE(report.completed) << report.message;
    return report.steps + report.rejected;
  };
  const auto loose = tried_steps("1e-2"), middle = tried_steps("1e-3"), tight = tried_steps("1e-4");
  EXPECT_LT(loose, middle);
  EXPECT_LT(middle, tight);
  EXPECT_LT(tight, 1000);
}

/// One ring opens, and the ring on the other side of the middle closes 1e-10 s later. The first is still closed by the
/// precision of its instant (1e-12 m) at the start of the short step between both, and leaves.
TEST(WhirlingPipe, TakesNoTinyStepsBetweenChangesOfTwoRings) {
  const std::string toml = TurningPipe{"string", "lateral", "35.0", 10, "0.01", "0.01", "3.0"}.scene(R"(
[damping]
mass_proportional = 0.03
[integrator]
type = "exponential"
tolerance = 1e-3
end_time = 16.0
)");
  SceneRun run(toml, {"rotation.speed=10.0", "contact[0].friction.coefficient=0.0"});
  const time::RunReport& report = run.run();
  ASSERT_TRUE(report.completed) << report.message;
  EXPECT_LT(report.steps + report.rejected, 10000);
}

/// The phases of the contacts with which steps begin.
class Phases final : public time::Observer {
 public:
  Index differences = 0, changes = 0;

  void step(const time::AcceptedStep& step) override {
    constexpr Index kEntries = time::ContactEvents::kEntries;
    const Vector& contact = step.from.contact;
    const Index count = contact.size() / kEntries;
    Vector now(count);
    for (Index i = 0; i < count; ++i) now[i] = contact[kEntries * i];
    if (last_.size() == count && now != last_) ++changes;
    if (now != now.reverse()) ++differences;
    last_ = now;
  }

 private:
  Vector last_;
};

/// Contacts whose changes follow within the precision of their location change together.
TEST(WhirlingPipe, ChangesSymmetricContactsTogether) {
  SceneRun run(kSymmetricPipe, {"integrator.tolerance=1e-3"});
  Phases phases;
  run.simulation().add(phases);
  ASSERT_TRUE(run.run().completed);
  EXPECT_GT(phases.changes, 20);
  EXPECT_EQ(phases.differences, 0);
}

/// The number of breakpoints of all steps, by time::Detail.
class BreakpointCounter final : public time::Observer {
 public:
  std::size_t displacements = 0, velocities = 0, accelerations = 0;

  void step(const time::AcceptedStep& step) override {
    displacements += step.motion.breakpoints(time::Detail::displacements).size();
    velocities += step.motion.breakpoints(time::Detail::velocities).size();
    accelerations += step.motion.breakpoints(time::Detail::accelerations).size();
  }
};

/// Fast modes turn the nodes, but hardly move them.
TEST(WhirlingPipe, HasPeaksOfDisplacementsAtLittleCost) {
  SceneRun run(kSymmetricPipe, {"integrator.tolerance=1e-2"}),
      other(kSymmetricPipe, {"integrator.type=dopri5", "integrator.tolerance=1e-5"});
  BreakpointCounter counter;
  run.simulation().add(counter);
  const auto peaks_of = [](SceneRun& scene) {
    model::OutputRequest request;
    request.interval = 0.1;
    for (const char* name : {"string:5", "string:middle"})
      request.probes.push_back({name, scene.model().nodes.select(name).nodes.front(), {model::Quantity::u}, ""});
    return std::make_unique<record::HistoryRecorder>(request, 0.3, scene.dynamics(), nullptr);
  };
  const auto got = peaks_of(run), wanted = peaks_of(other);
  run.simulation().add(*got);
  other.simulation().add(*wanted);
  ASSERT_TRUE(run.run().completed);
  ASSERT_TRUE(other.run().completed);
  EXPECT_LT(counter.displacements, counter.velocities);
  EXPECT_LE(counter.velocities, counter.accelerations);
  for (const auto& [column, peak] : wanted->peaks()) EXPECT_NEAR(got->peaks().at(column), peak, 1e-2 * peak) << column;
}

/// The power of all forces is evaluated at ten instants of a step, unless faster modes have much energy.
TEST(WhirlingPipe, HasAnEnergyBalanceAtLittleCost) {
  SceneRun plain(kSymmetricPipe, {"integrator.tolerance=1e-3"}), run(kSymmetricPipe, {"integrator.tolerance=1e-3"}),
      other(kSymmetricPipe, {"integrator.type=dopri5", "integrator.tolerance=1e-5"});
  record::EnergyRecorder energy(run.dynamics()), reference(other.dynamics());
  run.simulation().add(energy);
  other.simulation().add(reference);
  ASSERT_TRUE(plain.run().completed);
  ASSERT_TRUE(run.run().completed);
  ASSERT_TRUE(other.run().completed);
  EXPECT_NEAR(energy.work(), reference.work(), 1e-5 * reference.work());
  EXPECT_NEAR(energy.dissipated(), reference.dissipated(), 1e-5 * reference.work());
  EXPECT_NEAR(energy.balance_error(), 0.0, 1e-6);
  const auto evaluations = run.dynamics().counters().contact_evaluations,
             without = plain.dynamics().counters().contact_evaluations;
  EXPECT_LT(evaluations - without, 40 * run.simulation().report().steps);
}

/// A string in space driven at its upper end: friction on its rings causes torsion. Series, Rosenbrock's
/// method, an explicit method and collocation of damped modes agree in the torsion.
TEST(WhirlingPipe, IsTwistedByFriction) {
  const std::string toml = TurningPipe{"string", "spatial", "35.0", 4, "0.01", "0.01", "3.0"}.scene(R"(
[[support]]
nodes = "string:first"
fix = ["ux", "rx"]
[damping]
mass_proportional = 0.5
stiffness_proportional = 1.0e-4
[integrator]
type = "exact"
end_time = 0.3
)");
  SceneRun exact(toml);
  ASSERT_TRUE(exact.run().completed) << exact.simulation().report().message;
  const Vector& wanted = exact.simulation().state().x;
  const Index end = exact.dof("string:last", DofKind::rx);
  EXPECT_GT(std::abs(wanted[end]), 1e-4);
  for (const char* method : {"rodas4", "dopri5", "exponential"}) {
    SceneRun run(toml, {std::string("integrator.type=") + method, "integrator.tolerance=1e-6"});
    record::EnergyRecorder energy(run.dynamics());
    run.simulation().add(energy);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_NEAR(run.simulation().state().x[end], wanted[end], 1e-6 * std::abs(wanted[end])) << method;
    EXPECT_LT((run.simulation().state().x - wanted).norm(), 1e-6 * wanted.norm()) << method;
    EXPECT_NEAR(energy.balance_error(), 0.0, 1e-7) << method;
  }
}

}  // namespace
}  // namespace butee::test::whirling_pipe_test
