// The energy that dashpots take, where it is lost within a small part of a step or beside rigid motion.
#include <array>
#include <cmath>
#include <optional>

#include <butee/record/energy.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::dissipated_energy_test {
namespace {

/// The dissipated energy of a run with rows every `interval` s, J, and its balance error.
std::pair<double, double> dissipated(const std::string& scene, const std::string& method, double interval) {
  SceneRun run(scene + "[integrator]\nend_time = 1.0\ntype = \"" + method + "\"\n");
  record::EnergyRecorder energy(run.dynamics(), nullptr, record::OutputTimes(interval, 0, 1.0));
  run.simulation().add(energy);
  EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
  return {energy.dissipated(), energy.balance_error()};
}

/// An overdamped mass loses its kinetic energy in some microseconds: m v^2/2, but for the part e that the spring keeps,
/// e = k x^2/2 with x = m v/c.
TEST(Dissipated, EnergyOfAFastDecayIsSeenInLongSteps) {
  for (const double c : {8e2, 8e4, 8e6}) {
    const std::string scene =
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
        "\"m\"\nstiffness = 800.0\ndamping = " +
        std::to_string(c) + "\n[initial]\nvelocity = [{ nodes = \"m\", value = 0.3 }]\n";
    constexpr double kGiven = 0.09;
    const double x = 2.0 * 0.3 / c, kept = 400.0 * x * x * std::exp(-2.0 * 800.0 / c);
    for (const std::string method : {"exponential", "auto", "exact"})
      for (const double interval : {0.05, 0.5}) {
        if (method == "exact" && c > 1e5) continue;  // its series follow the decay in 1e6 steps
        const auto [energy, error] = dissipated(scene, method, interval);
        // `kept` neglects the mass beside the dashpot.
        EXPECT_NEAR(energy, kGiven - kept, 1e-7 + (c < 1e3 ? 1e-3 * kGiven : 0.0)) << method << " " << c;
        EXPECT_NEAR(error, 0.0, 1e-7) << method << " " << c << " " << interval;
      }
  }
}

/// Two masses on a spring, one of them on a dashpot to ground, move on rigidly.
TEST(Dissipated, EnergyBesideRigidMotionDoesNotDependOnTheRows) {
  for (const double k : {1e4, 1e6, 1e7}) {
    const std::string scene =
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
        "\"b\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = " +
        std::to_string(k) +
        "\n[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 0.0\ndamping = 1.0\n[initial]\nvelocity = [{ "
        "nodes = \"a\", value = 1.0 }]\n";
    const double truth = dissipated(scene, "exact", 0.5).first;
    for (const double interval : {0.5, 0.01}) {
      const auto [energy, error] = dissipated(scene, "exponential", interval);
      EXPECT_NEAR(energy / truth, 1.0, 1e-6) << k << " " << interval;
      EXPECT_NEAR(error, 0.0, 1e-6) << k << " " << interval;
    }
  }
}

/// Collects the rows of energies.
class Rows final : public model::FieldWriter {
 public:
  void append(double /*t*/, std::span<const double> /*values*/) override {}
  void append_row(std::span<const double> values) override { all.emplace_back(values.begin(), values.end()); }
  void finish() override {}

