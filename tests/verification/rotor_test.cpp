#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <sstream>

#include <Eigen/LU>
#include <butee/core/text.hpp>
#include <butee/dynamics/frequencies.hpp>
#include <butee/dynamics/static_position.hpp>
#include <butee/dynamics/whirl.hpp>
#include <butee/linalg/linear_solver.hpp>
#include <butee/record/energy.hpp>
#include <butee/record/probes.hpp>
#include <gtest/gtest.h>

#include "rotors.hpp"
#include "support/scene_run.hpp"

namespace butee::test::rotor_test {
namespace {

using namespace rotors;

using std::numbers::pi;

/// M. I. Friswell, J. E. T. Penny, S. D. Garvey, A. W. Lees, Dynamics of Rotating Machines, 2010, examples
/// 5.9.1 to 5.9.9. Digits beyond the printed ones come from an independent program with the same elements.
class Friswell : public testing::Test {
 protected:
  static std::string scene(const std::string& theory, const std::string& rest) {
    return steel(theory, 6, 1.5, 0.025, "young_modulus = 211e9\ndensity = 7810.0\nshear_modulus = 81.2e9") + rest +
           turning(1.0);
  }
  static std::string two_discs(double kzz, double c = 0.0) {
    return disc("@0.5", 32.58972765, 0.1780892826, 0.3295636209) +
           disc("@1.0", 51.52526111, 0.4235805841, 0.8050822049) + bearing(":first", 1e6, kzz, c, c) +
           bearing(":last", 1e6, kzz, c, c);
  }
  static std::vector<double> at(const std::string& toml, double rpm, Index count) {
    SceneRun run(toml);
    return frequencies(dynamics::Whirl(run.model()).modes(rpm * kRpm, count));
  }
};

TEST_F(Friswell, IsotropicBearings) {
  const std::string timoshenko = scene("timoshenko", two_discs(1e6)), euler = scene("euler", two_discs(1e6));
  expect_all(at(timoshenko, 0, 6), {86.658114, 86.658114, 274.312854, 274.312854, 716.786312, 716.786312}, 1, kPrinted);
  // With the wrong sign of the shaft's gyroscopic matrix relative to the discs' the error would be 3e-4.
  expect_all(at(timoshenko, 4000, 6), {85.389467, 87.795864, 251.784604, 294.713331, 600.179362, 827.075362}, 1,
             kPrinted);
  expect_all(at(euler, 4000, 6), {85.460304, 87.840900, 252.215047, 295.237007, 601.248663, 827.702816}, 1, kPrinted);
}

TEST_F(Friswell, OrthotropicAndDampedBearings) {
  expect_all(at(scene("timoshenko", two_discs(8e5)), 4000, 5),
             {82.325474, 86.863699, 239.642284, 287.249581, 583.487829}, 1, kPrinted);
  expect_all(at(scene("timoshenko", two_discs(2e5)), 4000, 6),
             {8.545405, 13.770864, 22.354504, 44.064246, 78.754834, 120.380032}, 2 * pi, 1e-7);
  SceneRun damped(scene("timoshenko", two_discs(1e6, 3e3)));
  const auto modes = dynamics::Whirl(damped.model()).modes(4000 * kRpm, 5);
  expect_all(frequencies(modes), {13.681884, 14.071637, 41.982902, 50.648679, 104.248404}, 2 * pi, 5e-8);
  const double ratios[] = {.047443, .053554, .270447, .240387, .523632};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(modes[i].damping_ratio(), ratios[i], 6e-7);
}

TEST_F(Friswell, OverhungDisc) {
  const std::string rest =
      disc("@1.5", 51.52526111, 0.4235805841, 0.8050822049) + bearing("@0.0", 1e7, 1e7) + bearing("@1.0", 1e7, 1e7);
  expect_all(at(scene("timoshenko", rest), 4000, 6),
             {76.190065, 103.908548, 565.990745, 634.234109, 647.748553, 1174.197399}, 1, kPrinted);
  expect_all(at(scene("euler", rest), 0, 5), {90.250349, 90.250349, 632.456179, 632.456179, 832.184374}, 1, kPrinted);
}

TEST_F(Friswell, CriticalSpeeds) {
  SceneRun run(scene("timoshenko", two_discs(1e6)));
  const auto found = dynamics::Whirl(run.model()).critical_speeds(0.0, 350.0, 10, 1.0, 10);
  std::vector<double> speeds;
  for (const auto& critical : found) speeds.push_back(critical.speed);
  ASSERT_EQ(speeds.size(), 4U);
  expect_all(speeds, {825.133813, 829.874457, 2487.758843, 2756.087555}, kRpm, 1e-9);
  EXPECT_NEAR(found[0].direction, -1.0, 1e-6);
  EXPECT_NEAR(found[1].direction, 1.0, 1e-6);
}

/// Damping makes most modes overdamped. The two equal modes of a disc in the middle of its shaft, which does
/// not tilt, each have one critical speed, w sqrt(1 - zeta^2); no other mode has one.
TEST(OverdampedShaft, HasTwoCriticalSpeeds) {
  SceneRun run(R"(
schema = 1
[material.steel]
young_modulus = 2.1e11
density = 7850.0
[section.shaft]
shape = "circle"
radius = 0.015
[[element]]
type = "beam"
motion = "lateral"
name = "shaft"
material = "steel"
section = "shaft"
length = 1.0
elements = 8
[[element]]
type = "disc"
node = "shaft:middle"
mass = 12.0
diametral_inertia = 0.03
polar_inertia = 0.06
[[support]]
nodes = ["shaft:first", "shaft:last"]
fix = ["uy", "uz"]
[rotation]
speed = 100.0
[damping]
stiffness_proportional = 2.0e-4
[integrator]
type = "rodas4"
end_time = 1.0
)");
  const dynamics::Whirl whirl(run.model());
  const auto found = whirl.critical_speeds(0.0, 400.0, 40, 1.0, 10);
  ASSERT_EQ(found.size(), 2U);
  const double size = std::abs(whirl.modes(0.0, 1)[0].lambda), zeta = 0.5 * 2.0e-4 * size;
  for (const auto& critical : found)
    EXPECT_NEAR(critical.speed, size * std::sqrt((1.0 - zeta) * (1.0 + zeta)), 1e-8 * size);
}

/// M. Lalanne, G. Ferraris, Rotordynamics Prediction in Engineering, 1998: the rotor with three discs,
/// code_aster's SDLL124. Digits from an independent program with the same elements.
TEST(LalanneFerraris, ModesAtSpeed) {
  const std::string scene =
      steel("timoshenko", 13, 1.3, 0.05, "young_modulus = 2e11\ndensity = 7800.0\npoisson_ratio = 0.3") +
      disc("@0.2", 14.58013, .06463858, .1232021) + disc("@0.5", 45.94579, .4977461, .9763481) +
      disc("@1.0", 55.13495, .6023493, 1.171618) + bearing(":first", 5e7, 7e7, 500, 700) +
      bearing(":last", 5e7, 7e7, 500, 700) + turning(1.0);
  SceneRun run(scene);
  const dynamics::Whirl whirl(run.model());
  expect_all(frequencies(whirl.modes(25000 * kRpm, 7)),
             {55.410836, 67.196515, 157.897579, 193.639057, 249.850980, 407.462948, 446.713071}, 2 * pi, 2e-8);
  expect_all(frequencies(whirl.modes(30000 * kRpm, 4)), {54.083145, 68.094495, 154.311300, 195.740073}, 2 * pi, 2e-8);
}

/// A rotating pinned shaft with rotary inertia: (rho A + rho I b^2) w^2 -+ 2 rho I b^2 W w - E I b^4 = 0, b =
/// n pi/L.
TEST(PinnedShaft, ConvergesWithOrder4ToTheRayleighBeam) {
  constexpr double kSpeed = 30000 * kRpm, kLength = 1.0, kRadius = 0.05, kE = 2.1e11, kRho = 7800.0;
  constexpr double kArea = pi * kRadius * kRadius, kMoment = kArea * kRadius * kRadius / 4, b = pi / kLength;
  constexpr double m = kRho * kArea + kRho * kMoment * b * b, g = kRho * kMoment * b * b * kSpeed;
  const double forward = (g + std::sqrt(g * g + m * kE * kMoment * b * b * b * b)) / m;
  double errors[2];
  for (int i = 0; i < 2; ++i) {
    SceneRun run(steel("rayleigh", 10 * (i + 1), kLength, kRadius, "young_modulus = 2.1e11\ndensity = 7800.0") +
                 "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"uy\", \"uz\"]\n" + turning(1.0));
    const auto modes = dynamics::Whirl(run.model()).modes(kSpeed, 2);
    EXPECT_NEAR(modes[1].direction, 1.0, 1e-9);
    EXPECT_NEAR(modes[0].direction, -1.0, 1e-9);
    errors[i] = modes[1].frequency() / forward - 1.0;
  }
  EXPECT_LT(errors[0], 1e-5);
  EXPECT_NEAR(std::log2(errors[0] / errors[1]), 4.0, 0.1);
}

/// Above Whirl::kDense DOFs Arnoldi's method finds the same modes, also beside a body that nothing holds.
TEST(PinnedShaft, HasTheSameModesByArnoldi) {
  for (const char* beside : {"", "[[element]]\ntype = \"mass\"\nname = \"free\"\nmass = 1.0\n"}) {
    SceneRun run(steel("rayleigh", 120, 1.0, 0.05, "young_modulus = 2.1e11\ndensity = 7800.0") + beside +
                 "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"uy\", \"uz\"]\n" + turning(1.0));
    const dynamics::Whirl whirl(run.model());
    ASSERT_FALSE(whirl.is_dense());
    auto modes = whirl.modes(30000 * kRpm, *beside == '\0' ? 6 : 8);
    std::erase_if(modes, [](const auto& mode) { return mode.frequency() < 1e-3; });
    // Sums over 120 elements in double precision; the exact frequencies have 10 printed digits.
    expect_all(frequencies(modes), {200.0937730, 206.2244586, 793.2233760, 817.3032401, 1758.8707928, 1811.4673400},
               2 * pi, 1e-7);
  }
}

/// On isotropic supports a forward and a backward mode pass the speed of rotation together.
TEST(PinnedShaft, IsMetByBothSensesOfWhirlAtOneCriticalSpeed) {
  SceneRun run(steel("euler", 8, 0.6, 0.01, "young_modulus = 2.1e11\ndensity = 7.85") +
               disc(":middle", 5.0, 0.01, 0.02) +
               "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"uy\", \"uz\"]\n[damping]\n"
               "mass_proportional = 5.0\nrotating_stiffness_proportional = 1e-4\n" +
               turning(1.0));
  for (const Index steps : {9, 30}) {
    const auto critical = dynamics::Whirl(run.model()).critical_speeds(0.0, 300.0, steps, 1.0, 10);
    ASSERT_EQ(critical.size(), 2U) << steps;
    EXPECT_NEAR(critical[0].direction + critical[1].direction, 0.0, 1e-6) << steps;
    EXPECT_NEAR(std::abs(critical[0].direction), 1.0, 1e-6) << steps;
    // 48 E I/(m l^3) of a massless shaft.
    EXPECT_NEAR(critical[0].speed, std::sqrt(48.0 * 2.1e11 * pi * 1e-8 / 4.0 / (5.0 * 0.216)), 1e-3 * 270.0);
  }
}

/// A shaft with external damping c_m and internal damping c_i grows above w + c_m/(c_i w), for any mesh. The damping of
/// a fine one is 1e10 times as fast as the growth beside that speed, and its fast modes turn with the shaft at rates
/// near the speed.
TEST(PinnedShaft, LosesStabilityAtTheSameSpeedInFineMeshes) {
  constexpr double kLength = 1.0, kRadius = 0.01, kOuter = 1.0, kInner = 1e-5;
  const double w = pi * pi / (kLength * kLength) * std::sqrt(2.0e11 * kRadius * kRadius / 4.0 / 7800.0),
               border = w + kOuter / (kInner * w);
  for (const int elements : {10, 24, 30}) {
    SceneRun run(steel("euler", elements, kLength, kRadius, "young_modulus = 2.0e11\ndensity = 7800.0") +
                 "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"uy\", \"uz\"]\n[damping]\n"
                 "mass_proportional = 1.0\nrotating_stiffness_proportional = 1e-5\n" +
                 turning(1.0));
    const dynamics::Whirl whirl(run.model());
    for (const double end : {660.0, 800.0}) {
      const auto borders = whirl.stability_borders({whirl.modes_at(600.0, 4), whirl.modes_at(end, 4)}, 4);
      ASSERT_EQ(borders.size(), 1U) << elements;
      EXPECT_TRUE(borders[0].begins);
      EXPECT_NEAR(borders[0].mode.direction, 1.0, 1e-6);
      EXPECT_NEAR(borders[0].speed, border, 2e-5 * border) << elements;
    }
    const auto critical = whirl.critical_speeds(0.0, 800.0, 4, 1.0, 4);
    ASSERT_EQ(critical.size(), 2U) << elements;
    for (const auto& at : critical) EXPECT_NEAR(at.speed, w, 2e-5 * w) << elements;
  }
}

/// The frequencies of a shaft do not depend on a short element, or on hardly any mass between bodies: the highest ones
/// are 1e7 times the lowest.
TEST(PinnedShaft, KeepsItsSlowModesBesideVeryFastOnes) {
  const auto scene = [](const std::string& coordinates, const std::string& middle, const std::string& density) {
    std::string text = steel("euler", 4, 1.0, 0.01, "young_modulus = 2.0e11\ndensity = " + density);
    const std::string even = "length   = 1.000000\nelements = 4\n";
    text.replace(text.find(even), even.size(), "coordinates = " + coordinates + "\n");
    return text + disc(middle, 5.0, 0.01, 0.02) +
           "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"uy\", \"uz\"]\n[damping]\n"
           "mass_proportional = 1.0\nrotating_stiffness_proportional = 4e-4\n" +
           turning(1.0);
  };
  const auto lowest = [&](const std::string& coordinates, const std::string& middle, const std::string& density) {
    SceneRun run(scene(coordinates, middle, density));
    const dynamics::Whirl whirl(run.model());
    auto speeds = frequencies(whirl.modes(80.0, 4));
    for (const auto& at : whirl.critical_speeds(0.0, 400.0, 8, 1.0, 8)) speeds.push_back(at.speed);
    for (const auto& border : whirl.stability_borders({whirl.modes_at(50.0, 8), whirl.modes_at(200.0, 8)}, 8))
      speeds.push_back(border.speed);
    return speeds;
  };
  const std::vector<double> even = lowest("[0.0, 0.25, 0.5, 0.75, 1.0]", ":2", "7800.0");
  ASSERT_EQ(even.size(), 7U);  // two critical speeds and the border behind the modes
  for (const char* first : {"0.002", "0.0005"})
    expect_all(lowest("[0.0, " + std::string(first) + ", 0.25, 0.5, 0.75, 1.0]", ":3", "7800.0"), even, 1.0, 1e-3);
  const std::vector<double> light = lowest("[0.0, 0.25, 0.5, 0.75, 1.0]", ":2", "1e-6");
  ASSERT_EQ(light.size(), 7U);
  // 48 E I/(m l^3)
  EXPECT_NEAR(light[4], std::sqrt(48.0 * 2.0e11 * pi * 1e-8 / 4.0 / 5.0), 2e-4 * 123.0);
}

/// A shaft of length l held at its first node also crosses the speed of rotation in torsion, at pi/2 sqrt(G/rho)/l, and
/// along its axis, at pi/2 sqrt(E/rho)/l.
TEST(PinnedShaft, NamesCriticalSpeedsOfTorsionAndAxialMotion) {
  std::string shaft = steel("rayleigh", 16, 2.0, 0.02, "young_modulus = 2e11\ndensity = 7800.0\nshear_modulus = 8e10");
  shaft.replace(shaft.find("lateral"), 7, "spatial");
  SceneRun run(shaft + "[[support]]\nnodes = \"shaft:first\"\nfix = [\"ux\", \"uy\", \"uz\", \"rx\"]\n" +
               "[[support]]\nnodes = \"shaft:last\"\nfix = [\"uy\", \"uz\"]\n" + turning(1.0));
  const auto critical = dynamics::Whirl(run.model()).critical_speeds(0.0, 5000.0, 20, 1.0, 20);
  std::vector<double> torsional, axial;
  for (const dynamics::CriticalSpeed& one : critical)
    if (one.motion != dynamics::ModeMotion::lateral)
      (one.motion == dynamics::ModeMotion::torsional ? torsional : axial).push_back(one.speed);
  ASSERT_EQ(torsional.size(), 1U);
  ASSERT_EQ(axial.size(), 1U);
  EXPECT_NEAR(torsional[0], 0.25 * pi * std::sqrt(8e10 / 7800.0), 1e-3 * torsional[0]);
  EXPECT_NEAR(axial[0], 0.25 * pi * std::sqrt(2e11 / 7800.0), 1e-3 * axial[0]);
  EXPECT_GT(critical.size(), 8U);
}

/// Masses on bearings of their own, each stable up to w (1 + c_e/c_i) with c_e outside and c_i turning: all borders are
/// found, whatever the number of lowest modes that are asked for, and where damping is light too.
TEST(StabilityBorders, AreThoseOfAllModes) {
  constexpr double kOutside = 0.02, kTurning = 0.02, kMass = 2.0;
  std::vector<double> truth;
  std::string scene = "schema = 1\n";
  for (int i = 0; i < 6; ++i) {
    const double w = 100.0 + 30.0 * i;
    truth.push_back(w * (1.0 + kOutside / kTurning));
    const std::string name = "m" + std::to_string(i), k = to_text(kMass * w * w);
    const auto bearing_of = [&](const std::string& stiffness, double c, const char* more) {
      scene += "[[element]]\ntype = \"bearing\"\nnode = \"" + name + "\"\nstiffness = [[" + stiffness + ", 0], [0, " +
               stiffness + "]]\ndamping = [[" + to_text(c) + ", 0], [0, " + to_text(c) + "]]\n" + more;
    };
    scene += "[[element]]\ntype = \"mass\"\nname = \"" + name + "\"\nmass = " + to_text(kMass) + "\n";
    bearing_of(k, kOutside, "");
    bearing_of("0", kTurning, "rotating = true\n");
  }
  SceneRun run(scene + "[rotation]\nspeed = 10.0\n[integrator]\ntype = \"rodas4\"\nend_time = 1.0\n");
  const dynamics::Whirl whirl(run.model());
  std::vector<dynamics::ModesAtSpeed> grid;
  for (const double speed : {0.0, 250.0, 700.0}) grid.push_back(whirl.modes_at(speed, 2));
  const auto borders = whirl.stability_borders(grid, 2);
  ASSERT_EQ(borders.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(borders[i].speed, truth[i], 1e-8 * truth[i]);
    EXPECT_NEAR(borders[i].mode.frequency(), 100.0 + 30.0 * static_cast<double>(i), 1e-4);
    EXPECT_TRUE(borders[i].begins);
  }
}

/// Without gyroscopic moments and cross terms both planes have the same frequencies: their modes have no sense, nor
/// have those by Arnoldi's method. The lowest ones that reach the highest speed are examined.
TEST(StabilityBorders, NameNoSenseOfEqualModes) {
  SceneRun run(steel("euler", 105, 4.0, 0.02, "young_modulus = 2e11\ndensity = 7800.0\npoisson_ratio = 0.3") +
               "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"uy\", \"uz\"]\n" + turning(1.0));
  const dynamics::Whirl whirl(run.model());
  ASSERT_FALSE(whirl.is_dense());
  const Index count = whirl.count_to(3000.0, 0.0, 3000.0, 10);
  const auto modes = whirl.modes(100.0, count);
  ASSERT_GE(modes.size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(modes[i].direction, 0.0) << i;
    // (k pi/l)^2 sqrt(E I/(rho A))
    const double k = static_cast<double>(i / 2 + 1) * pi / 4.0;
    EXPECT_NEAR(modes[i].frequency(), k * k * std::sqrt(2e11 / 7800.0) * 0.01, 1e-5 * modes[i].frequency()) << i;
  }
  EXPECT_EQ(whirl.critical_speeds(0.0, 3000.0, 30, 1.0, count).size(), 18U);
}

/// Where a run-up ends, the tangential force of an unbalance jumps. The acceleration in that row satisfies the equation
/// of motion after the jump, with every method, as reactions and section forces do.
TEST(RunUp, HasTheAccelerationsAfterItInTheRowOfItsEnd) {
  class Row final : public time::Observer {
   public:
    Row(SceneRun& run, double t)
        : probes_({{"d",
                    run.model().nodes.select("d").nodes.front(),
                    {model::Quantity::uy, model::Quantity::uy_v, model::Quantity::uy_a},
                    ""}},
                  run.dynamics()),
          t_(t) {}
    void step(const time::AcceptedStep& step) override {
      if (step.from.t < t_ && t_ <= step.to.t) probes_.evaluate(step, t_, values);
    }
    std::array<double, 3> values{};

   private:
    record::Probes probes_;
    double t_;
  };
  for (const char* method : {"exponential", "rodas4", "dopri5", "exact", "rk4"}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"d\"\nmass = 2.0\ndiametral_inertia = 0.01\npolar_inertia = "
        "0.02\n[[element]]\ntype = \"bearing\"\nnode = \"d\"\nstiffness = [[2e4, 0], [0, 2e4]]\ndamping = [[20.0, 0], "
        "[0, 20.0]]\n[[load]]\ntype = \"unbalance\"\nnode = \"d\"\nmoment = 1e-3\n[rotation]\nspeed = { type = "
        "\"ramp\", from = 100.0, to = 500.0, end = 0.05 }\n[integrator]\ntime_step = 1e-4\nend_time = 0.06\n",
        {std::string("integrator.type=") + method});
    Row row(run, 0.05);
    run.simulation().add(row);
    ASSERT_TRUE(run.run().completed) << method;
    // It has turned by 15 rad.
    const auto [x, v, a] = row.values;
    EXPECT_NEAR(2.0 * a, 1e-3 * 500.0 * 500.0 * std::cos(15.0) - 2e4 * x - 20.0 * v, 1e-9 * 250.0) << method;
  }
}

/// A bearing with a negative stiffness: u = (cosh 10 t - cos 5 t)/125 under cos 5 t. Every method follows it, its
/// energy is balanced, and its modes are those of e^(10 t) and e^(-10 t).
TEST(NegativeStiffness, GrowsAsItsModes) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"bearing\"\nnode = "
      "\"m\"\nstiffness = [[-100.0, 0.0], [0.0, 400.0]]\n[[load]]\ntype = \"harmonic\"\nnode = \"m\"\ndof = \"uy\"\n"
      "amplitude = 1.0\nangular_frequency = 5.0\n[integrator]\nend_time = 3.0\n";
  const double wanted = (std::cosh(30.0) - std::cos(15.0)) / 125.0;
  for (const std::string& method : {std::string("exponential"), std::string("extrapolation8"), std::string("dopri5"),
                                    std::string("rodas4"), std::string("exact")}) {
    SceneRun run(scene, {"integrator.type=" + method,
                         method == "exact" ? "integrator.time_step=0.01" : "integrator.tolerance=1e-6"});
    record::EnergyRecorder energy(run.dynamics());
    run.simulation().add(energy);
    const time::RunReport& report = run.run();
    ASSERT_TRUE(report.completed) << method << ": " << report.message;
    EXPECT_NEAR(run.simulation().state().x[run.dof("m")], wanted, 1e-5 * wanted) << method;
    EXPECT_LT(std::abs(energy.balance_error()), 1e-5) << method;
  }
  SceneRun run(scene, {"integrator.type=exact"});
  const auto modes = dynamics::Whirl(run.model()).modes(0.0, 4);
  ASSERT_EQ(modes.size(), 3U);
  EXPECT_NEAR(std::max(modes[0].lambda.real(), modes[1].lambda.real()), 10.0, 1e-12);
  EXPECT_NEAR(std::min(modes[0].lambda.real(), modes[1].lambda.real()), -10.0, 1e-12);
  EXPECT_NEAR(modes[2].frequency(), 20.0, 1e-12);
}

