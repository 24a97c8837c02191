#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <tuple>

#include <butee/record/energy.hpp>
#include <gtest/gtest.h>

#include "rotors.hpp"
#include "support/scene_run.hpp"

namespace butee::test::run_up_test {
namespace {

using namespace rotors;

/// The run-up of a Jeffcott rotor: r'' + 2 z w0 r' + w0^2 r = e (W^2 - i W') exp(i phi), phi = a t^2/2, from rest.
class RunUp : public testing::TestWithParam<const char*> {
 protected:
  /// |r| at `times` (s), m; the speed increases by `rate` turns per second in each second.
  static std::vector<double> radius(double rate, const std::vector<double>& times) {
    constexpr double kW0 = 20.0 * pi;
    std::ostringstream scene;
    scene.precision(17);
    scene << "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"rotor\"\nmass = 1.0\n"
          << "[[element]]\ntype = \"bearing\"\nnode = \"rotor\"\nstiffness = [[" << kW0 * kW0 << ", 0], [0, "
          << kW0 * kW0 << "]]\ndamping = [[" << 0.04 * kW0 << ", 0], [0, " << 0.04 * kW0 << "]]\n"
          << "[rotation]\nspeed = { type = \"ramp\", to = " << 20.0 * pi * rate << ", end = 10.0 }\n"
          << "[[load]]\ntype = \"unbalance\"\nnode = \"rotor\"\nmoment = 1e-4\n"
          << "[integrator]\ntype = \"" << GetParam() << "\"\nend_time = " << times.back()
          << "\n[integrator.rodas4]\ntolerance = 1e-8\n"
          << "[integrator.dopri5]\ntolerance = 1e-8\n[integrator.extrapolation8]\ntolerance = 1e-8\n"
          << "[integrator.auto]\ntolerance = 1e-8\n";
    SceneRun run(scene.str());
    Sampler y(run.dof("rotor", DofKind::uy), times), z(run.dof("rotor", DofKind::uz), times);
    run.simulation().add(y);
    run.simulation().add(z);
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    std::vector<double> all;
    for (std::size_t i = 0; i < times.size(); ++i) all.push_back(std::hypot(y.x.at(i), z.x.at(i)));
    return all;
  }
  /// Times around a peak, so dense that the maximum of a parabola exceeds the largest sample by a relative
  /// 1e-9.
  static std::vector<double> around(double peak) {
    std::vector<double> times;
    for (int i = -40; i <= 40; ++i) times.push_back(peak + 5e-5 * i);
    return times;
  }
};

constexpr double kPeak = 12.1674717e-4, kPeakOfFast = 7.5681051e-4;  // m
/// Relative to the peak; the references have ten printed digits, the peaks nine.
constexpr double kRunUp = 1e-7;

/// Reference by the Faddeeva function.
TEST_P(RunUp, PassesTheResonance) {
  const auto slow = radius(5.0, {1.0, 2.0, 2.2, 2.5, 3.0});
  const double of_slow[] = {3.3051780460e-5, 5.7474092598e-4, 1.0184387964e-3, 8.1198775103e-4, 5.4410342818e-4};
  for (std::size_t i = 0; i < slow.size(); ++i) EXPECT_NEAR(slow[i], of_slow[i], kRunUp * kPeak) << i;
  const auto fast = radius(20.0, {0.3, 0.5, 0.55, 0.6, 0.8});
  const double of_fast[] = {4.8772949e-5, 2.8545728822e-4, 4.1874272312e-4, 5.7889674149e-4, 3.2109752459e-4};
  for (std::size_t i = 0; i < fast.size(); ++i) EXPECT_NEAR(fast[i], of_fast[i], kRunUp * kPeakOfFast) << i;
}

TEST_P(RunUp, HasItsPeakAfterTheResonance) {
  for (const auto& [rate, peak, t] : {std::tuple(5.0, kPeak, 2.3427577), {20.0, kPeakOfFast, 0.6841809}}) {
    const auto times = around(t), found = radius(rate, times);
    const auto top = std::max_element(found.begin(), found.end());
    EXPECT_NEAR(*top, peak, kRunUp * peak) << rate;
    EXPECT_NEAR(times[static_cast<std::size_t>(top - found.begin())], t, 2.0 * 5e-5) << rate;
  }
}

INSTANTIATE_TEST_SUITE_P(methods, RunUp, testing::Values("rodas4", "dopri5", "extrapolation8", "exact", "auto"));

std::string gyroscopic_run_up() {
  return steel("rayleigh", 6, 1.0, 0.02, "young_modulus = 2.1e11\ndensity = 7800.0") + disc(":4", 10.0, 0.2, 0.39) +
         "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"u\", \"w\"]\n"
         "[damping]\nmass_proportional = 1.0\nstiffness_proportional = 1e-5\nrotating_stiffness_proportional = 2e-5\n"
         "[rotation]\nspeed = { type = \"ramp\", from = 50.0, to = 500.0, end = 0.05 }\n"
         "[[load]]\ntype = \"unbalance\"\nnode = \"shaft:2\"\nmoment = 1e-2\nphase = 0.3\n"
         "[integrator]\nend_time = 0.08\n";
}

/// The stiffness of a bearing stands still, so that only its own damping turns with the shaft, and the energy balance
/// holds in a run-up.
TEST(RunUp, StiffnessProportionalDampingLeavesBearingsOut) {
  const std::string scene =
      steel("rayleigh", 6, 1.0, 0.02, "young_modulus = 2.1e11\ndensity = 7800.0") +
      "[[element]]\ntype = \"bearing\"\nnode = \"shaft:first\"\nstiffness = [[2e6, 3e5], [-1e5, 1.5e6]]\n"
      "damping = [[50.0, 0.0], [0.0, 50.0]]\nrotating = true\n"
      "[[element]]\ntype = \"bearing\"\nnode = \"shaft:last\"\nstiffness = [[2e6, 0.0], [0.0, 2e6]]\n"
      "[damping]\nrotating_stiffness_proportional = 1e-5\n"
      "[rotation]\nspeed = { type = \"ramp\", from = 50.0, to = 300.0, end = 0.05 }\n"
      "[[load]]\ntype = \"unbalance\"\nnode = \"shaft:2\"\nmoment = 1e-2\n"
      "[integrator]\nend_time = 0.08\ntolerance = 1e-9\n";
  SceneRun run(scene, {"integrator.type=dopri5"});
  const SparseMatrix& damping = run.system().dashpots;
  const model::DofTable& dofs = run.system().dofs;
  const auto of = [&](model::NodeId node, DofKind kind) { return dofs.index({node, kind}); };
  const Index y = of(0, DofKind::uy), z = of(0, DofKind::uz);
  SceneRun without(scene,
                   {"integrator.type=dopri5", "element[1].rotating=false", "element[1].damping=[[0.0,0.0],[0.0,0.0]]"});
  const SparseMatrix& shaft = without.system().dashpots;
  EXPECT_NEAR(damping.coeff(y, y) - shaft.coeff(y, y), 50.0, 1e-9);
  EXPECT_NEAR(damping.coeff(z, z) - shaft.coeff(z, z), 50.0, 1e-9);
  EXPECT_NEAR(shaft.coeff(y, y), shaft.coeff(z, z), 1e-9);
  EXPECT_EQ(damping.coeff(y, z), 0.0);
  EXPECT_EQ(damping.coeff(z, y), 0.0);
  record::EnergyRecorder energy(run.dynamics(), nullptr, std::nullopt);
  run.simulation().add(energy);
  ASSERT_TRUE(run.run().completed);
  EXPECT_LT(std::abs(energy.balance_error()), 1e-8);
}

/// The equations of motion hold at the end of a long implicit step, for any speed at which the matrices were
/// factorized before.
/// The surface of a disc that runs up drags it along a plane: u'' + k u + c (u' - r Omega' t) = 0.
TEST(RunUp, DragsABodyByItsSurface) {
  constexpr double k = 1e4, c = 5.0, rate = 0.5, kEnd = 0.5;
  const double b = c * rate / k, a = -c * b / k, decay = 0.5 * c, w = std::sqrt(k - decay * decay);
  const double u =
      a + b * kEnd + std::exp(-decay * kEnd) * (-a * std::cos(w * kEnd) + (-decay * a - b) / w * std::sin(w * kEnd));
  for (const std::string method : {"exact", "rodas4", "dopri5", "extrapolation8"}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"r\"\nmass = 1.0\n[[element]]\ntype = \"bearing\"\nnode = "
        "\"r\"\nstiffness = [[1e4, 0.0], [0.0, 1e4]]\n[[contact]]\ntype = \"plane\"\nnodes = \"r\"\nnormal = [0.0, "
        "1.0]\ngap = 0.0\nlaw = \"linear\"\nstiffness = 1e4\nradius = 0.01\nfriction = { coefficient = 0.5, "
        "slip_speed = 1.0, smoothing = \"clip\" }\n[rotation]\nspeed = { type = \"ramp\", to = 50.0, end = 1.0 "
        "}\n[[load]]\nnode = \"r\"\ndof = \"uz\"\ntype = \"constant\"\nvalue = 20.0\n[initial]\ndisplacement = [{ "
        "nodes "
        "= \"r\", dof = \"uz\", value = 1e-3 }]\n[integrator]\nend_time = 0.5\n",
        {"integrator.type=" + method});
    ASSERT_TRUE(run.run().completed);
    EXPECT_NEAR(run.simulation().state().x[run.dof("r", DofKind::uy)] / u, 1.0, method == "exact" ? 1e-9 : 1e-4)
        << method;
  }
}

/// A rotor that stands still until its run-up begins moves as one whose run-up begins at once: the unbalance begins
/// with a jump, m e Omega'.
TEST(RunUp, MayBeginAfterARest) {
  const auto end = [](const std::string& method, double start) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"r\"\nmass = 2.0\n[[element]]\ntype = \"bearing\"\nnode = "
        "\"r\"\nstiffness = [[2e4, 0.0], [0.0, 2e4]]\ndamping = [[8.0, 0.0], [0.0, 8.0]]\n[rotation]\nspeed = { type = "
        "\"ramp\", to = 150.0, start = " +
            std::to_string(start) + ", end = " + std::to_string(start + 1.0) +
            " }\n[[load]]\ntype = \"unbalance\"\nnode = \"r\"\nmoment = 2e-3\n[integrator]\ntolerance = "
            "1e-6\nend_time = " +
            std::to_string(start + 0.9) + "\n",
        {"integrator.type=" + method});
    EXPECT_TRUE(run.run().completed) << method << run.simulation().report().message;
    return std::hypot(run.simulation().state().x[run.dof("r", DofKind::uy)],
                      run.simulation().state().x[run.dof("r", DofKind::uz)]);
  };
  const double truth = end("rodas4", 0.0);
  for (const std::string method : {"rodas4", "dopri5", "extrapolation8", "bathe_adaptive", "auto"})
    EXPECT_NEAR(end(method, 0.125) / truth, 1.0, 1e-4) << method;
}

