#include <cmath>
#include <complex>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::modes_command_test {
namespace {

using Json = nlohmann::json;
using std::numbers::pi;

/// Error of the mesh of 34 elements, (beta l)^4/1440 or less.
constexpr double kMesh = 1e-5;
/// Error of an effective mass on that mesh.
constexpr double kMassOfMesh = 1e-4;

class ModesCommand : public testing::Test {
 protected:
  Outcome run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "modes");
    return run_program(arguments, folder_.path());
  }
  Json json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const Outcome outcome = run(std::move(arguments));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return Json::parse(outcome.output);
  }
  TemporaryFolder folder_;
};

TEST_F(ModesCommand, PinnedBeamHasItsFrequenciesRatiosAndEffectiveMasses) {
  const Json found = json({model_path("beam1"), "-n", "5"});
  ASSERT_EQ(found["modes"].size(), 5U);
  const double bending = 2.03e11 * pi / 4.0 * (std::pow(0.06, 4) - std::pow(0.04, 4));
  const double mass = 7900.0 * pi * (0.06 * 0.06 - 0.04 * 0.04);
  EXPECT_NEAR(found["total_mass"].get<double>(), 35.0 * mass, 1e-9 * 35.0 * mass);
  for (int i = 1; i <= 5; ++i) {
    const Json& mode = found["modes"][static_cast<std::size_t>(i - 1)];
    const double omega = std::pow(i * pi / 35.0, 2) * std::sqrt(bending / mass);
    EXPECT_NEAR(mode["angular_frequency"].get<double>() / omega, 1.0, 10.0 * kMesh) << i;
    EXPECT_NEAR(mode["frequency"].get<double>(), mode["angular_frequency"].get<double>() / (2.0 * pi), 1e-12);
    EXPECT_NEAR(mode["damping"].get<double>() / (0.03 / (2.0 * omega)), 1.0, 10.0 * kMesh) << i;
    // A half sine of i waves has the effective mass fraction 8/(i pi)^2 for odd i, and 0 for even i.
    EXPECT_NEAR(mode["effective_part"].get<double>(), i % 2 == 1 ? 8.0 / (i * i * pi * pi) : 0.0, kMassOfMesh) << i;
    EXPECT_FALSE(mode["rigid"].get<bool>());
    EXPECT_LT(mode["residual"].get<double>(), 1e-9);
  }
}

/// Gyroscopic moments bring the frequency of a whirl, which starts at 100 rad/s, to that of a mode of 110 rad/s; an
/// antisymmetric stiffness couples both, so that motion grows from 17.2538314 to 20.8673208 rad/s (eigenvalues of the
/// first-order system by LAPACK). The speeds of the diagram lie around that.
TEST_F(ModesCommand, FindsAWindowOfInstabilityBetweenFewSpeeds) {
  const std::string head = "%%MatrixMarket matrix coordinate real ";
  folder_.write("M.mtx", head + "general\n3 3 3\n1 1 1.0\n2 2 1.0\n3 3 1.0\n");
  folder_.write("C.mtx", head + "general\n3 3 3\n1 1 0.2\n2 2 0.2\n3 3 0.2\n");
  folder_.write("G.mtx", head + "skew-symmetric\n3 3 1\n2 1 -1.0\n");
  folder_.write("K.mtx", head + "general\n3 3 5\n1 1 10000.0\n3 1 -150.0\n2 2 10000.0\n1 3 150.0\n3 3 12100.0\n");
  folder_.write("dofs.txt", "0 uy\n0 uz\n1 uy\n");
  folder_.write("scene.toml",
                "schema = 1\n[[element]]\ntype = \"matrices\"\nname = \"b\"\nmass = \"M.mtx\"\nstiffness = "
                "\"K.mtx\"\ndamping = \"C.mtx\"\ngyroscopic = \"G.mtx\"\ndofs = \"dofs.txt\"\n[rotation]\nspeed = "
                "19.0\n[integrator]\nend_time = 1.0\n");
  for (const char* steps : {"2", "4", "8", "30"}) {
    const Json borders = json({"scene.toml", "--campbell", "0", "200", steps})["stability_borders"];
    ASSERT_EQ(borders.size(), 2U) << steps << borders.dump();
    EXPECT_NEAR(borders[0]["speed"].get<double>(), 17.253831358, 1e-6) << steps;
    EXPECT_NEAR(borders[1]["speed"].get<double>(), 20.867320768, 1e-6) << steps;
  }
}