/// An overhung disc on a massless cantilever: (K11 - m w^2)(K22 - I_d w^2 + I_p W w) = K12^2; one element is
/// exact.
TEST(OverhungDisc, OneElementIsExact) {
  SceneRun run(steel("euler", 1, 0.5, 0.01, "young_modulus = 2e11\ndensity = 1e-9") + disc(":last", 10, 0.05, 0.1) +
               "[[support]]\nnodes = \"shaft:first\"\nfix = [\"uy\", \"uz\", \"ry\", \"rz\"]\n" + turning(1.0));
  const dynamics::Whirl whirl(run.model());
  expect_all(frequencies(whirl.modes(100.0, 4)), {55.6056042, 64.4184727, 427.5202515, 618.7073830}, 1, 2e-9);
  expect_all(frequencies(whirl.modes(600.0, 4)), {36.2601702, 82.4925200, 229.0641891, 1382.8318392}, 1, 2e-9);
}

/// A mass on springs with nonrotating damping c_e and rotating damping c_i: unstable above W = w0 (1 +
/// c_e/c_i).
TEST(InternalDamping, IsUnstableFromItsThresholdOn) {
  constexpr const char* kScene = R"(
schema = 1
[[element]]
type = "disc"
name = "rotor"
mass = 1.0
[[element]]
type      = "bearing"
node      = "rotor"
stiffness = [[1e4, 0], [0, 1e4]]
damping   = [[4.0, 0], [0, 4.0]]
[[element]]
type      = "bearing"
node      = "rotor"
stiffness = [[0, 0], [0, 0]]
damping   = [[6.0, 0], [0, 6.0]]
rotating  = true
[rotation]
speed = 170.0
[initial]
velocity = [{ nodes = "rotor", dof = "uy", value = 0.1 }]
[integrator]
type     = "exact"
end_time = 1.0
)";
  SceneRun run(kScene);
  const dynamics::Whirl whirl(run.model());
  const double threshold = 100.0 * (1.0 + 4.0 / 6.0);
  const auto growth = [&](double speed) {
    double largest = -1e300;
    for (const auto& mode : whirl.modes(speed, 4)) largest = std::max(largest, mode.lambda.real());
    return largest;
  };
  EXPECT_LT(std::abs(growth(threshold)), 1e-12 * 100.0);
  EXPECT_GT(growth(1.001 * threshold), 0.0);
  EXPECT_LT(growth(0.999 * threshold), 0.0);
  const auto borders = whirl.stability_borders({whirl.modes_at(0.0, 4), whirl.modes_at(400.0, 4)}, 4);
  ASSERT_EQ(borders.size(), 1U);
  EXPECT_NEAR(borders[0].speed, threshold, 1e-7 * threshold);
  EXPECT_TRUE(borders[0].begins);
  EXPECT_GT(borders[0].mode.direction, 0.9);
  // The drive supplies energy: the balance includes its work.
  record::EnergyRecorder energy(run.dynamics());
  run.simulation().add(energy);
  EXPECT_TRUE(run.run().completed);
  EXPECT_GT(energy.work(), 1e-4);
  EXPECT_LT(std::abs(energy.balance_error()), 1e-9);
}