TEST(RunUp, EffectiveEquationsAreThoseOfTheirInstant) {
  SceneRun run(gyroscopic_run_up(), {"integrator.type=rodas4"});
  dynamics::Dynamics& dynamics = run.dynamics();
  const Index n = dynamics.size();
  constexpr double kOnV = 0.02, kOnX = 1e-4;
  const Vector x = Vector::LinSpaced(n, -1e-3, 2e-3), v = Vector::LinSpaced(n, 0.3, -0.2), none(0);
  Vector a(n), force(n), inertia(n);
  for (const double t : {0.01, 0.03, 0.06}) {
    ASSERT_TRUE(dynamics.solve_secant(t, kOnV, kOnX, none, none, x, v, a));
    dynamics.total_force(t, x + kOnX * a, v + kOnV * a, force);
    dynamics.inertia_force(a, inertia);
    // Rounding of cancelling forces.
    EXPECT_LT((force - inertia).norm(), 1e-9 * (inertia.norm() + run.system().stiffness.norm() * x.norm()));
  }
}

/// With gyroscopic moments a run-up adds Omega' G to K, and rotating damping adds Omega W: methods of
/// different families agree, and the energy balance holds with the work of the drive.
TEST(RunUp, OfAGyroscopicShaftAgreesBetweenMethods) {
  const std::string scene = gyroscopic_run_up();
  std::vector<std::vector<double>> ends;
  for (const char* method : {"rodas4", "dopri5", "extrapolation8"}) {
    SceneRun run(scene, {std::string("integrator.type=") + method, "integrator.tolerance=1e-8"});
    record::EnergyRecorder energy(run.dynamics());
    run.simulation().add(energy);
    ASSERT_TRUE(run.run().completed) << method;
    EXPECT_LT(std::abs(energy.balance_error()), 1e-6) << method;
    const Vector& x = run.simulation().state().x;
    ends.emplace_back(x.begin(), x.end());
  }
  EXPECT_LT(relative_rms(ends[1], ends[0]), 1e-6);
  EXPECT_LT(relative_rms(ends[2], ends[0]), 1e-6);
  SceneRun exact(scene, {"integrator.type=exact"});
  ASSERT_TRUE(exact.run().completed);
  const Vector& found = exact.simulation().state().x;
  EXPECT_LT(relative_rms({found.begin(), found.end()}, ends[2]), 1e-7);
  // Newton's iteration would converge correctly even with a factorization for another speed; the linear step
  // of newmark_modified would not.
  for (const char* method : {"newmark", "newmark_modified"}) {
    SceneRun run(scene, {std::string("integrator.type=") + method, "integrator.time_step=1e-5"});
    ASSERT_GT(run.system().size(), linalg::LinearSolver::kTiny);
    ASSERT_TRUE(run.run().completed) << method;
    const Vector& x = run.simulation().state().x;
    EXPECT_LT(relative_rms({x.begin(), x.end()}, ends[0]), 1e-3) << method;
  }
}

}  // namespace
}  // namespace butee::test::run_up_test
