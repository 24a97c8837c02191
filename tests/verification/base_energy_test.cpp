// Energies and peaks of structures whose supports move, against closed forms and between frames.
#include <cmath>
#include <complex>
#include <numbers>
#include <sstream>

#include <butee/record/energy.hpp>
#include <butee/record/history.hpp>
#include <gtest/gtest.h>

#include "pinned_bar.hpp"
#include "support/scene_run.hpp"

namespace butee::test::base_energy_test {
namespace {

using std::numbers::pi;

std::string text(double value) {
  std::ostringstream out;
  out.precision(17);
  out << value;
  return out.str();
}

/// Peaks of motion in space, between rows and within long steps: those of the steady solution, which the start is on.
TEST(MovedBase, HasItsPeaksBetweenRows) {
  constexpr double kBase = 0.02, kFrequency = 57.0, m = 2.0, k = 800.0, c = 4.0;
  // u_abs = Re((k + i c w)/(k - m w^2 + i c w) kBase e^(i w t))
  const std::complex<double> ratio =
      std::complex<double>(k, c * kFrequency) / std::complex<double>(k - m * kFrequency * kFrequency, c * kFrequency);
  const std::complex<double> relative = (ratio - 1.0) * kBase;
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 800.0\ndamping = 4.0\n[base]\ndisplacement = { direction = [0, 1, 0], type = \"harmonic\", "
      "amplitude = 0.02, angular_frequency = 57.0 }\n[initial]\ndisplacement = [{ nodes = \"m\", dof = \"u\", value "
      "= " +
      text(relative.real()) +
      " }]\nvelocity = [{ nodes = \"m\", dof = \"u\", value = " + text(-kFrequency * relative.imag()) +
      " }]\n[integrator]\nend_time = 3.0\ntolerance = 1e-8\n";
  for (const std::string method : {"exponential", "exact", "rodas4", "dopri5"}) {
    SceneRun run(scene, {"integrator.type=" + method});
    model::OutputRequest request;
    request.interval = 3.0;
    request.probes = {{"m",
                       run.model().nodes.select("m").nodes.front(),
                       {model::Quantity::u_abs, model::Quantity::v_abs, model::Quantity::a_abs},
                       ""}};
    record::HistoryRecorder history(request, 3.0, run.dynamics(), nullptr);
    run.simulation().add(history);
    ASSERT_TRUE(run.run().completed);
    const auto peaks = history.peaks();
    const double u = kBase * std::abs(ratio);
    EXPECT_NEAR(peaks.at("m.u_abs") / u, 1.0, 1e-6) << method;
    EXPECT_NEAR(peaks.at("m.v_abs") / (kFrequency * u), 1.0, 1e-6) << method;
    EXPECT_NEAR(peaks.at("m.a_abs") / (kFrequency * kFrequency * u), 1.0, 1e-5) << method;
  }
}

struct Energies {
  double kinetic, strain, work, dissipated, balance;
};

Energies energies_of(const std::string& scene) {
  SceneRun run(scene);
  record::EnergyRecorder recorder(run.dynamics());
  run.simulation().add(recorder);
  EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
  const record::Energy end = record::energy_of(run.simulation().state(), run.dynamics());
  return {end.kinetic, end.strain, recorder.work(), recorder.dissipated(), recorder.balance_error()};
}

/// Strain and dissipation do not depend on where x is measured from.
TEST(MovedBase, HasTheEnergiesOfTheWholeStructure) {
  const std::string bar = pinned_bar(8);
  const std::string displacement =
      "displacement = { direction = [0, 1, 0], type = \"harmonic\", amplitude = 1e-3, angular_frequency = 30.0, phase "
      "= "
      "-1.5707963267948966 }\n";
  for (const std::string method : {"exact", "rodas4"}) {
    const std::string rest =
        "[damping]\nmass_proportional = 2.0\nstiffness_proportional = 1e-4\n[integrator]\ntype = \"" + method +
        "\"\nend_time = 0.13\n" + (method == "rodas4" ? "tolerance = 1e-8\n" : "");
    const std::string stop = "[[contact]]\ntype = \"stop\"\nnodes = \"bar:middle\"\ngap = 1.0\nstiffness = 1.0\n";
    const Energies relative = energies_of(bar + "[base]\n" + displacement + rest);
    const Energies in_space = energies_of(bar + "[base]\n" + displacement + stop + "frame = \"space\"\n" + rest);
    EXPECT_NEAR(in_space.strain / relative.strain, 1.0, 1e-6) << method;
    EXPECT_NEAR(in_space.dissipated / relative.dissipated, 1.0, 1e-6) << method;
    EXPECT_LT(std::abs(in_space.balance), 1e-7) << method;
    // Damping by masses acts on the motion in space if only supports move: another structure.
    const std::string stiff = rest.substr(0, 10) + rest.substr(rest.find("stiffness_prop"));
    const Energies ground = energies_of(bar + "[base]\n" + displacement + stop + "frame = \"space\"\n" + stiff);
    const Energies supports =
        energies_of(bar + "[[base]]\nnodes = [\"bar:first\", \"bar:last\"]\n" + displacement +
                    "[initial]\nvelocity = [{ nodes = \"bar:1..7\", dof = \"u\", value = 0.03 }]\n" + stiff);
    for (const auto part : {&Energies::kinetic, &Energies::strain, &Energies::work, &Energies::dissipated})
      EXPECT_NEAR(supports.*part / (ground.*part), 1.0, 1e-6) << method;
  }
}

/// A bar that moves as a rigid body with its supports has the energy M V^2/2, and no strain.
TEST(MovedSupport, AddsItsShareOfTheKineticEnergy) {
  const std::string bar = pinned_bar(8);
  const Energies moved =
      energies_of(bar +
                  "[[base]]\nnodes = [\"bar:first\", \"bar:last\"]\nacceleration = { direction = [0, 1, 0], type = "
                  "\"constant\", value = 0.0 }\ninitial_velocity = 2.0\n[initial]\nvelocity = [{ nodes = \"bar:1..7\", "
                  "dof = \"u\", value = 2.0 }]\n[integrator]\ntype = \"exact\"\nend_time = 0.2\n");
  const double mass = 7800.0 * pi * 0.005 * 0.005 * 2.0;
  EXPECT_NEAR(moved.kinetic, 0.5 * mass * 4.0, 1e-9);
  // x.K_ff x/2 alone, with x = 0.4 m at the end, is some hundred joules.
  EXPECT_NEAR(moved.strain, 0.0, 1e-9);
  EXPECT_NEAR(moved.work, 0.0, 1e-9);
}

/// A mass between two supports that move apart: the energies of its springs, in closed form.
TEST(MovedSupport, StretchesItsSprings) {
  const std::string scene = R"(
schema = 1
[[element]]
type = "mass"
name = "a"
mass = 0.5
[[element]]
type = "mass"
name = "m"
mass = 2.0
[[element]]
type = "mass"
name = "b"
mass = 0.25
[[element]]
type = "spring"
nodes = ["a", "m"]
stiffness = 300.0
damping = 1.0
[[element]]
type = "spring"
nodes = ["m", "b"]
stiffness = 500.0
damping = 2.0
[[support]]
nodes = ["a", "b"]
fix = ["u"]
[[base]]
nodes = "a"
displacement = { direction = [0, 1, 0], type = "harmonic", amplitude = 0.02, angular_frequency = 11.0 }
[[base]]
nodes = "b"
displacement = { direction = [0, 1, 0], type = "harmonic", amplitude = -0.03, angular_frequency = 7.0 }
[integrator]
type = "exact"
end_time = 0.7
)";
  SceneRun run(scene);
  record::EnergyRecorder recorder(run.dynamics());
  run.simulation().add(recorder);
  ASSERT_TRUE(run.run().completed);
  const time::State& state = run.simulation().state();
  const record::Energy end = record::energy_of(state, run.dynamics());
  const double x = state.x[0], v = state.v[0], a = 0.02 * std::cos(11.0 * 0.7), b = -0.03 * std::cos(7.0 * 0.7),
               va = -0.22 * std::sin(11.0 * 0.7), vb = 0.21 * std::sin(7.0 * 0.7);
  EXPECT_NEAR(end.strain, 150.0 * (x - a) * (x - a) + 250.0 * (x - b) * (x - b), 1e-12);
  EXPECT_NEAR(end.kinetic, v * v + 0.25 * va * va + 0.125 * vb * vb, 1e-12);
  EXPECT_LT(std::abs(recorder.balance_error()), 1e-10);
}

}  // namespace
}  // namespace butee::test::base_energy_test
