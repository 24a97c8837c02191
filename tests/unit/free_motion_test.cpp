#include <butee/dynamics/free_motion.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::free_motion_test {
namespace {

/// Three masses in a row: a is connected to ground, b to a, and c only if `last` says so.
std::string row(const std::string& last) {
  std::string text = "schema = 1\n";
  for (const std::string name : {"a", "b", "c"})
    text += "[[element]]\ntype = \"mass\"\nname = \"" + name + "\"\nmass = 2.0\n";
  return text +
         "[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 1e6\n[[element]]\ntype = \"spring\"\nnodes = "
         "[\"a\", "
         "\"b\"]\nstiffness = 1e5\n" +
         last + "[integrator]\ntype = \"rk4\"\ntime_step = 1e-3\nend_time = 1.0\n";
}

TEST(FreeMotion, IsThatOfTheNodeThatNothingHolds) {
  SceneRun run(row(""));
  EXPECT_EQ(dynamics::describe_softest_motion(run.system().stiffness, run.system().dofs), "u of c");
}

TEST(FreeMotion, NamesAllThatMoveTogether) {
  SceneRun run(row("[[element]]\ntype = \"spring\"\nnodes = [\"b\", \"c\"]\nstiffness = 1e7\n"),
               {"element[3].stiffness=0.0"});
  const std::string text = dynamics::describe_softest_motion(run.system().stiffness, run.system().dofs);
  for (const char* name : {"u of a", "u of b", "u of c"}) EXPECT_NE(text.find(name), std::string::npos) << text;
}

TEST(FreeMotion, OfABeamWithoutSupportsIsThatOfItsNodes) {
  for (const int elements : {4, 150}) {  // dense, and with a sparse factor
    SceneRun run(
        "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\nradius = "
        "0.02\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 4.0\nelements "
        "= " +
        std::to_string(elements) +
        "\n[[support]]\nnodes = [\"b:first\"]\nfix = [\"u\"]\n[integrator]\ntype = \"rk4\"\n"
        "time_step = 1e-6\nend_time = 1.0\n");
    // It rotates about its single support, so the far end moves most.
    const std::string text = dynamics::describe_softest_motion(run.system().stiffness, run.system().dofs);
    EXPECT_EQ(text.find("u of b:" + std::to_string(elements)), 0U) << text;
    EXPECT_EQ(text.find("theta"), std::string::npos) << text;
  }
}

TEST(FreeMotion, CountsWhatItDoesNotName) {
  SceneRun run(
      row("[[element]]\ntype = \"mass\"\nname = \"d\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
          "\"e\"\nmass = 1.0\n"));
  EXPECT_EQ(dynamics::describe_motion(Vector::Ones(5), run.system().dofs), "u of a, u of b, u of c, u of d and 1 more");
}

}  // namespace
}  // namespace butee::test::free_motion_test