/// A disc on an isotropic bearing of stiffness k: its unbalance meets the translational modes at
/// sqrt(k/m), whatever the speed.
TEST_F(ModesCommand, TheCampbellDiagramHasTheCriticalSpeedOfADisc) {
  folder_.write("disc.toml", R"(
schema = 1
[integrator]
end_time = 1.0
[[element]]
type = "disc"
name = "d"
mass = 2.0
diametral_inertia = 0.1
polar_inertia = 0.15
[[element]]
type = "bearing"
node = "d"
stiffness = [[800.0, 0.0], [0.0, 800.0]]
[[element]]
type = "spring"
node = "d"
dof = "ry"
stiffness = 1000.0
[[element]]
type = "spring"
node = "d"
dof = "rz"
stiffness = 1000.0
)");
  const Json found = json({"disc.toml", "--campbell", "0", "60", "30"});
  const auto& criticals = found["critical_speeds"];
  ASSERT_FALSE(criticals.empty()) << found.dump();
  bool has_disc = false;
  for (const Json& critical : criticals)
    has_disc = has_disc || std::abs(critical["speed"].get<double>() - 20.0) < 1e-6 * 20.0;
  EXPECT_TRUE(has_disc) << criticals.dump();
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--speed", "nan"},
                                                {"--speed", "inf"},
                                                {"--order", "2"},
                                                {"--campbell", "0", "inf", "4"},
                                                {"--campbell", "0", "nan", "4"},
                                                {"--campbell", "5", "2", "4"},
                                                {"--campbell", "0", "2", "0"}}) {
    std::vector<std::string> arguments = {"disc.toml"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << wrong[1] << outcome.errors;
    EXPECT_NE(outcome.errors.find(wrong[0]), std::string::npos) << outcome.errors;
  }
}

TEST_F(ModesCommand, AllEffectiveMassesTogetherAreTheMassThatCanMove) {
  double sum = 0.0;
  const Json found = json({model_path("beam1"), "-n", "68"});
  for (const Json& mode : found["modes"]) sum += mode["effective_part"].get<double>();
  // The masses at the held ends, less than half an element each, do not count.
  EXPECT_LT(sum, 1.0);
  EXPECT_GT(sum, 1.0 - 1.0 / 34.0);
}

/// m1 = m2 = 1 with springs of 1000, 1000 and 10 N/m and a strong dashpot to ground: the roots of
/// (s^2 + 2 s + 2000)(s^2 + 72 s + 1010) = (2 s + 1000)^2, of which one pair oscillates.
TEST_F(ModesCommand, DampedModesAtRestOfAnyScene) {
  folder_.write("chain.toml",
                "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\n"
                "name = \"b\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 1000.0\n"
                "[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 1000.0\ndamping = 2.0\n"
                "[[element]]\ntype = \"spring\"\nnode = \"b\"\nstiffness = 10.0\ndamping = 70.0\n"
                "[integrator]\nend_time = 1.0\n");
  const Outcome undamped = run({"chain.toml"});
  EXPECT_NE((undamped.output + undamped.errors).find("--speed 0 gives damped modes"), std::string::npos);
  const Json found = json({"chain.toml", "--speed", "0"});
  ASSERT_EQ(found["modes"].size(), 3U);  // two overdamped roots and a pair
  for (const Json& mode : found["modes"]) {
    const std::complex<double> s(mode["growth"].get<double>(), mode["angular_frequency"].get<double>());
    const std::complex<double> left = (s * s + 2.0 * s + 2000.0) * (s * s + 72.0 * s + 1010.0);
    EXPECT_LT(std::abs(left - (2.0 * s + 1000.0) * (2.0 * s + 1000.0)), 1e-9 * std::abs(left));
  }
  EXPECT_EQ(run({"chain.toml", "--speed", "10"}).status, 2);
}