  std::vector<std::vector<double>> all;
};

/// x = cos(2 t) has strain energy 2 cos^2(2 t), whatever the length of the steps.
TEST(Energies, AreThoseAtTheOutputsWithinLongSteps) {
  for (const std::string method : {"exponential", "exact", "piecewise", "extrapolation8"}) {
    SceneRun run(mass_on_spring("4.0", "[initial]\ndisplacement = [{ nodes = \"m\", value = 1.0 }]\n"),
                 {"integrator.type=" + method, "integrator.end_time=3.0"});
    Rows rows;
    record::EnergyRecorder energy(run.dynamics(), nullptr, record::OutputTimes(0.01, 0, 3.0));
    energy.also_to(rows);
    run.simulation().add(energy);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_LT(run.simulation().report().steps, 200) << method << ": steps are not longer than outputs";
    ASSERT_EQ(rows.all.size(), 301U) << method;
    for (std::size_t i = 0; i < rows.all.size(); ++i) {
      const double t = 0.01 * static_cast<double>(i), cosine = std::cos(2.0 * t);
      EXPECT_NEAR(rows.all[i][0], t, 1e-12) << method;
      EXPECT_NEAR(rows.all[i][2], 2.0 * cosine * cosine, 1e-3) << method << " at " << t;
    }
  }
}

/// A row within rounding of a kink of a load makes a step of one unit in the last place, over which no quadrature can
/// be refined.
TEST(Energies, PassARowBesideAKinkOfALoad) {
  SceneRun run(mass_on_spring("4.0",
                              "damping = 0.1\n[[load]]\ntype = \"table\"\nnode = \"m\"\ntimes = [0.0, 0.35, "
                              "1.0]\nvalues = [0.0, 1.0, -1.0]\n"),
               {"integrator.type=exponential", "integrator.end_time=1.0"});
  Sampler row(0, {std::nextafter(0.35, 1.0)});
  record::EnergyRecorder energy(run.dynamics());
  run.simulation().add(row);
  run.simulation().add(energy);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  EXPECT_NEAR(energy.balance_error(), 0.0, 1e-9);
}

/// Long steps of a method of high order: the energies between rows far apart are as accurate as the motion.
TEST(Dissipated, EnergyOfLongSmoothStepsDoesNotDependOnTheRows) {
  const std::string scene =
      mass_on_spring("579.0",
                     "[[element]]\ntype = \"spring\"\nnode = \"m\"\nstiffness = 0.0\ndamping = 18.6\n[[load]]\nnode = "
                     "\"m\"\ntype = \"table\"\ntimes = [0.0, 0.03, 0.06, 0.2, 0.22]\nvalues = [0.0, 30.0, 0.0, 0.0, "
                     "-30.0]\n[output]\ninterval = 0.3\n");
  const auto followed = [&](const std::string& method) {
    SceneRun run(scene, {"integrator.type=" + method, "integrator.tolerance=1e-9", "integrator.end_time=0.6"});
    record::EnergyRecorder energy(run.dynamics(), nullptr, std::nullopt);
    run.simulation().add(energy);
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    return std::array{energy.work(), energy.dissipated(), energy.balance_error()};
  };
  const auto expected = followed("exact");
  EXPECT_NEAR(expected[2], 0.0, 1e-12);
  for (const std::string method : {"extrapolation8", "dopri5", "rodas4"}) {
    const auto found = followed(method);
    EXPECT_NEAR(found[0], expected[0], 1e-7 * expected[0]) << method;
    EXPECT_NEAR(found[1], expected[1], 1e-7 * expected[1]) << method;
    EXPECT_NEAR(found[2], 0.0, 1e-7) << method;
  }
}

/// Newmark's velocity of an unresolved mode changes its sign at every step; the energies between steps are then wrong.
TEST(Dissipated, EnergyOutOfBalanceIsSaid) {
  const TemporaryFolder folder;
  folder.write(
      "s.toml",
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = "
      "\"mass\"\nname = \"n\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = \"n\"\nstiffness = "
      "1.0\n[[element]]\ntype = \"spring\"\nnode = \"m\"\nstiffness = 1e8\ndamping = 1000.0\n[initial]\nvelocity "
      "= [{ nodes = \"m\", value = 1.0 }, { nodes = \"n\", value = 1.0 }]\n[integrator]\ntype = "
      "\"newmark\"\ntime_step = 5e-3\nend_time = 2.0\n[output]\nenergy = true\n");
  const Outcome wrong = run_program({"run", "s.toml", "-o", "wrong"}, folder.path());
  EXPECT_EQ(wrong.status, 0) << wrong.errors;
  EXPECT_NE(wrong.errors.find("the energy balance is wrong by"), std::string::npos) << wrong.errors;
  const Outcome right =
      run_program({"run", "s.toml", "-o", "right", "--set", "integrator.time_step=1e-5"}, folder.path());
  EXPECT_EQ(right.status, 0) << right.errors;
  EXPECT_EQ(right.errors.find("energy balance"), std::string::npos) << right.errors;
}

}  // namespace
}  // namespace butee::test::dissipated_energy_test
