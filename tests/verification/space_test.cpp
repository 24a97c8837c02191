#include <cmath>
#include <numbers>

#include <Eigen/SparseCholesky>
#include <butee/core/error.hpp>
#include <butee/dynamics/modes.hpp>
#include <butee/model/element_choice.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::space_test {
namespace {

using std::numbers::pi;

/// The references are printed with 8 to 10 digits; frequencies are found to rounding.
constexpr double kPrinted = 1e-8;

constexpr const char* kSteel = R"(
schema = 1
[material.steel]
young_modulus = 2.1e11
density       = 7850.0
poisson_ratio = 0.3
[section.bar]
shape  = "rectangle"
width  = 0.03
height = 0.06
[integrator]
type = "newmark"
time_step = 1e-4
end_time = 1e-3
)";

/// A cantilever of 30 x 60 mm, 1 m long, between two points.
std::string cantilever(const std::string& points, const std::string& up, const std::string& theory = "euler") {
  return kSteel +
         std::string("[[element]]\ntype = \"beam\"\nname = \"arm\"\nmotion = \"spatial\"\nmaterial = \"steel\"\n") +
         "section = \"bar\"\nelements = 20\npoints = " + points + "\n" + (up.empty() ? "" : "up = " + up + "\n") +
         "theory = \"" + theory +
         "\"\n[[support]]\nnodes = \"arm:first\"\nfix = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n";
}

/// Frequencies, Hz.
std::vector<double> frequencies(const std::string& toml, Index count) {
  SceneRun run(toml);
  const dynamics::Structure structure(run.model(), run.system().dofs);
  const auto modes = dynamics::find_modes(structure, count);
  EXPECT_EQ(modes.problem, "");
  std::vector<double> list;
  for (Index i = 0; i < count; ++i) list.push_back(modes.frequencies[i] / (2 * pi));
  return list;
}

void expect_all(const std::vector<double>& found, const std::vector<double>& wanted, double tolerance) {
  ASSERT_GE(found.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found[i], wanted[i], tolerance * wanted[i]) << i;
}

/// Bending in both planes, torsion and axial motion, of an independent program with the same elements.
TEST(Cantilever, has_the_modes_of_all_six_motions) {
  const auto found = frequencies(cantilever("[[0, 0, 0], [1, 0, 0]]", ""), 12);
  expect_all(found, {25.06549917, 50.13099836, 157.08312306, 314.16624612}, kPrinted);
  for (const double wanted : {594.49678676, 1293.38090440})
    EXPECT_TRUE(std::any_of(found.begin(), found.end(), [&](double f) {
      return std::abs(f - wanted) < kPrinted * wanted;
    })) << wanted;
}

TEST(Cantilever, has_the_same_modes_in_every_direction) {
  const auto along_x = frequencies(cantilever("[[0, 0, 0], [1, 0, 0]]", ""), 10);
  const double a = 1.0 / std::sqrt(3.0);
  std::ostringstream diagonal;
  diagonal.precision(17);
  diagonal << "[[1, 2, 3], [" << 1 + a << ", " << 2 + a << ", " << 3 + a << "]]";
  // Rounding of the coordinates, and of turned matrices relative to their highest frequency.
  constexpr double kTurned = 1e-9;
  expect_all(frequencies(cantilever(diagonal.str(), ""), 10), along_x, kTurned);
  expect_all(frequencies(cantilever("[[0, 0, 0], [0, 1, 0]]", "[0.3, 0, 1]"), 10), along_x, kTurned);
  expect_all(frequencies(cantilever("[[0, 0, 0], [0, 0, -1]]", "[1, 0, 0]"), 10), along_x, kTurned);
}

/// Timoshenko's theory with kappa = 5/6, exact frequencies; elements with static shape functions converge as l^2.
TEST(Cantilever, converges_with_shear_to_timoshenko) {
  const auto error = [](int elements) {
    std::string scene = cantilever("[[0, 0, 0], [1, 0, 0]]", "", "timoshenko");
    scene.replace(scene.find("elements = 20"), 13, "elements = " + std::to_string(elements));
    return frequencies(scene, 4)[3] / 308.0657828845 - 1.0;
  };
  const double coarse = error(20), fine = error(40);
  EXPECT_LT(std::abs(coarse), 2e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.1);
}