/// A free beam in space has six rigid motions, twelve eigenvalues 0, and no warning of their rounding.
TEST_F(ModesCommand, DampedModesOfAFreeBeamBeginWithItsRigidMotions) {
  folder_.write("free.toml",
                "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7800\npoisson_ratio = 0.3\n[section.c]\n"
                "shape = \"circle\"\nradius = 0.01\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\n"
                "section = \"c\"\nmotion = \"spatial\"\nlength = 1.0\nelements = 8\n[integrator]\nend_time = 1.0\n");
  const Outcome outcome = run({"free.toml", "--speed", "0", "-n", "16"});
  EXPECT_EQ(outcome.errors, "");
  const Json found = json({"free.toml", "--speed", "0", "-n", "16"});
  const double bending = std::pow(4.730040744862704, 2) * std::sqrt(2e11 / 7800.0) * 0.01 / 2.0;
  // If rounding makes a pair of eigenvalues complex, only one of them is listed.
  std::vector<double> elastic;
  for (const Json& mode : found["modes"])
    if (const double omega = mode["angular_frequency"].get<double>(); omega > 0.0) elastic.push_back(omega);
  ASSERT_GE(elastic.size(), 4U);
  EXPECT_LE(elastic.size(), 10U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(elastic[i] / bending, 1.0, 2e-4);
}

TEST_F(ModesCommand, OscillatorWithOpenAndClosedStops) {
  const Json open = json({model_path("oscillator")});
  ASSERT_EQ(open["modes"].size(), 1U);
  EXPECT_NEAR(open["modes"][0]["angular_frequency"].get<double>(), std::sqrt(1e9 / 100.0), 1e-8);
  EXPECT_NEAR(open["modes"][0]["damping"].get<double>(), 50.0 / (2.0 * std::sqrt(1e9 * 100.0)), 1e-15);
  EXPECT_NEAR(open["modes"][0]["effective_part"].get<double>(), 1.0, 1e-12);
  for (const char* which : {"all", "rotor"}) {
    const Json closed = json({model_path("oscillator"), "--closed", which});
    EXPECT_EQ(closed["closed_stops"], 1);
    EXPECT_NEAR(closed["modes"][0]["angular_frequency"].get<double>(), std::sqrt(1.1e10 / 100.0), 1e-8);
    EXPECT_NEAR(closed["modes"][0]["damping"].get<double>(), 50.0 / (2.0 * std::sqrt(1.1e10 * 100.0)), 1e-15);
  }
}

TEST_F(ModesCommand, StopsCloseWhereASelectorSays) {
  const Json some = json({model_path("beam1"), "--closed", "string:3..5", "--closed", "string:9", "-n", "1"});
  EXPECT_EQ(some["closed_stops"], 4);
  const double one = json({model_path("beam1"), "-n", "1"})["modes"][0]["angular_frequency"];
  const double all = json({model_path("beam1"), "--closed", "all", "-n", "1"})["modes"][0]["angular_frequency"];
  EXPECT_GT(some["modes"][0]["angular_frequency"].get<double>(), one);
  EXPECT_LT(some["modes"][0]["angular_frequency"].get<double>(), all);
}

TEST_F(ModesCommand, ModalDampingIsWhatTheSceneSays) {
  const Json every = json({model_path("beam1"), "--set", "damping={modal=0.02}", "-n", "2"});
  EXPECT_NEAR(every["modes"][1]["damping"].get<double>(), 0.02, 1e-15);
  const Json list = json({model_path("beam1"), "--set", "damping={modal=[0.03]}", "-n", "2"});
  EXPECT_NEAR(list["modes"][0]["damping"].get<double>(), 0.03, 1e-15);
  EXPECT_EQ(list["modes"][1]["damping"].get<double>(), 0.0);
  // A stop far too soft to matter: the code path for closed stops must give the same result.
  const Json closed = json({model_path("beam1"), "--set", "damping={modal=[0.03]}", "--set",
                            "contact[0].stiffness=1e-9", "--closed", "all", "-n", "2"});
  EXPECT_NEAR(closed["modes"][0]["damping"].get<double>(), 0.03, 1e-8);
  EXPECT_NEAR(closed["modes"][1]["damping"].get<double>(), 0.0, 1e-8);
}

TEST_F(ModesCommand, WritesFrequenciesAndShapes) {
  ASSERT_EQ(run({model_path("beam1"), "-n", "3", "-o", "out"}).status, 0);
  const CsvTable frequencies(folder_.file("out/frequencies.csv"));
  EXPECT_EQ(frequencies.rows(), 3U);
  const CsvTable shapes(folder_.file("out/shapes.csv"));
  ASSERT_EQ(shapes.rows(), 35U);
  EXPECT_EQ(shapes.text_column("node")[17], "string:17");
  const auto x = shapes.column("coordinate"), u = shapes.column("u2"), theta = shapes.column("theta2");
  // sqrt(2/m) sin(2 pi x/L), up to the mesh error; the sign makes the largest entry positive.
  const double mass = json({model_path("beam1")})["total_mass"].get<double>(), height = std::sqrt(2.0 / mass);
  const double sign = u[5] > 0.0 ? 1.0 : -1.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(sign * u[i], height * std::sin(2.0 * pi * x[i] / 35.0), 1e-4 * height);
    EXPECT_NEAR(sign * theta[i], height * 2.0 * pi / 35.0 * std::cos(2.0 * pi * x[i] / 35.0), 1e-4 * height);
  }
  EXPECT_EQ(run({model_path("beam1"), "-o", "out"}).status, 0);  // own folder, overwritten
}