/// Modal damping of a rotating shaft is that of its modes at rest. Free motion is a sum of the damped modes
/// found by Whirl; a least-squares fit of the initial state gives their amplitudes.
TEST(ModalDamping, OfATurningShaftIsThatOfTheModesAtRest) {
  const std::string shaft = steel("rayleigh", 4, 1.0, 0.02, "young_modulus = 2.1e11\ndensity = 7800.0") +
                            disc(":1", 10.0, 0.2, 0.39) +
                            "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"u\", \"w\"]\n"
                            "[initial]\nvelocity = [{ nodes = \"shaft:1\", dof = \"uy\", value = 0.1 }]\n"
                            "[integrator]\ntype = \"exact\"\nend_time = 0.05\n";
  const std::string damping = "[damping]\nmodal = 0.02\n";
  SceneRun run(shaft + damping + "[rotation]\nspeed = 300.0\n");
  const dynamics::Whirl whirl(run.model());
  // At rest every mode has the specified ratio.
  for (const auto& mode : whirl.modes(0.0, 8)) EXPECT_NEAR(mode.damping_ratio(), 0.02, 1e-9);
  const Index n = run.system().size();
  const auto modes = whirl.modes(300.0, n);
  ASSERT_EQ(std::ssize(modes), n);
  Eigen::MatrixXcd start(2 * n, 2 * n);
  Eigen::VectorXcd growth(2 * n);
  for (Index i = 0; i < n; ++i) {
    const auto& mode = modes[static_cast<std::size_t>(i)];
    for (const Index column : {2 * i, 2 * i + 1}) {
      const bool is_conjugate = column % 2 == 1;
      const std::complex<double> lambda = is_conjugate ? std::conj(mode.lambda) : mode.lambda;
      const Eigen::VectorXcd shape = is_conjugate ? Eigen::VectorXcd(mode.shape.conjugate()) : mode.shape;
      start.col(column) << shape, lambda * shape;
      growth[column] = std::exp(lambda * 0.05);
    }
  }
  Eigen::VectorXcd state = Eigen::VectorXcd::Zero(2 * n);
  state[n + run.dof("shaft:1", DofKind::uy)] = 0.1;
  const Eigen::VectorXcd share = start.partialPivLu().solve(state);
  const Eigen::VectorXcd expected = start * (growth.asDiagonal() * share);
  ASSERT_TRUE(run.run().completed);
  const Vector& x = run.simulation().state().x;
  EXPECT_LT((x - expected.head(n).real()).norm(), 1e-8 * x.norm());
  EXPECT_GT(expected.head(n).real().norm(), 1e-5);
}

