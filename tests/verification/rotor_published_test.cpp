// Whirl frequencies and critical speeds of published rotors that rotor_test.cpp does not contain.
#include <cmath>

#include <butee/dynamics/whirl.hpp>
#include <gtest/gtest.h>

#include "rotors.hpp"
#include "support/scene_run.hpp"

namespace butee::test::rotor_published_test {
namespace {

using namespace rotors;

const std::string kFriswellSteel = "young_modulus = 211e9\ndensity = 7810.0\nshear_modulus = 81.2e9";

std::vector<double> speeds_of(const std::vector<dynamics::CriticalSpeed>& found) {
  std::vector<double> list;
  for (const auto& one : found) list.push_back(one.speed);
  return list;
}

/// Friswell's examples 5.9.4, cross stiffness of 5e5 N/m, and the critical speeds of 5.9.9.
TEST(FriswellsOthers, CrossCoupledBearingsAndCriticalSpeedsOfTheOverhungDisc) {
  const auto cross = [](const std::string& at) {
    return "[[element]]\ntype = \"bearing\"\nnode = \"shaft" + at + "\"\nstiffness = [[1e6, 5e5], [5e5, 1e6]]\n";
  };
  SceneRun coupled(
      steel("timoshenko", 6, 1.5, 0.025, kFriswellSteel) + disc("@0.5", 32.58972765, 0.1780892826, 0.3295636209) +
      disc("@1.0", 51.52526111, 0.4235805841, 0.8050822049) + cross(":first") + cross(":last") + turning(1.0));
  const dynamics::Whirl whirl(coupled.model());
  expect_all(frequencies(whirl.modes(0.0, 6)), {11.662586, 14.801390, 33.970005, 49.193595, 97.966839, 126.614077},
             2 * pi, 5e-8);
  expect_all(frequencies(whirl.modes(4000 * kRpm, 5)), {11.651710, 14.787995, 33.155022, 49.687530, 89.414784}, 2 * pi,
             5e-8);
  SceneRun overhung(steel("timoshenko", 6, 1.5, 0.025, kFriswellSteel) +
                    disc("@1.5", 51.52526111, 0.4235805841, 0.8050822049) + bearing("@0.0", 1e7, 1e7) +
                    bearing("@1.0", 1e7, 1e7) + turning(1.0));
  expect_all(speeds_of(dynamics::Whirl(overhung.model()).critical_speeds(0.0, 650.0, 20, 1.0, 12)),
             {832.695018, 890.771302, 5025.827667, 6063.312984}, kRpm, 1e-9);
}

/// Lalanne and Ferraris' rotor: damping ratios at rest, critical speeds, and the published values.
class ThreeDiscs : public testing::Test {
 protected:
  static std::string rotor(const std::string& theory, double c) {
    return steel(theory, 13, 1.3, 0.05, "young_modulus = 2e11\ndensity = 7800.0\npoisson_ratio = 0.3") +
           disc("@0.2", 14.58013, .06463858, .1232021) + disc("@0.5", 45.94579, .4977461, .9763481) +
           disc("@1.0", 55.13495, .6023493, 1.171618) + bearing(":first", 5e7, 7e7, 500 * c, 700 * c) +
           bearing(":last", 5e7, 7e7, 500 * c, 700 * c) + turning(1.0);
  }
};

TEST_F(ThreeDiscs, HasItsModesAtRestAndPublishedOnes) {
  SceneRun run(rotor("timoshenko", 1.0));
  const dynamics::Whirl whirl(run.model());
  const auto rest = whirl.modes(0.0, 6);
  expect_all(frequencies(rest), {60.614794, 63.025472, 169.496497, 185.563456, 329.605244, 362.077957}, 2 * pi, 2e-8);
  const double ratios[] = {5.03e-4, 3.99e-4, 3.123e-3, 2.853e-3, 5.783e-3, 6.293e-3};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(rest[i].damping_ratio(), ratios[i], 6e-7) << i;
  expect_all(frequencies(whirl.modes(30000 * kRpm, 4)), {54.112, 68.122, 154.65, 196.0}, 2 * pi, 3e-3);
  SceneRun slender(rotor("euler", 1.0));
  const dynamics::Whirl by_euler(slender.model());
  expect_all(frequencies(by_euler.modes(0.0, 4)), {60.875881, 63.321362, 171.139004, 187.776170}, 2 * pi, 2e-8);
  expect_all(frequencies(by_euler.modes(30000 * kRpm, 4)), {54.626832, 68.132460, 156.278146, 197.793839}, 2 * pi,
             2e-8);
}

TEST_F(ThreeDiscs, HasItsUndampedCriticalSpeeds) {
  SceneRun run(rotor("timoshenko", 0.0));
  expect_all(speeds_of(dynamics::Whirl(run.model()).critical_speeds(0.0, 2900.0, 30, 1.0, 16)),
             {3620.359, 3798.069, 10016.900, 11278.247, 16768.908, 24398.844, 26602.668}, kRpm, 2e-7);
}

/// The example rotor of ROSS at 500 rpm, with consistent matrices and with masses lumped at seven stations as
/// in the commercial program RAPPID: they differ by 8 to 13 % from the fifth mode on.
TEST(RossExample, HasTheModesOfConsistentAndOfLumpedMasses) {
  const double mass = 32.58972765, diametral = 0.1780892826, polar = 0.3295636209;
  const std::string rest = disc("@0.5", mass, diametral, polar) + disc("@1.0", mass, diametral, polar) +
                           bearing(":first", 1e6, 8e5) + bearing(":last", 1e6, 8e5);
  SceneRun run(steel("timoshenko", 6, 1.5, 0.025, kFriswellSteel) + rest + turning(1.0));
  expect_all(frequencies(dynamics::Whirl(run.model()).modes(500 * kRpm, 8)),
             {14.60945, 15.32518, 43.67609, 47.21142, 114.79029, 122.00109, 170.22854, 175.65634}, 2 * pi, 4e-7);
  constexpr double kLength = 0.25, kRadius = 0.025;
  const double half = 7810.0 * pi * kRadius * kRadius * 0.5 * kLength;
  std::string stations;
  for (int i = 0; i <= 6; ++i) {
    const double share = i == 0 || i == 6 ? 1.0 : 2.0;
    stations += disc(":" + std::to_string(i), share * half,
                     share * half * (0.25 * kLength * kLength / 3.0 + 0.25 * kRadius * kRadius),
                     share * half * 0.5 * kRadius * kRadius);
  }
  SceneRun lumped(steel("timoshenko", 6, 1.5, 0.025, "young_modulus = 211e9\ndensity = 1e-6\nshear_modulus = 81.2e9") +
                  stations + rest + turning(1.0));
  const auto found = frequencies(dynamics::Whirl(lumped.model()).modes(500 * kRpm, 8));
  expect_all(found, {14.61662, 15.33000, 43.35584, 46.93797, 105.91094, 112.76962, 151.03182, 155.93248}, 2 * pi, 4e-7);
  expect_all(found, {14.6152, 15.3284, 43.3459, 46.9251, 105.902, 112.760, 150.907, 155.810}, 2 * pi, 1e-3);
}

/// (rho A -+ rho I b^2) W^2 = E I b^4: speeds at which the whirl frequency of a pinned shaft with rotary
/// inertia equals the speed of rotation.
TEST(RayleighShaft, HasTheExactCriticalSpeedsOfRayleigh) {
  const auto mesh = [](int elements) {
    SceneRun run(steel("rayleigh", elements, 1.0, 0.05, "young_modulus = 2.1e11\ndensity = 7800.0") +
                 "[[support]]\nnodes = [\"shaft:first\", \"shaft:last\"]\nfix = [\"uy\", \"uz\"]\n" + turning(1.0));
    const dynamics::Whirl whirl(run.model());
    const auto found = whirl.critical_speeds(1200.0, 1300.0, 4, 1.0, 4);
    EXPECT_EQ(found.size(), 2U);
    EXPECT_NEAR(found.at(0).direction, -1.0, 1e-6);
    EXPECT_NEAR(found.at(1).direction, 1.0, 1e-6);
    auto list = speeds_of(found);
    for (const double f : frequencies(whirl.modes(60000 * kRpm, 2))) list.push_back(f);
    return list;
  };
  // Order 4: extrapolation from two meshes.
  const auto coarse = mesh(8), fine = mesh(16);
  const double exact[] = {12114.117760 * kRpm, 12263.575349 * kRpm, 197.0977949 * 2 * pi, 209.3591661 * 2 * pi};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(std::log2((coarse[i] - exact[i]) / (fine[i] - exact[i])), 4.0, 0.1) << i;
    EXPECT_NEAR((16.0 * fine[i] - coarse[i]) / 15.0, exact[i], 5e-8 * exact[i]) << i;
  }
}

/// An overhung disc on a massless cantilever: every speed of the table; the frequency of forward whirl
/// increases.
TEST(OverhungDisc, OneElementIsExactAtEverySpeed) {
  SceneRun run(steel("euler", 1, 0.5, 0.01, "young_modulus = 2e11\ndensity = 1e-9") + disc(":last", 10, 0.05, 0.1) +
               "[[support]]\nnodes = \"shaft:first\"\nfix = [\"uy\", \"uz\", \"ry\", \"rz\"]\n" + turning(1.0));
  const dynamics::Whirl whirl(run.model());
  struct Row {
    double speed;
    std::vector<double> size, sense;
  };
  for (const Row& row : {Row{0.0, {60.0442419, 60.0442419, 512.6419277, 512.6419277}, {}},
                         {300.0, {47.0308491, 72.5566284, 312.8993049, 887.3735256}, {-1, 1, -1, 1}}}) {
    const auto modes = whirl.modes(row.speed, 4);
    expect_all(frequencies(modes), row.size, 1, 1e-9);
    for (std::size_t i = 0; i < row.sense.size(); ++i) EXPECT_NEAR(modes[i].direction, row.sense[i], 1e-9) << i;
  }
}

}  // namespace
}  // namespace butee::test::rotor_published_test