/// A stubby cantilever, 5 times as long as it is high: Euler and Bernoulli's second frequency is 20 % too high. Errors
/// of order l^2, so that two meshes give the limit.
TEST(StubbyCantilever, has_the_exact_frequencies_of_timoshenko) {
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
TEST(DeepBeam, has_the_frequencies_of_timoshenko) {
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
  // Errors of order l^2: the limit of two meshes.
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

/// The same bar clamped and free along its axis: sqrt(E/rho)/(4 L).
TEST(DeepBeam, has_the_axial_frequency_of_a_bar) {
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

std::string tied_bar(double preload, int elements, const std::string& more = "") {
  return R"(
schema = 1
[material.steel]
young_modulus = 2e11
density       = 7800.0
[section.round]
shape  = "circle"
radius = 0.005
[integrator]
type = "newmark"
time_step = 1e-4
end_time = 1e-3
[[element]]
type = "beam"
name = "bar"
material = "steel"
section = "round"
length = 2.0
preload = )" +
         std::to_string(preload) + "\nelements = " + std::to_string(elements) +
         "\n[[support]]\nnodes = [\"bar:first\", \"bar:last\"]\nfix = [\"u\"]\n" + more;
}

/// code_aster's SDLL101: f_n = n^2 pi/(2 L^2) sqrt(E I/m) sqrt(1 + P L^2/(n^2 pi^2 E I)).
TEST(TiedBar, stiffens_with_tension) {
  expect_all(frequencies(tied_bar(1000.0, 20), 5), {11.2577073, 28.3462835, 54.0382821, 89.2209917, 134.1811141}, 5e-9);
  expect_all(frequencies(tied_bar(-100.0, 80), 3), {3.809372, 18.831035, 43.703291}, 5e-7);
}

TEST(TiedBar, sags_under_gravity) {
  const auto sag = [](double preload) {
    SceneRun run(tied_bar(preload, 40, "[gravity]\nacceleration = [0.0, -9.81, 0.0]\n"));
    Vector force(run.system().size());
    run.dynamics().external_force(0.0, force);
    const Eigen::SimplicialLDLT<SparseMatrix> factor(run.system().stiffness);
    return -Vector(factor.solve(force))[run.dof("bar:middle")];
  };
  EXPECT_NEAR(sag(0.0), .0127530000, 1e-10);
  EXPECT_NEAR(sag(100.0), .0090145068, 5e-8 * .009);
  EXPECT_NEAR(sag(1000.0), .0024632794, 5e-8 * .0025);
  EXPECT_NEAR(sag(-30.0), .0145618950, 5e-8 * .0146);
}

/// Started in its static position on a stop, a bar stays there; the stop carries what the sag beyond it asks for.
TEST(TiedBar, rests_where_gravity_and_a_stop_hold_it) {
  const std::string stop =
      "[[contact]]\ntype = \"stop\"\nnodes = \"bar:middle\"\ngap = 0.005\nlaw = \"linear\"\nstiffness = 1e4\n";
  SceneRun run(tied_bar(0.0, 20, "[gravity]\nacceleration = [0.0, -9.81, 0.0]\nstatic = true\n" + stop));
  // u = sag - F L^3/(48 E I) with F = k (u - gap), elements with cubic shape functions being exact at nodes.
  constexpr double kBar = 48.0 * 2e11 * (pi / 4 * 0.005 * 0.005 * 0.005 * 0.005) / 8.0;
  const double wanted = (.0127530000 + 1e4 * 0.005 / kBar) / (1.0 + 1e4 / kBar);
  const Index middle = run.dof("bar:middle");
  const double start = run.system().initial_displacement[middle];
  EXPECT_NEAR(-start, wanted, 1e-9 * wanted);
  ASSERT_TRUE(run.run().completed);
  EXPECT_NEAR(run.simulation().state().x[middle], start, 1e-9 * wanted);
}

/// A base that accelerates is a force -M r a: of one mass the closed form.
TEST(Base, accelerates_every_mass) {
  SceneRun run(R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 2.5
[[element]]
type = "spring"
node = "m"
stiffness = 1000.0
[base]
acceleration = { direction = [0, 2, 0], type = "constant", value = 3.0 }
[integrator]
type = "exact"
end_time = 1.0
)");
  ASSERT_TRUE(run.run().completed);
  const double omega = 20.0, wanted = -3.0 / (omega * omega) * (1.0 - std::cos(omega));
  EXPECT_NEAR(run.simulation().state().x[0], wanted, 1e-13);
}

/// The same motion, whichever way a scene says it: along z of a lateral beam as along y of a planar one.
TEST(Planes, are_alike) {
  const auto run = [](const std::string& motion, const std::string& dof, DofKind kind) {
    const std::string fixed = dof == "u" ? "theta" : "ry", rest = motion == "planar" ? "" : ", \"u\", \"theta\"";
    SceneRun scene(kSteel + std::string("[[element]]\ntype = \"beam\"\nname = \"arm\"\nlength = 1.0\nelements = 8\n") +
                       "material = \"steel\"\nsection = \"square\"\nmotion = \"" + motion +
                       "\"\n[section.square]\nshape = \"rectangle\"\nwidth = 0.04\nheight = 0.04\n[[support]]\nnodes = "
                       "\"arm:first\"\nfix = [\"" +
                       dof + "\", \"" + fixed + "\"" + rest +
                       "]\n[[load]]\ntype = \"constant\"\nnode = \"arm:last\"\ndof = \"" + dof + "\"\nvalue = 100.0\n",
                   {"integrator.type=rodas4", "integrator.end_time=0.05", "integrator.tolerance=1e-6"});
    Sampler tip(scene.dof("arm:last", kind), {0.01, 0.02, 0.05});
    scene.simulation().add(tip);
    EXPECT_TRUE(scene.run().completed);
    return tip.x;
  };
  const auto y = run("planar", "u", DofKind::uy), z = run("lateral", "uz", DofKind::uz);
  // Steps differ by rounding alone.
  EXPECT_LT(relative_rms(z, y), 1e-9);
}

/// Round beams have equal frequencies in both planes, whose modes must not mix: beside a stop in the plane that stays
/// at rest rounding would be motion, and no step short enough for it.
TEST(Planes, a_load_in_one_leaves_the_other_at_rest) {
  const std::string scene =
      kSteel + std::string(
                   "[section.round]\nshape = \"circle\"\nradius = 0.047\n[[element]]\ntype = \"beam\"\n"
                   "name = \"b\"\nmotion = \"lateral\"\nmaterial = \"steel\"\nsection = \"round\"\n"
                   "length = 2.2\nelements = 4\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\n"
                   "fix = [\"uy\", \"uz\"]\n[[contact]]\ntype = \"stop\"\nnodes = \"b:1\"\ngap = 2e-4\n"
                   "stiffness = 4e7\n[damping]\nstiffness_proportional = 6e-5\n[[load]]\ntype = "
                   "\"harmonic\"\nnode = \"b:1\"\ndof = \"uz\"\namplitude = 600.0\n"
                   "angular_frequency = 140.0\nphase = 0.7\n");
  const auto run = [&](const char* method) {
    SceneRun one(scene, {std::string("integrator.type=") + method, "integrator.end_time=0.05"});
    EXPECT_TRUE(one.run().completed) << one.simulation().report().message;
    EXPECT_EQ(one.simulation().state().x[one.dof("b:1", DofKind::uy)], 0.0) << method;
    return one.simulation().state().x[one.dof("b:1", DofKind::uz)];
  };
  const double wanted = run("exact");
  EXPECT_NEAR(run("exponential"), wanted, 1e-3 * std::abs(wanted));
}

TEST(Planes, forces_that_would_be_incomplete_are_refused) {
  const auto why = [](const std::string& toml, model::Quantity quantity, const std::string& node) {
    SceneRun run(toml);
    const model::NodeId id = run.model().nodes.select(node).nodes.front();
    return model::why_not(quantity, run.model(), run.system().dofs, id, "");
  };
  const std::string arm = cantilever("[[0, 0, 0], [1, 0, 0]]", "");
  EXPECT_NE(why(arm, model::Quantity::von_mises, "arm:first").find("round sections alone"), std::string::npos);
  EXPECT_EQ(why(arm, model::Quantity::bending_moment, "arm:first"), "");
  EXPECT_EQ(why(arm, model::Quantity::torque, "arm:first"), "");
  EXPECT_EQ(why(arm, model::Quantity::reaction_rx, "arm:first"), "");
  EXPECT_NE(why(arm, model::Quantity::reaction_rx, "arm:last").find("is free"), std::string::npos);
  std::string planar = arm.substr(0, arm.find("[[support]]"));
  planar.replace(planar.find("spatial"), 7, "planar");
  EXPECT_NE(why(planar, model::Quantity::torque, "arm:first").find("motion = \"spatial\""), std::string::npos);
  EXPECT_NE(why(planar, model::Quantity::shear_z, "arm:first").find("motion = \"lateral\""), std::string::npos);
}

struct Mistake {
  std::string name, scene, says;
};

class BadInput : public testing::TestWithParam<Mistake> {};

TEST_P(BadInput, is_said_with_its_remedy) {
  try {
    read_scene(GetParam().scene);
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().says), std::string::npos) << error.what();
  }
}

const std::string kShaft = std::string(kSteel) +
                           "[section.round]\nshape = \"circle\"\nradius = 0.02\n[[element]]\ntype = \"beam\"\nname = "
                           "\"shaft\"\nmaterial = \"steel\"\nsection = \"round\"\nlength = 1.0\nelements = 2\n";

INSTANTIATE_TEST_SUITE_P(
    scenes, BadInput,
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
                "is of parts that turn, but nothing does"},
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
}  // namespace butee::test::space_test
