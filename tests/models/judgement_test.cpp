// What --trust compares: every displacement and rotation that a probe asks for, and contacts of all kinds.
#include <string>

#include <gtest/gtest.h>

#include "apps/butee/trust.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::judgement_test {
namespace {

record::Histories two_histories(double large, double small) {
  return {{0.0, 1.0}, {{large, large}, {small, small}}, {record::Histories::displacement, record::Histories::rotation}};
}

/// Every displacement and rotation is compared with its own peak, but at least a thousandth of the largest of its kind.
TEST(Judgement, IsRelativeToThePeakOfEachProbe) {
  record::TrustRuns runs;
  runs.run = two_histories(1.0, 1e-5);
  runs.tightened = two_histories(1.0, 1.1e-5);
  EXPECT_NEAR(record::judge(runs, 0.01).end_bound, 10.0 * 0.1, 1e-9);
  runs.run.kinds = runs.tightened.kinds = {record::Histories::displacement, record::Histories::displacement};
  EXPECT_NEAR(record::judge(runs, 0.01).end_bound, 10.0 * 1e-3, 1e-9);
}

/// Intervals show what they exclude: the printed margin covers the rounding of both numbers.
TEST(Judgement, IsPrintedWithTheDigitsThatItHas) {
  record::Trust trust;
  trust.statistics = {{"peak of u", 0.00114485123456, 0.00114485120312, 0.00114485126600},
                      {"rms of v", 1.25, 1.0, 1.5},
                      {"force", 1e-9, 0.0, 3e-9},
                      {"impacts", 23.0, 23.0, 23.0, true},
                      {"closings", 23.0, 22.0, 25.0, true}};
  const std::string text = record::describe(trust);
  for (const char* line :
       {"peak of u = 0.001144851235 +- 3.5e-11\n", "rms of v = 1.25 +- 0.28\n", "force = 1e-09, between 0 and 3e-09\n",
        "impacts = 23 in all runs\n", "closings = 23, between 22 and 25 in all runs\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

/// A chaotic rotation beside a displacement at rest, and an impact with dissipation: both are seen, by all numbers.
TEST(Judgement, SeesRotationsAndDissipativeStops) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\nrotary_inertia = 0.01\n[[element]]\ntype = "
      "\"spring\"\n"
      "node = \"a\"\ndof = \"theta\"\nstiffness = 100.0\ndamping = 0.005\n[[element]]\ntype = \"spring\"\nnode = "
      "\"a\"\n"
      "stiffness = 100.0\n[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ndof = \"theta\"\ngap = 1e-3\nstiffness = "
      "1e5\n[[load]]\n"
      "type = \"harmonic\"\nnode = \"a\"\ndof = \"theta\"\namplitude = 0.6\nangular_frequency = "
      "130.0\n[integrator]\ntype = "
      "\"rodas4\"\ntolerance = 1e-4\nend_time = 1.0\n[output]\ninterval = 1e-3\n[[output.probe]]\nlabel = \"a\"\nnode "
      "= \"a\"\n"
      "quantities = [\"theta\"]\n";
  scene::Scene chaotic = read_scene(scene);
  const record::Trust trust = app::find_trust(chaotic);
  EXPECT_FALSE(trust.to_the_end);
  EXPECT_LT(trust.horizon, 0.5);
  ASSERT_FALSE(trust.statistics.empty());
  EXPECT_EQ(trust.statistics.front().name, "rms of a.theta");
  EXPECT_GT(trust.statistics.front().value, 1e-4);

  scene::Scene dissipative = read_scene(
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"a\"\n"
      "stiffness = 1e4\n[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 1e-3\nstiffness = 1e5\ndamping = { type = "
      "\"kelvin_voigt\", coefficient = 50.0 }\n[initial]\nvelocity = [{ nodes = \"a\", value = 1.0 "
      "}]\n[integrator]\nend_time = "
      "0.01\n[[output.probe]]\nlabel = \"a\"\nnode = \"a\"\nquantities = [\"u\"]\n");
  bool has_force = false, has_impacts = false;
  for (const record::Trust::Statistic& s : app::find_trust(dissipative).statistics) {
    if (s.name == "largest contact force") has_force = s.value > 100.0;
    if (s.name == "impacts") has_impacts = s.value == 1.0;
  }
  EXPECT_TRUE(has_force);
  EXPECT_TRUE(has_impacts);
}

/// A run that misses a short pulse, and with it all motion, is not accurate, and says what it missed.
TEST(Judgement, DoesNotCallARunAccurateThatMissedTheMotion) {
  const TemporaryFolder folder;
  folder.write("pulse.toml",
               "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = "
               "\"spring\"\nnode = \"m\"\nstiffness = 800.0\n[[load]]\ntype = \"table\"\nnode = \"m\"\ntimes = "
               "[0.10005, 0.1001, 0.10015]\nvalues = [0.0, 2e4, 0.0]\n[integrator]\ntype = \"newmark\"\ntime_step = "
               "1e-3\nend_time = 0.5\n[[output.probe]]\nlabel = \"m\"\nnode = \"m\"\nquantities = [\"u\"]\n");
  const Outcome outcome = run_program({"run", "pulse.toml", "--trust"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output.find("demanded (trust_accuracy)"), std::string::npos) << outcome.output;
  EXPECT_NE((outcome.output + outcome.errors).find("the load on u of m changes within 5e-05 s, and steps of 0.001 s"),
            std::string::npos)
      << outcome.errors << outcome.output;
}

}  // namespace
}  // namespace butee::test::judgement_test
