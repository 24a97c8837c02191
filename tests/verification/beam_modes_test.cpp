// Natural frequencies of beams compared with theory and independent programs.
#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "support/cantilever.hpp"

namespace butee::test::beam_modes_test {
namespace {

/// The references have 8 to 10 printed digits; computed frequencies are exact to rounding.
constexpr double kPrinted = 1e-8;

/// Bending in both planes, torsion and axial motion, compared with an independent program with the same
/// elements.
TEST(Cantilever, HasTheModesOfAllSixMotions) {
  const auto found = frequencies(cantilever("[[0, 0, 0], [1, 0, 0]]", ""), 12);
  expect_all(found, {25.06549917, 50.13099836, 157.08312306, 314.16624612}, kPrinted);
  for (const double wanted : {594.49678676, 1293.38090440})
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](double f) {
      return std::abs(f - wanted) < kPrinted * wanted;
    })) << wanted;
}

TEST(Cantilever, HasTheSameModesInEveryDirection) {
  const auto along_x = frequencies(cantilever("[[0, 0, 0], [1, 0, 0]]", ""), 10);
  const double a = 1.0 / std::sqrt(3.0);
  std::ostringstream diagonal;
  diagonal.precision(17);
  diagonal << "[[1, 2, 3], [" << 1 + a << ", " << 2 + a << ", " << 3 + a << "]]";
  // Rounding of the coordinates and of rotated matrices, relative to the highest frequency.
  constexpr double kTurned = 1e-9;
  expect_all(frequencies(cantilever(diagonal.str(), ""), 10), along_x, kTurned);
  expect_all(frequencies(cantilever("[[0, 0, 0], [0, 1, 0]]", "[0.3, 0, 1]"), 10), along_x, kTurned);
  expect_all(frequencies(cantilever("[[0, 0, 0], [0, 0, -1]]", "[1, 0, 0]"), 10), along_x, kTurned);
}

/// Timoshenko's theory with kappa = 5/6, exact frequencies; elements with static shape functions converge as l^2.
TEST(Cantilever, ConvergesWithShearToTimoshenko) {
  const auto error = [](int elements) {
    std::string scene = cantilever("[[0, 0, 0], [1, 0, 0]]", "", "timoshenko");
    scene.replace(scene.find("elements = 20"), 13, "elements = " + std::to_string(elements));
    return frequencies(scene, 4)[3] / 308.0657828845 - 1.0;
  };
  const double coarse = error(20), fine = error(40);
  EXPECT_LT(std::abs(coarse), 2e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
}

/// A short cantilever, 5 times as long as high: the second Euler-Bernoulli frequency is 20 % too high. Errors
/// are of order l^2, so two meshes give the limit.
TEST(StubbyCantilever, HasTheExactFrequenciesOfTimoshenko) {
  const auto strong = [](const std::string& theory, int elements) {
    std::string scene = cantilever("[[0, 0, 0], [0.3, 0, 0]]", "", theory);
    scene.replace(scene.find("elements = 20"), 13, "elements = " + std::to_string(elements));
    scene += "[[support]]\nnodes = \"arm:all\"\nfix = [\"ux\", \"uz\", \"rx\", \"ry\"]\n";
    return frequencies(scene, 3);
  };
  const auto coarse = strong("timoshenko", 40), middle = strong("timoshenko", 80), fine = strong("timoshenko", 160);
  const double exact[] = {540.1816525855, 2909.1983388789, 6924.4415676};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(std::log2((coarse[i] - exact[i]) / (middle[i] - exact[i])), 2.0, 0.02) << i;
    EXPECT_NEAR((4.0 * fine[i] - middle[i]) / 3.0, exact[i], 1e-6 * exact[i]) << i;
  }
  const auto euler = strong("euler", 40);
  EXPECT_NEAR(euler[0], 557.011063, 1e-6 * 557.0);
  EXPECT_NEAR(euler[1], 3490.728746, 2e-6 * 3490.0);
}

/// NAFEMS test 5, a deep pinned beam: a w^4 - b w^2 + c = 0 in Timoshenko's theory.
TEST(DeepBeam, HasTheFrequenciesOfTimoshenko) {
  const std::string scene = R"(
schema = 1
[material.steel]
young_modulus = 2e11
density       = 8000.0
poisson_ratio = 0.3
[section.bar]
shape  = "rectangle"
width  = 2.0
height = 2.0
[[element]]
type = "beam"
name = "deep"
theory = "timoshenko"
material = "steel"
section = "bar"
length = 10.0
elements = 160
[[support]]
nodes = ["deep:first", "deep:last"]
fix = ["u"]
[integrator]
type = "newmark"
time_step = 1e-4
end_time = 1e-3
)";
  // Errors are of order l^2: extrapolation from two meshes.
  const auto mesh = [&](int elements) {
    std::string finer = scene;
    finer.replace(finer.find("elements = 160"), 14, "elements = " + std::to_string(elements));
    return frequencies(finer, 4);
  };
  const auto coarse = mesh(80), fine = mesh(160);
  const double exact[] = {42.6087172539, 147.7860120041, 282.3633846355, 428.4717673861};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(std::log2((coarse[i] - exact[i]) / (fine[i] - exact[i])), 2.0, 0.02) << i;
    EXPECT_NEAR((4.0 * fine[i] - coarse[i]) / 3.0, exact[i], 1e-7 * exact[i]) << i;
  }
}

/// The same bar in axial motion, clamped and free: sqrt(E/rho)/(4 L).
TEST(DeepBeam, HasTheAxialFrequencyOfABar) {
  std::string scene = cantilever("[[0, 0, 0], [10, 0, 0]]", "");
  scene.replace(scene.find("young_modulus"),
                scene.find("\n", scene.find("young_modulus")) - scene.find("young_modulus"), "young_modulus = 2e11");
  scene.replace(scene.find("density"), scene.find("\n", scene.find("density")) - scene.find("density"),
                "density = 8000.0");
  scene += "[[support]]\nnodes = \"arm:all\"\nfix = [\"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n";
  const auto mesh = [&](int elements) {
    std::string finer = scene;
    finer.replace(finer.find("elements = 20"), 13, "elements = " + std::to_string(elements));
    return frequencies(finer, 1)[0];
  };
  EXPECT_NEAR((4.0 * mesh(20) - mesh(10)) / 3.0, 125.0, 1e-6 * 125.0);
}

}  // namespace
}  // namespace butee::test::beam_modes_test
