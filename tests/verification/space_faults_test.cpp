// Mistakes in scenes in two planes and in space, and their messages with remedies.
#include <string>

#include <butee/core/error.hpp>
#include <gtest/gtest.h>

#include "support/cantilever.hpp"
#include "support/scene_run.hpp"

namespace butee::test::space_faults_test {
namespace {

struct Mistake {
  std::string name, scene, says;
};

class SpaceFaults : public testing::TestWithParam<Mistake> {};

TEST_P(SpaceFaults, IsSaidWithItsRemedy) {
  try {
    read_scene(GetParam().scene);
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

const std::string kShaft = steel_bar() +
                           "[section.round]\nshape = \"circle\"\nradius = 0.02\n[[element]]\ntype = \"beam\"\nname = "
                           "\"shaft\"\nmaterial = \"steel\"\nsection = \"round\"\nlength = 1.0\nelements = 2\n";

INSTANTIATE_TEST_SUITE_P(
    scenes, SpaceFaults,
    testing::Values(
        Mistake{"up_parallel", cantilever("[[0, 0, 0], [0, 1, 0]]", ""), "give up, such as [0, 0, 1]"},
        Mistake{"one_point", cantilever("[[0, 0, 0], [0, 0, 0]]", ""), "are one point"},
        Mistake{"nothing_turns", kShaft + "[rotation]\nspeed = 10.0\n", "turns nothing"},
        Mistake{"speed_missing", kShaft + "motion = \"lateral\"\n[rotation]\n", "missing; give the speed about x"},
        Mistake{"wrong_part", kShaft + "motion = \"lateral\"\n[rotation]\nspeed = 1.0\nparts = [\"shat\"]\n",
                "these can turn: shaft"},
        Mistake{"not_round", cantilever("[[0, 0, 0], [1, 0, 0]]", "") + "[rotation]\nspeed = 1.0\n",
                "second moments of area about y and z differ"},
        Mistake{"flat_disc",
                kShaft + "motion = \"lateral\"\n[[element]]\ntype = \"disc\"\nnode = \"shaft:1\"\nmass = 1.0\n"
                         "diametral_inertia = 0.1\n[rotation]\nspeed = 1.0\n",
                "no polar_inertia"},
        Mistake{"bearing_alone",
                kShaft + "[[element]]\ntype = \"bearing\"\nnode = \"shaft:1\"\nstiffness = [[1e6, 0], [0, 1e6]]\n",
                "uz of shaft:1 has no mass"},
        Mistake{"bearing_beside_the_shaft",
                kShaft + "motion = \"lateral\"\n[[element]]\ntype = \"bearing\"\nnode = \"shaft@0.6\"\nstiffness = "
                         "[[1e6, 0], [0, 1e6]]\n",
                "the nearest are shaft:1 at 0.5 m and shaft:2 at 1 m"},
        Mistake{"bearing_of_nothing",
                kShaft + "motion = \"lateral\"\n[[element]]\ntype = \"bearing\"\nnode = \"shat:1\"\nstiffness = "
                         "[[1e6, 0], [0, 1e6]]\n",
                "there is no node or beam \"shat\" (did you mean \"shaft\"?)"},
        Mistake{"speed_without_a_shaft", kShaft + "[rotation]\nspeed = 10.0\n",
                "the scene has no disc and no beam along x"},
        Mistake{"damping_of_nothing_that_turns",
                kShaft + "motion = \"lateral\"\n[damping]\nrotating_stiffness_proportional = 1e-5\n",
                "applies to rotating parts, but nothing turns"},
        Mistake{"load_along_nothing",
                kShaft + "[[load]]\ntype = \"constant\"\nnode = \"shaft:1\"\ndof = \"uz\"\nvalue = 1.0\n",
                "load[0].dof = \"uz\": uz of shaft:1 does not exist"},
        Mistake{"spring_along_no_mass",
                kShaft + "[[element]]\ntype = \"spring\"\nnode = \"shaft:1\"\ndof = \"uz\"\nstiffness = 1e3\n",
                "the free uz of shaft:1 has no mass"},
        Mistake{"parallel_up_that_was_given", cantilever("[[0, 0, 0], [1, 0, 0]]", "[2, 0, 0]"),
                "up = [2, 0, 0]: is parallel to the beam"},
        Mistake{"record_that_is_missing",
                kShaft + "[base]\nacceleration = { direction = [0, 1, 0], type = \"table\", file = \"no.csv\" }\n",
                "base.acceleration.file = \"no.csv\": does not exist"},
        Mistake{"unequal_speeds",
                kShaft +
                    "motion = \"lateral\"\n[rotation]\nspeed = { type = \"table\", times = [0, 1, 2], values = [0, "
                    "1] }\n",
                "rotation.speed.values = [0, 1]: must hold as many values as there are times (3)"},
        Mistake{"speeds_that_do_not_ascend",
                kShaft +
                    "motion = \"lateral\"\n[rotation]\nspeed = { type = \"table\", times = [0, 2, 1], values = [0, "
                    "1, 2] }\n",
                "rotation.speed.times = [0, 2, 1]: must ascend"},
        Mistake{"matrix_shape",
                kShaft + "[[element]]\ntype = \"bearing\"\nnode = \"shaft:1\"\nstiffness = [[1e6, 0, 0]]\n",
                "must be 2 arrays of 2 numbers each"},
        Mistake{"unbalance_at_rest",
                kShaft + "motion = \"lateral\"\n[[load]]\ntype = \"unbalance\"\nnode = \"shaft:1\"\nmoment = 1.0\n",
                "missing; give the speed of rotation"},
        Mistake{"planar_in_space",
                kShaft + "[[element]]\ntype = \"beam\"\nname = \"strut\"\nmaterial = \"steel\"\nsection = \"round\"\n"
                         "points = [[0, 0, 0], [0, 0, 1]]\nelements = 2\n",
                "motion = \"spatial\""},
        Mistake{
            "no_shear_modulus",
            "schema = 1\n[material.m]\nyoung_modulus = 1e9\ndensity = 1.0\n[section.s]\nshape = \"circle\"\nradius = "
            "0.1\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"m\"\nsection = \"s\"\nlength = "
            "1.0\nelements "
            "= 1\ntheory = \"timoshenko\"\n[integrator]\ntype = \"rk4\"\ntime_step = 1.0\nend_time = 1.0\n",
            "neither poisson_ratio nor shear_modulus"}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace butee::test::space_faults_test
