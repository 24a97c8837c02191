// The method exponential against solutions in 80-bit arithmetic that share no code with it
// (tests/benchmark/plain/reference.cpp), and against the method `exact` if no such solution is stored.
#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::exponential_test {
namespace {

struct Case {
  std::string scene, node;
  double end_time;
  /// The factor by which the scene amplifies a perturbation in the last digits, as measured by `butee run
  /// --trust`, rounded up to 1, 3, 10, ...
  double amplification;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.scene;
}

struct Result {
  double error;
  std::int64_t steps;
};

class ExponentialMethod : public testing::TestWithParam<Case> {
 protected:
  Result run(double tolerance) const {
    const Case& c = GetParam();
    const CsvTable table(std::string(BUTEE_TEST_DATA) + "/models/reference/" + c.scene + "-linear.csv");
    std::vector<double> times = table.column("t"), u = table.column("u0");
    const auto rows = std::upper_bound(times.begin(), times.end(), c.end_time * (1.0 + 1e-9)) - times.begin();
    times.resize(static_cast<std::size_t>(rows));
    u.resize(times.size());
    SceneRun scene(with_linear_law(c.scene),
                   {"integrator.type=exponential", "integrator.end_time=" + std::to_string(c.end_time),
                    "integrator.tolerance=" + std::to_string(tolerance * 1e9) + "e-9"});
    Sampler sampler(scene.dof(c.node), times);
    scene.simulation().add(sampler);
    const time::RunReport& report = scene.run();
    EXPECT_TRUE(report.completed) << report.message;
    return {relative_rms(sampler.x, u), report.steps};
  }
};

TEST_P(ExponentialMethod, KeepsItsTolerance) {
  // The estimate is local; the scene amplifies errors made earlier.
  constexpr double kReserve = 10.0;
  std::vector<double> decades, errors;
  for (double tolerance = 1e-2; tolerance > 0.9e-7; tolerance *= 0.1) {
    // The choice of steps is partly random, so the mean of three runs is taken.
    double mean = 0.0;
    for (const double factor : {0.8, 1.0, 1.25}) {
      const double error = run(factor * tolerance).error;
      EXPECT_LE(error, kReserve * factor * tolerance * GetParam().amplification) << "at " << factor * tolerance;
      mean += std::log10(error) / 3.0;
    }
    decades.push_back(std::log10(tolerance));
    errors.push_back(mean);
  }
  ASSERT_EQ(decades.size(), 6U);
  double slope = 0.0;
  for (std::size_t i = 0; i < 6; ++i) slope += (decades[i] + 4.5) * errors[i] / 17.5;
  // Below 1e-4 the deviation in the middle of a step is kept in proportion to the tolerance, and the error of
  // smooth motion decreases with its power 3/2.
  EXPECT_GE(slope, 0.8);
  EXPECT_LE(slope, 1.6);
}

TEST_P(ExponentialMethod, GivesTheSameWhereEveryStepIsWatched) {
  const auto end = [&](bool watched) {
    SceneRun scene(with_linear_law(GetParam().scene), {"integrator.type=exponential"});
    record::EnergyRecorder energy(scene.dynamics());
    if (watched) scene.simulation().add(energy);
    EXPECT_TRUE(scene.run().completed);
    return std::pair(scene.simulation().state().x, scene.simulation().report().steps);
  };
  const auto together = end(false), single = end(true);
  EXPECT_TRUE(together.first == single.first);
  EXPECT_EQ(together.second, single.second);
}

INSTANTIATE_TEST_SUITE_P(LinearLaw, ExponentialMethod,
                         testing::Values(Case{"oscillator", "rotor", 0.1, 10.0},
                                         Case{"beam1", "string:middle", 1.0, 1.0},
                                         Case{"beam2", "string:middle", 1.0, 3.0},
                                         Case{"beam3", "string:middle", 1.0, 3.0},
                                         Case{"beam4", "string:middle", 0.3, 10.0}),
                         [](const auto& one) { return one.param.scene; });

TEST(Exponential, TakesFewSteps) {
  // It takes 220 steps at 1e-3 for 56 contact changes, half of them for the velocities of rotations; Newmark needs
  // thousands. The bound detects a loss of this efficiency.
  SceneRun scene(with_linear_law("beam1"), {"integrator.type=exponential", "integrator.tolerance=1e-3"});
  ASSERT_TRUE(scene.run().completed);
  EXPECT_LT(scene.simulation().report().steps, 300);
}

/// An observer that keeps the end states of a macro step can interpolate in it after the method has moved on.
TEST(Exponential, InterpolatesAnEarlierBlockAsItDidThen) {
  class Keeper final : public time::Observer {
   public:
    void start(const time::State&) override {}
    void step(const time::AcceptedStep& step) override { blocks.push_back({step.from, step.to, inside(step.motion)}); }
    static double inside(const time::DenseOutput& motion) {
      const double begin = motion.from().t, h = motion.to().t - begin;
      const std::vector<double> times = {begin + 0.37 * h, begin + 0.99 * h};
      const std::vector<Index> dofs = {0};
      std::vector<double> x(2);
      motion.interpolate(times, dofs, {x, {}, {}});
      return x[0] + 3.0 * x[1];
    }
    struct Block {
      time::State from, to;
      double inside;
    };
    std::vector<Block> blocks;
  };
  for (const char* model : {"oscillator", "beam2"})
    for (const char* tolerance : {"1e-2", "1e-5"}) {
      SceneRun scene(with_linear_law(model), {"integrator.type=exponential", "integrator.end_time=0.1",
                                              std::string("integrator.tolerance=") + tolerance});
      Keeper keeper;
      scene.simulation().add(keeper);
      ASSERT_TRUE(scene.run().completed);
      EXPECT_GE(keeper.blocks.size(), 2U);
      for (const Keeper::Block& block : keeper.blocks)
        EXPECT_EQ(Keeper::inside(scene.integrator().dense_output(block.from, block.to)), block.inside)
            << model << block.from.t;
    }
}

std::string frame(const std::string& damping, const std::string& rest) {
  return "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\nradius = "
         "0.02\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 4.0\nelements "
         "= 9\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n"
         "[[load]]\ntype = \"harmonic\"\nnode = \"b:4\"\namplitude = 500.0\nangular_frequency = 60.0\nphase = 0.4\n"
         "[[load]]\ntype = \"table\"\nnode = \"b:7\"\ntimes = [0.0, 0.013, 0.05]\nvalues = [0.0, 300.0, -100.0]\n" +
         damping + "[initial]\nvelocity = [{nodes = \"b:2..5\", value = 0.8}]\n" + rest;
}

TEST(Exponential, WithoutStopsGoesFromOutputToOutputWithoutError) {
  const std::string integrator = "[integrator]\ntype = \"exponential\"\nend_time = 0.1\n[output]\ninterval = 1e-2\n";
  for (const std::string damping : {"", "[damping]\nmass_proportional = 2.0\nstiffness_proportional = 1e-4\n",
                                    "[damping]\nmodal = 0.03\n", "[damping]\nmodal = [0.5, 0.1]\n"}) {
    std::vector<double> times;
    for (int i = 0; i <= 10; ++i) times.push_back(0.01 * i);
    const auto sample = [&](const std::string& method) {
      std::vector<std::string> overrides = {"integrator.type=" + method};
      if (method == "exact") overrides.emplace_back("integrator.time_step=1e-5");
      SceneRun scene(frame(damping, integrator), overrides);
      Sampler sampler(scene.dof("b:3"), times);
      scene.simulation().add(sampler);
      EXPECT_TRUE(scene.run().completed);
      EXPECT_EQ(scene.dynamics().counters().contact_evaluations, 0);
      return std::pair(sampler.x, scene.simulation().report().steps);
    };
    const auto [x, steps] = sample("exponential");
    const auto [reference, many] = sample("exact");
    // Rounding of the modes, relative to the highest mode.
    constexpr double kRounding = 1e-10;
    EXPECT_LE(relative_rms(x, reference), kRounding) << damping;
    EXPECT_LE(steps, 14);  // ten outputs and the discontinuities of the load
  }
}

std::string oscillator(const std::string& stops) {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
         "\"m\"\nstiffness = 50.0\n[damping]\nmass_proportional = 0.3\n[[load]]\ntype = \"harmonic\"\nnode = "
         "\"m\"\namplitude = 20.0\nangular_frequency = 4.3\nphase = 0.2\n[initial]\nvelocity = [{nodes = \"m\", value "
         "= "
         "1.0}]\n" +
         stops + "[integrator]\ntype = \"exponential\"\ntolerance = 1e-4\nend_time = 6.0\n";
}

TEST(Exponential, InPlainNumbersIsTheSameAsInVectors) {
  const auto stop = [](const std::string& sides) {
    return "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.2\nlaw = \"linear\"\nstiffness = 5e3\nsides = \"" +
           sides + "\"\n";
  };
  std::vector<double> times;
  for (int i = 0; i <= 60; ++i) times.push_back(0.1 * i);
  const auto sample = [&](const std::string& stops) {
    SceneRun run(oscillator(stops));
    Sampler sampler(run.dof("m"), times);
    run.simulation().add(sampler);
    EXPECT_TRUE(run.run().completed);
    return std::pair(sampler.x, run.simulation().report().steps);
  };
  // A single two-sided stop takes the scalar code path; two equivalent one-sided stops do not.
  const auto [x, steps] = sample(stop("both"));
  const auto [same, as_many] = sample(stop("positive") + stop("negative"));
  // The two code paths bound free flights differently, so their steps differ; errors stay within the
  // guaranteed ten tolerances of 1e-4.
  EXPECT_LE(relative_rms(x, same), 1e-3);
  EXPECT_NEAR(static_cast<double>(steps), static_cast<double>(as_many), 0.2 * static_cast<double>(steps));
  EXPECT_GT(steps, 100);
}

/// Relative rms error of one driven mass: `exponential` against `exact`, with 40 outputs in a natural period.
double error_of_driven_mass(double stop_stiffness, double gap, double tuning, double damping_ratio,
                            const std::string& tolerance) {
  constexpr double kStiffness = 1e4, kFrequency = 100.0, kPi = 3.141592653589793;  // for a mass of 1 kg
  const auto line = [](const char* key, double value) { return std::string(key) + " = " + to_text(value) + "\n"; };
  const std::string text =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n" +
      std::string("[[element]]\ntype = \"spring\"\nnode = \"m\"\n") + line("stiffness", kStiffness) +
      line("damping", 2.0 * damping_ratio * kFrequency) +
      "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\nlaw = \"linear\"\n" + line("gap", gap) +
      line("stiffness", stop_stiffness) + "[[load]]\ntype = \"harmonic\"\nnode = \"m\"\namplitude = 20.0\n" +
      line("angular_frequency", tuning * kFrequency) + "[integrator]\n" + line("end_time", 12.0 * kPi / kFrequency);
  std::vector<double> times;
  for (int i = 1; i <= 240; ++i) times.push_back(i * 2.0 * kPi / kFrequency / 40.0);
  times.pop_back();
  const auto course = [&](const std::string& keys) {
    SceneRun scene(text + keys);
    Sampler sampler(scene.dof("m"), times);
    scene.simulation().add(sampler);
    EXPECT_TRUE(scene.run().completed) << scene.simulation().report().message;
    return sampler.x;
  };
  return relative_rms(course("type = \"exponential\"\ntolerance = " + tolerance + "\n"),
                      course("type = \"exact\"\ntime_step = 1e-3\n"));
}

/// The shortest impact lasts 3e-7 s, a millionth of a period; the mass moves only 1e-8 m in it. A step
/// control based on displacements alone would step over it.
TEST(Exponential, GetsTheSpeedRightAfterShortImpacts) {
  // At 1e14 N/m the penetration retains few digits relative to the gap: two builds gave 1.5e-3 and 3.3e-3.
  for (const auto& [stiffness, bound] :
       {std::pair{1e8, 1e-3}, std::pair{1e10, 1e-3}, std::pair{1e12, 1e-3}, std::pair{1e14, 1e-2}})
    EXPECT_LT(error_of_driven_mass(stiffness, 1e-3, 0.7, 0.02, "1e-4"), bound) << stiffness;
}

/// With a soft stop that is never reached, steps may be arbitrarily long; outputs within them must still be
/// accurate.
TEST(Exponential, KeepsItsToleranceBetweenStepsWithoutContact) {
  for (const double tuning : {0.1, 1.9, 5.0})
    for (const double damping_ratio : {0.0, 0.9, 3.0})
      EXPECT_LT(error_of_driven_mass(1e2, 1.0, tuning, damping_ratio, "1e-5"), 1e-5) << tuning << " " << damping_ratio;
}

TEST(Exponential, WithTheLowestModesComesCloserTheMoreThereAreAndSaysWhatIsLeftOut) {
  const std::string stops =
                        "[[contact]]\ntype = \"stop\"\nnodes = \"b:3..6\"\ngap = 2e-3\nlaw = \"linear\"\nstiffness "
                        "= 2e5\n",
                    rest = "[integrator]\ntype = \"exponential\"\nend_time = 0.1\n";
  std::string scene = frame("", stops + rest);
  scene.erase(scene.find("[initial]"), scene.find("[[contact]]") - scene.find("[initial]"));
  std::vector<double> times;
  for (int i = 0; i <= 50; ++i) times.push_back(0.002 * i);
  const auto sample = [&](int modes, std::string* choice = nullptr) {
    SceneRun run(scene, {"integrator.modes=" + std::to_string(modes)});
    if (choice != nullptr) *choice = run.integrator().choice();
    Sampler sampler(run.dof("b:4"), times);
    run.simulation().add(sampler);
    EXPECT_TRUE(run.run().completed);
    return sampler.x;
  };
  std::string all, few;
  const std::vector<double> full = sample(0, &all);
  EXPECT_TRUE(all.empty()) << all;
  const double with_two = relative_rms(sample(2, &few), full), with_ten = relative_rms(sample(10), full);
  EXPECT_NE(few.find("lowest 2 of 18 modes and 5 static shapes"), std::string::npos) << few;
  EXPECT_NE(few.find(" % of the static displacement at a stop or load"), std::string::npos) << few;
  // Two modes alone, without the static shapes of the others, give an error of one half; with them, the
  // neglected inertia of the other modes remains.
  EXPECT_LT(with_two, 0.02);
  EXPECT_GT(with_two, 1e-3);
  EXPECT_LT(with_ten, 0.1 * with_two);
}

TEST(Exponential, RefusesLoadsOfWhichItKnowsTooLittle) {
  // A support that moves along a spline, with a dashpot that couples the modes.
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"g\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
      "\"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = \"b\"\nmass = 2.0\n[[element]]\ntype = "
      "\"spring\"\nnodes = "
      "[\"g\", \"a\"]\nstiffness = 1e3\ndamping = 5.0\n[[element]]\ntype = \"spring\"\nnodes = [\"a\", "
      "\"b\"]\nstiffness = "
      "10.0\n[[support]]\nnodes = [\"g\"]\nfix = [\"u\"]\n[[base]]\nnodes = [\"g\"]\ndisplacement = { direction = [0, "
      "1, "
      "0], type = \"table\", times = [0.0, 0.1, 0.2, 0.3], values = [0.0, 1e-3, 3e-3, 2e-3] }\n[integrator]\ntype = "
      "\"exponential\"\nend_time = 0.1\n";
  try {
    SceneRun run(scene);
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rodas4"), std::string::npos) << error.what();
  }
}

/// A sharp one-sided stop between two masses that start at rest in the middle of its gap: its residual force does not
/// jump there, unlike that of a stop with two sides. (Refused its first step before.)
TEST(Exponential, StartsAtTheMiddleOfAOneSidedStop) {
  const std::string scene = R"(
schema = 1
[[element]]
type = "mass"
name = "m0"
mass = 1415.0
[[element]]
type = "mass"
name = "m1"
mass = 2936.0
[[element]]
type = "spring"
node = "m0"
stiffness = 4.657e6
[[element]]
type = "spring"
nodes = ["m0", "m1"]
stiffness = 2.463e6
[[contact]]
type = "stop"
between = ["m0", "m1"]
sides = "negative"
gap = 0.0017
stiffness = 4.1e9
law = "arctan"
regularization = 1.8e12
[[load]]
node = "m1"
type = "harmonic"
amplitude = 64200.0
angular_frequency = 9.7
[integrator]
type = "exponential"
tolerance = 1e-5
end_time = 0.3
)";
  const auto motion = [&](const std::string& method) {
    SceneRun run(scene, {"integrator.type=" + method});
    Sampler sampler(run.dof("m1"), {0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3});
    run.simulation().add(sampler);
    EXPECT_TRUE(run.run().completed) << run.simulation().report().message;
    return sampler.x;
  };
  EXPECT_LT(relative_rms(motion("exponential"), motion("exact")), 1e-4);
}

}  // namespace
}  // namespace butee::test::exponential_test
