// Forces of contacts at supports and at nodes with several contacts, against the balance of forces.
#include <cmath>

#include <butee/model/element_choice.hpp>
#include <butee/record/history.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::contact_probes_test {
namespace {

using model::Quantity;

/// A mass that is pressed against a fixed one by its start.
std::string between(const std::string& contact) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 2.0\n[[element]]\ntype = \"mass\"\nname = "
         "\"g\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"g\"]\nstiffness = "
         "800.0\n[[support]]\nnodes = \"g\"\nfix = [\"u\"]\n[[contact]]\n" +
         contact +
         "\nbetween = [\"a\", \"g\"]\ngap = 0.01\nstiffness = 1e5\nlaw = \"linear\"\n[initial]\nvelocity = [{ nodes = "
         "\"a\", value = 1.0 }]\n[integrator]\nend_time = 0.015\n";
}

class AtASupport : public testing::TestWithParam<std::pair<const char*, const char*>> {};

/// The support of g takes what the spring and the contact exert: m times the acceleration of a, but for damping on a.
TEST_P(AtASupport, ContactsAreInItsReactionAndItsProbes) {
  for (const std::string method : {"exact", "rodas4"}) {
    SceneRun run(between(GetParam().second), {"integrator.type=" + method});
    const auto node = [&](const char* name) { return run.model().nodes.select(name).nodes.front(); };
    record::Probes probes({{"a", node("a"), {Quantity::a, Quantity::spring_force, Quantity::contact_force}, ""},
                           {"g", node("g"), {Quantity::reaction, Quantity::contact_force}, ""}},
                          run.dynamics());
    ASSERT_TRUE(run.run().completed);
    std::vector<double> now(probes.columns().size());
    probes.evaluate(run.simulation().state(), now);
    const double a = now[0], spring = now[1], contact = now[2];
    ASSERT_LT(contact, -300.0);  // N: the contact is closed
    EXPECT_NEAR(2.0 * a, spring + contact, 1e-9 * std::abs(contact)) << method;
    EXPECT_NEAR(now[4], -contact, 1e-9 * std::abs(contact)) << method;
    EXPECT_NEAR(now[3], spring + contact, 1e-9 * std::abs(contact)) << method;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Contacts, AtASupport,
    testing::Values(
        std::pair("elastic", "type = \"stop\""),
        std::pair("kelvin_voigt", "type = \"stop\"\ndamping = { type = \"kelvin_voigt\", coefficient = 40.0 }"),
        std::pair("hunt_crossley", "type = \"stop\"\ndamping = { type = \"hunt_crossley\", factor = 0.3 }")),
    [](const auto& one) { return one.param.first; });

/// A stop along uz and a plane at one node, whose forces on uz oppose one another: the peak is that of their sum.
TEST(SumOfContacts, HasThePeakOfTheSum) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"r\"\nmass = 1.0\n[[element]]\ntype = \"bearing\"\nnode = "
      "\"r\"\nstiffness = [[1e4, 0.0], [0.0, 1e4]]\ndamping = [[60.0, 0.0], [0.0, 60.0]]\n[[contact]]\ntype = "
      "\"stop\"\nnodes = \"r\"\ndof = \"uz\"\nsides = \"positive\"\ngap = 0.0\nstiffness = 1e4\nlaw = "
      "\"linear\"\n[[contact]]\ntype = \"plane\"\nnodes = \"r\"\nnormal = [0.8, -0.6]\ngap = 0.0\nstiffness = "
      "1e4\nlaw = \"linear\"\n[[load]]\ntype = \"constant\"\nnode = \"r\"\ndof = \"uy\"\nvalue = 30.0\n[[load]]\ntype "
      "= \"constant\"\nnode = \"r\"\ndof = \"uz\"\nvalue = 10.0\n[integrator]\ntype = \"rodas4\"\ntolerance = "
      "1e-8\nend_time = 0.2\n";
  SceneRun run(scene);
  model::OutputRequest request;
  request.interval = 1e-4;
  request.probes = {{"r", run.model().nodes.select("r").nodes.front(), {Quantity::contact_uz}, ""}};
  record::HistoryRecorder history(request, 0.2, run.dynamics(), nullptr);
  record::Probes probes(request.probes, run.dynamics());
  run.simulation().add(history);
  run.simulation().start();
  double largest = 0.0;
  std::vector<double> now(1);
  while (run.simulation().advance()) {
    probes.evaluate(run.simulation().state(), now);
    largest = std::max(largest, std::abs(now[0]));
  }
  const double peak = history.peaks().at("r.contact_uz");
  EXPECT_GE(peak, largest * (1.0 - 1e-12));
  EXPECT_NEAR(peak, largest, 0.02 * largest);  // steps end beside the peak
  // At rest the stop presses with 1e4 z and the plane with 1e4 (0.8 y - 0.6 z).
  const time::State& state = run.simulation().state();
  probes.evaluate(state, now);
  const double y = state.x[run.dof("r", DofKind::uy)], z = state.x[run.dof("r", DofKind::uz)];
  EXPECT_NEAR(now[0], -1e4 * z + 0.6 * 1e4 * (0.8 * y - 0.6 * z), 1e-9);
}

TEST(ContactForce, OfStopsOnARotationIsAMoment) {
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"r\"\nmass = 1.0\nrotary_inertia = 0.01\n[[element]]\ntype = "
      "\"spring\"\nnode = \"r\"\ndof = \"theta\"\nstiffness = 100.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"r\"\nstiffness = 1e4\n[[contact]]\ntype = \"stop\"\nnodes = \"r\"\ndof = \"theta\"\ngap = 0.01\nstiffness = "
      "100.0\nlaw = \"linear\"\n[integrator]\nend_time = 0.1\n");
  const model::NodeId node = run.model().nodes.select("r").nodes.front();
  EXPECT_STREQ(model::unit_at(run.model(), node, Quantity::contact_force), "N m");
  EXPECT_STREQ(model::unit_at(run.model(), node, Quantity::u), "m");
}

}  // namespace
}  // namespace butee::test::contact_probes_test
