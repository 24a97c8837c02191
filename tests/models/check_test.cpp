#include <cmath>
#include <filesystem>

#include <butee/dynamics/frequencies.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::check_test {
namespace {

void expect_holds(const std::string& text, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
}

Outcome check(const std::string& model, const std::vector<std::string>& more = {}) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"check", model_path(model)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome outcome = run_program(arguments, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(folder.entries().empty());
  return outcome;
}

/// Where a run would be refused, check reports on the scene and then fails with the message of the run.
TEST(Check, FailsWhereARunWouldBeRefused) {
  const TemporaryFolder folder;
  folder.write("scene.toml", R"(schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
dof = "uy"
stiffness = 100.0
[[element]]
type = "spring"
node = "m"
dof = "uz"
stiffness = 120.0
[[contact]]
type = "plane"
nodes = "m"
gap = 0.01
normal = [1.0, 0.0]
stiffness = 1e5
friction = { coefficient = 0.2, stick = "rigid" }
[integrator]
type = "exponential"
end_time = 1.0
)");
  const Outcome checked = run_program({"check", "scene.toml"}, folder.path()),
                run = run_program({"run", "scene.toml"}, folder.path());
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(checked.status, 2);
  expect_holds(checked.output, {"2 free", "method     exponential"});
  const std::string mark = "a run of this scene is refused: ";
  const std::size_t place = checked.errors.find(mark);
  ASSERT_NE(place, std::string::npos) << checked.errors;
  EXPECT_EQ(checked.errors.substr(place + mark.size()), run.errors);
}

/// A mass on 100 N/m with three contacts, of which two are no elastic stops.
TEST(Check, KnowsStopsWithDissipationAndPlanes) {
  const TemporaryFolder folder;
  folder.write("scene.toml", mass_on_spring("100.0", R"([[element]]
type = "spring"
node = "m"
dof = "uz"
stiffness = 100.0
[[contact]]
type = "stop"
nodes = "m"
gap = 0.03
stiffness = 300.0
[[contact]]
type = "stop"
nodes = "m"
gap = 0.01
stiffness = 400.0
sides = "negative"
damping = { type = "kelvin_voigt", coefficient = 1.0 }
[[contact]]
type = "plane"
nodes = "m"
gap = 0.02
normal = [0.0, 1.0]
stiffness = 900.0
[[load]]
type = "constant"
node = "m"
value = -5.0
)"));
  const Outcome outcome = run_program({"check", "scene.toml"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  expect_holds(outcome.output,
               {"gap 0.03 m, 300 N/m", "gap 0.01 m, 400 N/m, with dissipation", "plane, gap 0.02 m, 900 N/m",
                "3 ... 9 times that of the structure", "about 0.10472 s or longer",
                "static displacement at a stop under", "is 0.05 m; the smallest gap is 0.01 m"});
  expect_holds(outcome.errors, {"2 stops have a gap below the static deflection"});
}

/// Bearing with cross terms: K = (100, 60; -60, 100), so that u of the ring is K^-1 (5, 0).
TEST(Check, TakesStiffnessThatIsNotSymmetricAsItIs) {
  const TemporaryFolder folder;
  folder.write("scene.toml", R"(schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "bearing"
node = "m"
stiffness = [[100.0, 60.0], [-60.0, 100.0]]
damping = [[10.0, 0.0], [0.0, 10.0]]
[[contact]]
type = "ring"
nodes = "m"
gap = 0.01
stiffness = 272.0
[[load]]
type = "harmonic"
node = "m"
amplitude = 5.0
angular_frequency = 3.0
[integrator]
type = "rodas4"
end_time = 1.0
)");
  const Outcome outcome = run_program({"check", "scene.toml"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  // 5/sqrt(100^2 + 60^2), and 272 times 100/(100^2 + 60^2).
  expect_holds(outcome.output, {"0.0428746 m; the smallest gap is 0.01 m", "of a closed stop: 2 times"});
}

/// One step of piecewise would hold 9e8 rows; the trial ends after a second. Without the limit of steps it writes 100
/// GB.
TEST(Check, EndsItsTrialAmongCountlessRows) {
  const auto probe = [](const std::string& label) {
    return "[[output.probe]]\nlabel = \"" + label +
           "\"\nnode = \"m\"\nquantities = [\"u\", \"v\", \"a\", \"contact_force\", \"spring_force\"]\n";
  };
  const TemporaryFolder folder;
  folder.write("scene.toml",
               mass_on_spring("100.0",
                              "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 2.0\nstiffness = 1e4\n"
                              "[initial]\nvelocity = [{nodes = \"m\", value = 1.0}]\n[output]\ninterval = "
                              "1e-9\n" +
                                  probe("a") + probe("b") + probe("c")));
  const std::vector<std::string> set = {"scene.toml", "--set", "integrator.type=auto", "--set",
                                        "integrator.end_time=0.9"};
  const auto program = [&](const std::string& command) {
    std::vector<std::string> arguments = {command};
    arguments.insert(arguments.end(), set.begin(), set.end());
    return run_program(arguments, folder.path());
  };
  const Outcome outcome = program("check");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  expect_holds(outcome.output, {"results    9e+08 rows"});
  // At least 100 GB, which few disks of test machines have left.
  if (static_cast<double>(std::filesystem::space(folder.path()).available) > 100e9) return;
  expect_holds(outcome.errors, {"the results need about", "GB are free in this folder"});
  const Outcome run = program("run");
  EXPECT_EQ(run.status, 2);
  expect_holds(run.errors, {"output.interval = 1e-09: history.csv would have 9e+08 rows", "GB are free in"});
  EXPECT_FALSE(std::filesystem::exists(folder.file("scene-results")));
}

TEST(Check, FindsTheFrequenciesOfTheOscillator) {
  // sqrt(1e9/100) and sqrt(1.1e10/100) rad/s.
  const Outcome outcome = check("oscillator");
  expect_holds(outcome.output, {"1 free", "stops open:   3162.28", "stops closed: 10488.1", "0.000269673 s"});
  expect_holds(outcome.errors, {"14.4745 N", "jumps by 28.9489 N at u = 0", "rounding decides the direction"});
}

TEST(Check, SaysWhatTheBeamHoldsAndSkips) {
  const Outcome outcome = check("beam1");
  expect_holds(outcome.output, {"35 nodes", "68 free, 2 fixed", "33 on free DOFs", "2 stops whose ends are all fixed",
                                "1.47255 ... 8658.21 rad/s", "0.000326675 s"});
  expect_holds(outcome.errors, {"0.00144745 N", "of the gap"});
}

TEST(Check, ListsAllThatARunSkips) {
  const std::vector<std::string> never = {"loads: nothing drives", "no stops", "C is zero"};
  const std::vector<std::string> unasked = {"the energy balance", "the list of impacts",
                                            " modules of other methods: they are not loaded"};
  const TemporaryFolder folder;
  folder.write("swing.toml",
               "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 2.0\n[[element]]\ntype = "
               "\"spring\"\nnode = \"ball\"\nstiffness = 200.0\n[integrator]\ntype = \"rk4\"\ntime_step = 1e-3\n"
               "end_time = 0.5\n[output]\nenergy = false\nimpacts = false\n");
  const std::string least = run_program({"check", "swing.toml"}, folder.path()).output;
  expect_holds(least, never);
  expect_holds(least, unasked);

  folder.write("zero.toml",
               read_file(folder.file("swing.toml")) + "[[load]]\ntype = \"constant\"\nnode = \"ball\"\nvalue = 0.0\n");
  expect_holds(run_program({"check", "zero.toml"}, folder.path()).output, {"1 loads that are zero at all times"});

  const std::string beam = check("beam1", {"--set", "output.energy=true", "--set", "output.impacts=true"}).output;
  expect_holds(beam, {"a damping matrix: C is Rayleigh's", "2 stops whose ends are all fixed", unasked.back()});
  for (const std::string& part : {never[0], never[1], never[2], unasked[0], unasked[1]})
    EXPECT_EQ(beam.find(part), std::string::npos) << part;
}

TEST(Check, SaysWhichModesAreDamped) {
  expect_holds(check("beam1", {"--set", "damping={modal=0.02}"}).output, {"modal: the ratio 0.02 in all 68 modes"});
  const Outcome list = check("beam1", {"--set", "damping={modal=[0.02, 0.01]}"});
  // The pinned beam's second frequency is 4 times its first.
  expect_holds(list.output, {"modal: ratios in the 2 lowest modes, none in the 66 above", "0.02 at 1.47255 rad/s",
                             "0.01 at 5.8902"});
  EXPECT_EQ(list.output.find("C is"), std::string::npos);
  expect_holds(check("beam1", {"--set", "damping={modal=2}"}).errors, {"more than critical", "2 % are written 0.02"});
  expect_holds(check("beam1", {"--set", "damping={modal=[0.02, 1.5]}"}).errors,
               {"the ratio 1.5 of mode 2 is more than"});
  expect_holds(check("beam1", {"--set", "damping={}"}).output, {"damping: C is zero"});
}

TEST(Check, WarnsOfAStepBeyondTheCriticalOne) {
  const Outcome large = check("beam1", {"--set", "integrator.type=rk4", "--set", "integrator.time_step=4e-4"});
  expect_holds(large.errors, {"larger than the critical step of rk4, 0.000326675 s"});
  const Outcome small = check("beam1", {"--set", "integrator.type=rk4"});
  EXPECT_EQ(small.errors.find("critical step"), std::string::npos);
  expect_holds(small.output, {"below its critical step by a factor of 32.6675"});
}

/// A pinned steel bar of 0.1 m x 0.2 m, its elements 25 mm long.
dynamics::FrequencyRange range_of_bar(int elements) {
  SceneRun run(
      "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 8000\n[section.r]\nshape = \"rectangle\"\nwidth = "
      "0.1\n"
      "height = 0.2\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"r\"\nlength = " +
      std::to_string(0.025 * elements) + "\nelements = " + std::to_string(elements) +
      "\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n"
      "[integrator]\ntype = \"rk4\"\ntime_step = 1e-6\nend_time = 1e-5\n");
  return dynamics::frequency_range(run.system(), dynamics::StopState::open).value();
}

/// The lowest frequency of a fine mesh is far below the rounding of the highest, but no rigid motion.
TEST(Check, KnowsTheLowestFrequencyOfAFineMesh) {
  const TemporaryFolder folder;
  const std::string scene =
      "schema = 1\n[material.s]\nyoung_modulus = 2.1e11\ndensity = 7850.0\n[section.c]\nshape = \"circle\"\nradius = "
      "0.02\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = "
      "4.0\nelements = 1000\n";
  const std::string rest =
      "[[contact]]\ntype = \"stop\"\nnodes = \"b:middle\"\ngap = 1e-3\nstiffness = 1e7\n[integrator]\nend_time = 0.1\n";
  folder.write("held.toml", scene + "[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n" + rest);
  folder.write("free.toml", scene + rest);
  const Outcome held = run_program({"check", folder.file("held.toml")}, folder.path());
  const double lowest = std::sqrt(2.1e11 * 0.02 * 0.02 / 4.0 / 7850.0) * std::pow(3.141592653589793 / 4.0, 2);
  expect_holds(held.output, {"all stops open:   " + to_short_text(lowest) + " ..."});
  EXPECT_EQ(held.output.find("free  "), std::string::npos) << held.output;
  const Outcome free = run_program({"check", folder.file("free.toml")}, folder.path());
  expect_holds(free.output, {"all stops open:   0 ...", "free  "});
}

TEST(Check, LargeSystemsGoThroughLanczosWithTheSameAnswer) {
  constexpr double kPi = 3.141592653589793;
  // Lanczos computes the eigenvector to 1e-4, hence the eigenvalue to 1e-8; the mesh error is smaller.
  constexpr double kLowest = 1e-6;
  // The shortest wave of an even mesh hardly depends on the ends, so that 60 elements (dense) give the value
  // of 400 (Lanczos).
  constexpr double kHighest = 1e-3;
  const auto large = range_of_bar(400), small = range_of_bar(60);
  const double exact = kPi * kPi * std::sqrt(2e11 * 0.2 * 0.2 / 12.0 / 8000.0) / 100.0;
  EXPECT_NEAR(large.lowest, exact, kLowest * exact);
  EXPECT_NEAR(large.highest, small.highest, kHighest * small.highest);
}

}  // namespace
}  // namespace butee::test::check_test