constexpr const char* kCrossCoupled = R"(
schema = 1
[[element]]
type = "disc"
name = "rotor"
mass = 1.0
[[element]]
type      = "bearing"
node      = "rotor"
stiffness = [[1e4, 3e3], [-3e3, 1e4]]
damping   = [[20.0, 0], [0, 20.0]]
[integrator]
type     = "exact"
end_time = 1.0
)";

/// A bearing with cross terms: lambda^2 + 20 lambda + 1e4 -+ 3e3 i = 0, one mode unstable.
TEST(CrossCoupling, HasTheModesOfTheWholeMatrix) {
  SceneRun run(kCrossCoupled);
  EXPECT_FALSE(run.system().stiffness_is_symmetric);
  const auto modes = dynamics::Whirl(run.model()).modes(0.0, 4);
  ASSERT_EQ(modes.size(), 2U);
  for (const auto& mode : modes) {
    const std::complex<double> square = mode.lambda * mode.lambda + 20.0 * mode.lambda + 1e4;
    EXPECT_NEAR(std::abs(square), 3e3, 1e-9 * 1e4);
    EXPECT_NEAR(square.real(), 0.0, 1e-9 * 1e4);
  }
  EXPECT_GT(std::max(modes[0].lambda.real(), modes[1].lambda.real()), 4.0);
  const auto range = dynamics::frequency_range(run.system(), dynamics::StopState::open);
  EXPECT_NEAR(range->lowest, 100.0, 1e-9);
  EXPECT_NEAR(range->highest, 100.0, 1e-9);
}

