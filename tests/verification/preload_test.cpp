#include <cmath>
#include <numbers>

#include <butee/core/error.hpp>
#include <butee/dynamics/buckling.hpp>
#include <butee/dynamics/modes.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::preload_test {
namespace {

using std::numbers::pi;

std::string support(const std::string& node, const std::string& fix) {
  return fix.empty() ? "" : "[[support]]\nnodes = \"" + node + "\"\nfix = [" + fix + "]\n";
}

const std::string kPinned = "\"u\"", kClamped = "\"u\", \"theta\"", kFree;

/// The bar of code_aster's case SDLL101: round, 2 m long.
std::string bar(const std::string& preload, int elements, const std::string& first, const std::string& last) {
  return "schema = 1\n[material.steel]\nyoung_modulus = 2e11\ndensity = 7800.0\n[section.round]\nshape = "
         "\"circle\"\nradius = 0.005\n[integrator]\ntype = \"newmark\"\ntime_step = 1e-4\nend_time = 1e-3\n"
         "[[element]]\ntype = \"beam\"\nname = \"bar\"\nmaterial = \"steel\"\nsection = \"round\"\nlength = "
         "2.0\npreload = " +
         preload + "\nelements = " + std::to_string(elements) + "\n" + support("bar:first", first) +
         support("bar:last", last);
}

double critical_load(int elements, const std::string& first, const std::string& last) {
  auto scene = read_scene(bar("-1.0", elements, first, last));
  return dynamics::critical_preload_factor(scene.model);
}

std::vector<double> frequencies(const std::string& toml, Index count) {
  SceneRun run(toml);
  const auto modes = dynamics::find_modes(dynamics::Structure(run.model(), run.system().dofs), count);
  EXPECT_EQ(modes.problem, "");
  std::vector<double> list;
  for (Index i = 0; i < count; ++i) list.push_back(modes.frequencies[i] / (2 * pi));
  return list;
}

void expect_all(const std::vector<double>& found, const std::vector<double>& wanted, double tolerance) {
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found.at(i), wanted[i], tolerance) << i;
}

/// Euler's cases, and results of an independent program with the same elements; the error is of fourth order
/// in the mesh size.
TEST(Buckling, HappensAtEulersLoads) {
  const struct {
    std::string first, last;
    double exact, of_eight;
  } cases[] = {{kPinned, kPinned, 242.2365365648, 242.244474},
               {kClamped, kFree, 60.5591341412, 60.559259},
               {kClamped, kPinned, 495.5550351836, 495.622265},
               {kClamped, kClamped, 968.9461462594, 969.442383}};
  for (const auto& one : cases) {
    // Printed with six decimals.
    EXPECT_NEAR(critical_load(8, one.first, one.last), one.of_eight, 6e-7);
    const double coarse = critical_load(8, one.first, one.last) - one.exact;
    const double fine = critical_load(16, one.first, one.last) - one.exact;
    EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.05);
    EXPECT_NEAR(critical_load(128, one.first, one.last), one.exact, 1e-7 * one.exact);
  }
  auto tied = read_scene(bar("5.0", 8, kPinned, kPinned));
  EXPECT_TRUE(std::isinf(dynamics::critical_preload_factor(tied.model)));
  EXPECT_EQ(tied.model.elements.front()->preload(), std::vector<double>(8, 5.0));
}

