// Static positions where the stiffness is singular, or singular up to rounding, until contacts hold the structure; and
// structures that nothing holds.
#include <cmath>
#include <numbers>
#include <string>

#include <butee/core/error.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::static_position_test {
namespace {

constexpr double kGravity = 9.81;

/// A beam under its weight.
std::string beam(const std::string& motion, int elements, const std::string& more) {
  return R"(schema = 1
[material.steel]
young_modulus = 2e11
density = 7800.0
poisson_ratio = 0.3
[section.rod]
shape = "circle"
radius = 0.0125
[[element]]
type = "beam"
name = "b"
material = "steel"
section = "rod"
length = 0.6
)" + motion +
         "elements = " + std::to_string(elements) +
         "\n[integrator]\ntype = \"rodas4\"\nend_time = 1e-3\n[gravity]\nstatic = true\n" + more;
}

/// A hinged beam falls onto a stop below its free end, which then carries half of its weight. For few elements the
/// pivot of the rotation about the hinge is rounding and not zero.
TEST(StaticPosition, IsFoundWhereAStopHoldsAHingedBeam) {
  constexpr double kMass = 7800.0 * std::numbers::pi * 0.0125 * 0.0125 * 0.6;
  for (const double stiffness : {1e4, 1e7})
    for (const int elements : {2, 3, 5, 9, 50}) {
      const std::string stop =
          "acceleration = [0.0, -9.81, 0.0]\n[[support]]\nnodes = [\"b:first\"]\nfix = [\"u\"]\n"
          "[[contact]]\ntype = \"stop\"\nnodes = \"b:last\"\nsides = \"negative\"\nlaw = "
          "\"linear\"\ngap = 1e-3\nstiffness = " +
          std::to_string(stiffness) + "\n";
      SceneRun run(beam("", elements, stop));
      EXPECT_NEAR(run.system().initial_displacement[run.dof("b:last")], -1e-3 - 0.5 * kMass * kGravity / stiffness,
                  1e-10)
          << elements << " " << stiffness;
    }
}

/// 5 q L^4/(384 E I) in the middle of a beam on two supports, exact in cubic elements at their nodes. The terms of K x
/// cancel to n^-4 of their size.
TEST(StaticPosition, OfFineMeshesIsExact) {
  constexpr double kArea = std::numbers::pi * 0.0125 * 0.0125, kBending = 2e11 * kArea * 0.0125 * 0.0125 / 4.0;
  for (const int elements : {10, 1000, 3000, 6000}) {
    SceneRun run(beam("", elements,
                      "acceleration = [0.0, -9.81, 0.0]\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = "
                      "[\"u\"]\n"));
    const double sag = -5.0 * 7800.0 * kArea * kGravity * std::pow(0.6, 4) / (384.0 * kBending);
    EXPECT_NEAR(run.system().initial_displacement[run.dof("b:middle")], sag, -1e-7 * sag) << elements;
  }
}

/// Nothing loads the rotation of the shaft about its axis, and nothing holds it.
TEST(StaticPosition, LeavesMotionThatNothingLoads) {
  const auto sag = [](const std::string& fixed) {
    SceneRun run(
        beam("motion = \"spatial\"\n", 4,
             "acceleration = [0.0, 0.0, -9.81]\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"ux\", "
             "\"uy\", \"uz\"" +
                 fixed + "]\n[[contact]]\ntype = \"ring\"\nnodes = \"b:middle\"\ngap = 1e-5\nstiffness = 1e6\n"));
    return run.system().initial_displacement[run.dof("b:middle", DofKind::uz)];
  };
  const double held = sag(", \"rx\"");
  EXPECT_LT(held, -1e-5);
  EXPECT_NEAR(sag(""), held, 1e-13);
}

/// Rounding of the stiffness holds such a beam thousands of kilometres away.
TEST(StaticPosition, IsRefusedWhereNothingHoldsABeam) {
  for (const int elements : {2, 10, 200}) try {
      SceneRun run(beam("", elements,
                        "acceleration = [0.0, -9.81, 0.0]\n[[contact]]\ntype = \"stop\"\nnodes = [\"b:first\", "
                        "\"b:last\"]\nsides = \"positive\"\nlaw = \"linear\"\ngap = 5e-3\nstiffness = 1e6\n"));
      ADD_FAILURE() << elements;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("nothing holds"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace butee::test::static_position_test