TEST(CrossCoupling, MovesAStaticPositionAcrossTheForce) {
  SceneRun run(kCrossCoupled + std::string("[[load]]\ntype = \"constant\"\nnode = \"rotor\"\nvalue = 100.0\n"));
  const Vector x = dynamics::static_position(run.dynamics(), 0.0, Vector::Zero(2));
  EXPECT_NEAR(x[0], 100.0 * 1e4 / 1.09e8, 1e-15);
  EXPECT_NEAR(x[1], 100.0 * 3e3 / 1.09e8, 1e-15);
}

/// `auto` holds the part of a long shaft that does not move yet at rest; gyroscopic forces are included.
TEST(LongShaft, GetsTheSameAnswerFromThePartThatMoves) {
  const std::string scene = steel("rayleigh", 240, 6.0, 0.025, "young_modulus = 2.1e11\ndensity = 7800.0") +
                            "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"u\", \"w\"]\n"
                            "[damping]\nstiffness_proportional = 1e-6\n[rotation]\nspeed = 800.0\n"
                            "[[load]]\ntype = \"unbalance\"\nnode = \"shaft:120\"\nmoment = 1e-3\n"
                            "[integrator]\nend_time = 0.004\ntolerance = 1e-5\n";
  SceneRun whole(scene, {"integrator.type=rodas4"}), part(scene, {"integrator.type=auto"});
  ASSERT_NE(part.integrator().choice().find("moving part"), std::string::npos) << part.integrator().choice();
  ASSERT_TRUE(whole.run().completed);
  ASSERT_TRUE(part.run().completed);
  const Vector &x = whole.simulation().state().x, &y = part.simulation().state().x;
  EXPECT_LT((x - y).norm(), 1e-4 * x.norm());
}