TEST_F(ModesCommand, DrawsShapesOrSaysWhatIsMissing) {
  const Outcome outcome = run({model_path("beam1"), "-n", "3", "--plot"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(std::filesystem::exists(folder_.file("beam1-modes/modes.gp")));
  const bool drawn = std::filesystem::exists(folder_.file("beam1-modes/modes.svg"));
  EXPECT_EQ(drawn, outcome.errors.find("gnuplot could not draw") == std::string::npos) << outcome.errors;
  if (drawn) {
    EXPECT_NE(read_file(folder_.file("beam1-modes/modes.svg")).find("1: 0.2344 Hz"), std::string::npos);
  }
}

TEST_F(ModesCommand, RefusesWhatItCannotDo) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{model_path("oscillator"), "-n", "2"}, "no more modes than free DOFs: 1"},
      {{model_path("beam1"), "--closed", "string:99"}, "--closed string:99"},
      {{model_path("beam1"), "--closed", "well"}, "--closed well"},
      {{model_path("long-string"), "--closed", "string:7"}, "no stop in one direction acts there"},
      {{model_path("long-string"), "-n", "9000"}, "ask for at most 1000"},
      {{model_path("beam1"), "-n", "0"}, "-n"}};
  for (const auto& [arguments, words] : wrong) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_NE(outcome.errors.find(words), std::string::npos) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
  }
  EXPECT_TRUE(folder_.entries().empty());
  ASSERT_EQ(run_program({"run", model_path("oscillator"), "-o", "results"}, folder_.path()).status, 0);
  EXPECT_EQ(run({model_path("oscillator"), "-o", "results"}).status, 2);
  EXPECT_TRUE(std::filesystem::exists(folder_.file("results/history.csv")));
}

TEST_F(ModesCommand, TakesTheLongString) {
  const Json found = json({model_path("long-string"), "-n", "3"});
  EXPECT_EQ(found["solver"], "lanczos");
  const double ratio =
      found["modes"][1]["angular_frequency"].get<double>() / found["modes"][0]["angular_frequency"].get<double>();
  EXPECT_NEAR(ratio, 4.0, 1e-6);
}

}  // namespace
}  // namespace butee::test::modes_command_test