TEST(Buckling, IsRefusedWithTheCriticalLoad) {
  const auto says = [](const std::string& scene) -> std::string {
    try {
      read_scene(scene);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const std::string message = says(bar("-300.0", 8, kPinned, kPinned));
  EXPECT_NE(message.find("element[0].preload: buckles the structure: its compression of 300 N is beyond the critical "
                         "load of 242.244"),
            std::string::npos)
      << message;
  EXPECT_EQ(says(bar("-240.0", 8, kPinned, kPinned)), "");
  EXPECT_EQ(says(bar("-300.0", 8, kPinned, kPinned) +
                 "[[contact]]\ntype = \"stop\"\nnodes = \"bar:all\"\ngap = 0.01\nstiffness = 1e6\n"),
            "");
}

/// Published frequencies of SDLL101, and those of the clamped bar from the exact equation.
TEST(TiedBar, HasThePublishedFrequencies) {
  constexpr double kPrinted = 6e-5;
  // Published with 4 decimals; with 80 elements the third is accurate to 1e-5 Hz.
  expect_all(frequencies(bar("0.0", 80, kPinned, kPinned), 5), {4.9713, 19.8851, 44.7414, 79.5403, 124.2818}, 7e-4);
  expect_all(frequencies(bar("10.0", 80, kPinned, kPinned), 3), {5.0728, 19.9874, 44.8439}, kPrinted);
  expect_all(frequencies(bar("100.0", 80, kPinned, kPinned), 3), {5.909, 20.886, 45.7561}, kPrinted);
  expect_all(frequencies(bar("1000.0", 80, kPinned, kPinned), 3), {11.2577, 28.3462, 54.037}, kPrinted);
  expect_all(frequencies(bar("-100.0", 160, kPinned, kPinned), 3), {3.809372, 18.831035, 43.703291}, 3e-6);
  expect_all(frequencies(bar("0.0", 160, kClamped, kClamped), 2), {11.2693173508, 31.0643072263}, 1e-6);
  expect_all(frequencies(bar("1000.0", 160, kClamped, kClamped), 3), {15.8600614868, 37.9105427361, 68.7683562265},
             3e-6);
  expect_all(frequencies(bar("-300.0", 160, kClamped, kClamped), 2), {9.4096011653, 28.6669189405}, 1e-6);
}

/// A string that hangs along x; its bending stiffness is small relative to its weight.
std::string hanging(const std::string& preload, const std::string& more = "") {
  return "schema = 1\n[material.steel]\nyoung_modulus = 2e9\ndensity = 7800.0\npoisson_ratio = "
         "0.3\n[section.round]\nshape = "
         "\"circle\"\nradius = 0.002\n[integrator]\ntype = \"newmark\"\ntime_step = 1e-4\nend_time = 1e-3\n"
         "[[element]]\ntype = \"beam\"\nname = \"string\"\nmotion = \"spatial\"\nmaterial = \"steel\"\nsection = "
         "\"round\"\nlength = 50.0\npreload = " +
         preload + "\nelements = 200\n[[support]]\nnodes = \"string:first\"\nfix = [\"ux\", \"uy\", \"uz\", \"rx\"]\n" +
         more;
}

const std::string kWeight = "[gravity]\nacceleration = [9.81, 0.0, 0.0]\n";

/// The tension equals the weight below each part, and the frequencies are those of a hanging chain, j_(0,n)
/// sqrt(g/L)/2.
TEST(Gravity, TightensWhatHangs) {
  SceneRun run(hanging("\"gravity\"", kWeight));
  const auto tension = run.model().elements.front()->preload();
  const double weight = 7800.0 * pi * 4e-6 * 9.81;
  for (std::size_t i = 0; i < tension.size(); ++i)
    EXPECT_NEAR(tension[i], weight * (50.0 - 0.25 * (static_cast<double>(i) + 0.5)), 1e-8 * weight * 50.0) << i;
  const auto modes = dynamics::find_modes(dynamics::Structure(run.model(), run.system().dofs), 6);
  const double zeros[] = {2.404825557695773, 5.520078110286311, 8.653727912911013};
  for (Index i = 0; i < 3; ++i) {
    // Bending slightly stiffens the lowest part: E I/(T l^2) is about 1e-5. Both planes are equal.
    const double chain = 0.5 * zeros[i] * std::sqrt(9.81 / 50.0);
    EXPECT_NEAR(modes.frequencies[2 * i], chain, 3e-3 * chain) << i;
    EXPECT_NEAR(modes.frequencies[2 * i + 1], modes.frequencies[2 * i], 1e-6 * chain) << i;
  }
}

TEST(Gravity, IsRefusedWhereThereIsNone) {
  const auto says = [](const std::string& scene) -> std::string {
    try {
      read_scene(scene);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_NE(says(hanging("\"gravity\"")).find("is \"gravity\", but there is none: give [gravity]"), std::string::npos);
  EXPECT_NE(says(hanging("\"weight\"", kWeight)).find("must be a number or \"gravity\""), std::string::npos);
  std::string lateral = hanging("\"gravity\"", kWeight);
  lateral.replace(lateral.find("spatial"), 7, "lateral");
  EXPECT_NE(says(lateral).find("write motion = \"spatial\", or give the axial force"), std::string::npos);
  std::string loose = hanging("\"gravity\"", kWeight);
  loose.replace(loose.find("\"ux\", "), 6, "");
  EXPECT_NE(says(loose).find("nothing holds"), std::string::npos);
}

/// A preload of 1.5 times the critical one buckles the beam under its weight; it rests on its stops, also if the search
/// for that position begins with the straight beam.
TEST(BuckledBeam, RestsOnItsStops) {
  const std::string beam =
      "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7800.0\n[section.r]\nshape = \"rectangle\"\nwidth = "
      "0.02\nheight = 0.02\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"r\"\nlength = "
      "1.0\nelements = 16\npreload = -39478.4176\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = "
      "[\"u\"]\n[gravity]\nacceleration = [0.0, -9.81, 0.0]\nstatic = true\n[integrator]\nend_time = 0.2\n";
  const std::string scene =
      beam + "[[contact]]\ntype = \"stop\"\nnodes = \"b:4..12\"\ngap = 0.005\nlaw = \"linear\"\nstiffness = 1e7\n";
  SceneRun straight(scene);
  SceneRun near(scene + "[initial]\ndisplacement = [{ nodes = \"b:4..12\", value = -0.0051 }]\n");
  const Vector &found = straight.system().initial_displacement, &expected = near.system().initial_displacement;
  EXPECT_LT(found[straight.dof("b:8")], -0.005);
  EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm());
  EXPECT_THROW(SceneRun{beam}, InputError);
}

}  // namespace
}  // namespace butee::test::preload_test