/// A disc that only tilts: omega = +-Omega I_p/(2 I_d) + sqrt((Omega I_p/(2 I_d))^2 + k/I_d), + for the forward mode.
/// Its lateral modes beside them move along lines.
TEST(TiltingDisc, WhirlsForwardInItsFastMode) {
  const double speed = 200.0, inertia = 0.02, polar = 0.035, stiffness = 700.0;
  const scene::Scene scene = read_scene(
      "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"m\"\nmass = 3.0\ndiametral_inertia = 0.02\npolar_inertia = "
      "0.035\n"
      "[[element]]\ntype = \"spring\"\nnode = \"m\"\ndof = \"ry\"\nstiffness = 700.0\n[[element]]\ntype = \"spring\"\n"
      "node = \"m\"\ndof = \"rz\"\nstiffness = 700.0\n[[element]]\ntype = \"bearing\"\nnode = \"m\"\nstiffness = "
      "[[3.0e4, 0.0], "
      "[0.0, 3.5e4]]\n[rotation]\nspeed = 200.0\n[integrator]\ntype = \"rk4\"\ntime_step = 1e-4\nend_time = 0.1\n");
  const auto modes = dynamics::Whirl(scene.model).modes(speed, 4);
  ASSERT_EQ(modes.size(), 4U);
  const double turn = speed * polar / (2.0 * inertia), root = std::sqrt(turn * turn + stiffness / inertia);
  EXPECT_NEAR(modes[0].frequency(), root - turn, 1e-9 * root);
  EXPECT_NEAR(modes[0].direction, -1.0, 1e-9);
  EXPECT_EQ(modes[1].direction, 0.0);
  EXPECT_EQ(modes[2].direction, 0.0);
  EXPECT_NEAR(modes[3].frequency(), root + turn, 1e-9 * root);
  EXPECT_NEAR(modes[3].direction, 1.0, 1e-9);
}

}  // namespace
}  // namespace butee::test::rotor_test
