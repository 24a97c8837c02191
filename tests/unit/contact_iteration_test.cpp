#include "integrators/exponential/contact_iteration.hpp"

#include <butee/dynamics/dynamics.hpp>
#include <gtest/gtest.h>

#include "integrators/exponential/propagation.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::contact_iteration_test {
namespace {

using namespace integrators;

/// Two masses with a spring between them, each with a stop to ground, and a stop between them.
const std::string kScene = masses_in_stops(R"(
[[contact]]
type = "stop"
between = ["a", "b"]
gap = 0.02
stiffness = 90.0
)");
constexpr double kStep = 0.05;

/// The end, velocity and middle of the paths from the propagator with the forces of all stops, and the forces
/// from projection along these paths; the iteration must have found the same values.
TEST(ContactIteration, FindsForcesAndPathsThatBelongTogether) {
  SceneRun run(kScene);
  dynamics::ModalSystem& modal = run.dynamics().modal(0);
  dynamics::ElasticStops& contact = run.dynamics().stops();
  const StepGoal goal = {1e-9, 1e-9, 1e-9, 1.0};
  std::vector<ContactForce> contacts;
  for (Index i = 0; i < contact.size(); ++i) contacts.emplace_back(contact, i);
  const ContactGaps gaps(contact);
  ContactScales scales(modal, contact);
  scales.load(std::vector<double>(static_cast<std::size_t>(scales.memory_size()), 0.1).data(), {0.1, 1.0});
  TriedStep step;
  for (ModalState* state : {&step.from, &step.to, &step.middle}) state->resize(modal);
  Vector x(2), v(2);
  x << 0.09, 0.105;
  v << 1.0, -0.4;
  modal.to_modal(x, step.from.q.matrix());
  modal.to_modal(v, step.from.v.matrix());
  step.from.find_stops(modal.stop_shapes());
  step.h = step.t_end = kStep;
  dynamics::ContactPropagator& flow = modal.odd(kStep);
  const PropagationStart start = {0.0, step.from.q, step.from.v, {}, nullptr};
  propagate(modal, flow.whole, start, kStep, step.to.q, &step.to.v);
  propagate(modal, flow.half, start, 0.5 * kStep, step.middle.q, &step.middle.v);
  step.to.find_stops(modal.stop_shapes());
  step.iterated = {0, 1, 2};
  step.breakpoint = 0.5 * kStep;  // so that the middle also receives the forces
  ContactIteration iteration(modal, goal, contacts, gaps, scales, step);
  ASSERT_TRUE(iteration.solve(flow).has_value());
  EXPECT_EQ(iteration.touched().size(), 3u);
  iteration.apply(flow, step);
  step.middle.find_stops(modal.stop_shapes());
  Eigen::ArrayXd w(step.to.w.size()), wv(w);
  modal.stop_shapes().displacement(step.to.q.data(), step.to.v.data(), w.data(), wv.data());
  for (Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(step.to.w[i], w[i], 1e-15);
    EXPECT_NEAR(step.to.wv[i], wv[i], 1e-13);
    const ContactPath path = iteration.paths().of(i);
    EXPECT_NEAR(path.value(1.0), w[i], 1e-14);
    EXPECT_NEAR(path.value(0.5), step.middle.w[i], 1e-14);
    ContactForce& force = contacts[static_cast<std::size_t>(i)];
    const ForceMoments projected = force.project(path, force.status(path)).force;
    // The iteration finds the paths to 1e-10 m, and the forces to the stiffness times that.
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(iteration.moments(k)[i], projected[k], 1e-7) << i << " " << k;
  }
}

}  // namespace
}  // namespace butee::test::contact_iteration_test
