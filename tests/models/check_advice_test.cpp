#include <cmath>
#include <random>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::check_advice_test {
namespace {

using Json = nlohmann::json;

Json check(const std::string& model, std::vector<std::string> overrides = {}) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"check", model, "--json"};
  for (std::string& item : overrides) {
    arguments.emplace_back("--set");
    arguments.push_back(std::move(item));
  }
  const Outcome outcome = run_program(arguments, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(folder.entries().empty());
  return Json::parse(outcome.output);
}

/// The text of the advice about a topic, or "".
std::string advice(const Json& json, const std::string& about) {
  for (const Json& item : json["warnings"])
    if (item["about"] == about) return item["text"];
  return "";
}

std::string beam1() {
  return model_path("beam1");
}

TEST(CheckAdvice, SaysNothingOfASoundScene) {
  const Json json = check(beam1(), {"contact[0].law=linear", "contact[0].regularization="});
  EXPECT_EQ(json["warnings"].size(), 0U) << json["warnings"];
}

struct Mistake {
  std::string about, words;
  std::vector<std::string> overrides;
};

TEST(CheckAdvice, FindsLikelyMistakesThatTheSoundSceneHasNot) {
  const std::vector<Mistake> mistakes = {
      {"regularization", "take at least", {"contact[0].regularization=200.0"}},
      {"output-interval", "a row every 0.1 s", {"output={interval=0.1}"}},
      {"contact-step", "an impact can be as short as", {"integrator.time_step=5e-3", "integrator.type=newmark"}},
      {"load-step", "in the shortest period of a load", {"integrator.time_step=0.1", "integrator.type=newmark"}},
      {"load-pulse",
       "changes within 5e-05 s",
       {"load=[{type=\"table\",node=\"string:5\",times=[0.0,0.1,0.10005,0.2],values=[0.0,0.0,9.0,0.0]}]",
        "integrator.time_step=1e-4", "integrator.type=newmark"}},
      {"mesh", "a bending wave", {"load[0].angular_frequency=2000.0"}},
      {"units", "has longitudinal waves of 0.1", {"material.steel.young_modulus=210.0"}},
      {"units", "has longitudinal waves of 1", {"material.steel.density=7.85"}},
      {"unused", "[material.copper] is not used by any element", {"material.copper={young_modulus=1e11,density=8e3}"}},
      {"unused", "[section.rod] is not used by any element", {"section.rod={shape=\"circle\",radius=0.1}"}},
      {"start", "closed at the start", {"initial={displacement=[{nodes=\"string:5\",dof=\"u\",value=0.02}]}"}},
      {"gap",
       "gap below the static deflection",
       {"load[0].type=constant", "load[0].amplitude=", "load[0].angular_frequency=", "load[0].value=900.0"}},
      {"critical-step", "larger than the critical step", {"integrator.type=rk4", "integrator.time_step=4e-4"}},
      {"trial", "a trial run failed", {"integrator.type=rk4", "integrator.time_step=1e-3", "integrator.end_time=10.0"}},
      {"pull", "at every open stop", {}},
      {"jump", "jumps by", {}}};
  for (const Mistake& mistake : mistakes) {
    const std::string text = advice(check(beam1(), mistake.overrides), mistake.about);
    EXPECT_NE(text.find(mistake.words), std::string::npos) << mistake.about << ": " << text;
  }
}

/// beam1 under a table of random values about a mean, N; its last value, 900 N, closes stops.
std::vector<std::string> random_load(double mean) {
  std::mt19937 random(7);
  std::normal_distribution<double> value(mean, 900.0);
  std::string times, values;
  for (int i = 0; i <= 2000; ++i) {
    times += (i > 0 ? ", " : "") + std::to_string(i * 5e-4);
    values += (i > 0 ? ", " : "") + std::to_string(i < 2000 ? value(random) : 900.0);
  }
  return {"load=[{type=\"table\",node=\"string:middle\",times=[" + times + "],values=[" + values + "]}]"};
}

/// A mass on a bearing with cross terms: m s^2 + c s + k = +-i q. Undamped, it grows at the rate ((|k + i q| -
/// k)/2m)^(1/2).
TEST(CheckAdvice, WarnsOfModesThatGrow) {
  const TemporaryFolder folder;
  const auto scene = [&](const std::string& damping, const std::string& end) {
    folder.write(
        "bearing.toml",
        "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"d\"\nmass = 1.0\ndiametral_inertia = 0.01\npolar_inertia = "
        "0.02\n[[element]]\ntype = \"bearing\"\nnode = \"d\"\nstiffness = [[1e4, 1e3], [-1e3, 1e4]]\ndamping = [[" +
            damping + ", 0.0], [0.0, " + damping +
            "]]\n[integrator]\ntype = \"auto\"\ntolerance = 1e-4\nend_time = " + end + "\n");
    return folder.file("bearing.toml");
  };
  const double k = 1e4, q = 1e3, rate = std::sqrt(0.5 * (std::hypot(k, q) - k));
  const std::string text = advice(check(scene("0.0", "2.0")), "unstable");
  EXPECT_NE(text.find("by a factor of e every " + to_short_text(1.0 / rate) + " s"), std::string::npos) << text;
  EXPECT_EQ(advice(check(scene("20.0", "2.0")), "unstable"), "");
  EXPECT_EQ(advice(check(scene("0.0", "0.1")), "unstable"), "");  // too slow for this run
}

/// The dashpot of a closed stop limits the step of explicit methods: h c/m <= 2.785 for Runge-Kutta.
TEST(CheckAdvice, CountsTheDashpotsOfStops) {
  const TemporaryFolder folder;
  const auto scene = [&](const std::string& step) {
    folder.write(
        "stop.toml",
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"b\"\nmass = 2.0\n[[contact]]\ntype = \"stop\"\nnodes = "
        "\"b\"\ngap = 0.01\nsides = \"positive\"\nstiffness = 1e6\ndamping = { type = \"kelvin_voigt\", "
        "coefficient = 1e5 }\n[[load]]\ntype = \"constant\"\nnode = \"b\"\nvalue = 500.0\n[integrator]\ntype = "
        "\"rk4\"\nend_time = 0.1\ntime_step = " +
            step + "\n");
    return folder.file("stop.toml");
  };
  const std::string text = advice(check(scene("2.5e-4")), "critical-step");
  EXPECT_NE(text.find("5.57"), std::string::npos) << text;
  const Outcome run = run_program({"run", scene("2.5e-4"), "-o", folder.file("results")}, folder.path());
  EXPECT_NE(run.errors.find("times the critical step of rk4"), std::string::npos) << run.errors;
  EXPECT_EQ(advice(check(scene("5e-5")), "critical-step"), "");
  const Outcome safe = run_program({"run", scene("5e-5"), "-o", folder.file("results")}, folder.path());
  EXPECT_EQ(safe.errors.find("critical step"), std::string::npos) << safe.errors;
}

TEST(CheckAdvice, TakesWhatLastsOfALoadForItsStaticPart) {
  EXPECT_EQ(advice(check(beam1(), random_load(0.0)), "gap"), "");
  EXPECT_EQ(advice(check(beam1(), random_load(500.0)), "gap"), "") << "it opens them again";
  EXPECT_NE(advice(check(beam1(), random_load(3000.0)), "gap"), "");
  // A ramp and a table that settle close the stops permanently; a pulse does not.
  const auto gap = [](const std::string& load) {
    return advice(check(beam1(), {"load=[{node=\"string:middle\"," + load + "}]"}), "gap");
  };
  EXPECT_NE(gap("type=\"ramp\",to=900.0,end=0.3"), "");
  EXPECT_NE(gap("type=\"table\",times=[0,0.1,0.2,0.3,0.4],values=[0,-900,900,-900,900]"), "");
  EXPECT_EQ(gap("type=\"table\",times=[0,0.6,0.7,0.8],values=[0,0,900,0]"), "");
  EXPECT_NE(gap("type=\"harmonic\",amplitude=900.0,angular_frequency=0.0"), "");
}

TEST(CheckAdvice, KnowsStiffnessRatioAndDurationOfAnImpact) {
  // K = 1e9 N/m with a stop of 1e10 N/m; the contact lasts pi sqrt(100/1e10) s.
  const Json json = check(model_path("oscillator"));
  EXPECT_NEAR(json["contact"]["least_stiffness_ratio"].get<double>(), 10.0, 1e-9);
  EXPECT_NEAR(json["contact"]["shortest_contact"].get<double>(), 3.14159265e-4, 1e-11);
  EXPECT_NEAR(json["contact"]["static_deflection"].get<double>(), 201240.0 / 1e9, 1e-12);
  EXPECT_EQ(json["mass"], 100.0);
}

/// Disc of inertia 0.5 kg m2 on 200 N m/rad between stops at 0.02 rad, and a mass on 1e4 N/m with a stop at 1 mm: each
/// kind of stop has its own line in its own unit. The law's residual force is k/(pi^2 lambda).
TEST(CheckAdvice, KeepsRotationsAndDisplacementsApart) {
  const TemporaryFolder folder;
  folder.write("disc.toml", R"(schema = 1
[[element]]
type = "mass"
name = "m"
mass = 4.0
[[element]]
type = "spring"
node = "m"
stiffness = 1e4
[[element]]
type = "mass"
name = "d"
mass = 1.0
rotary_inertia = 0.5
[[support]]
nodes = "d"
fix = ["u"]
[[element]]
type = "spring"
node = "d"
dof = "theta"
stiffness = 200.0
[[contact]]
type = "stop"
nodes = "m"
sides = "positive"
gap = 1e-3
stiffness = 1e6
[[contact]]
type = "stop"
nodes = "d"
dof = "theta"
gap = 0.02
law = "arctan"
stiffness = 1e4
regularization = 1e3
[[load]]
node = "m"
type = "harmonic"
amplitude = 5.0
angular_frequency = 10.0
[[load]]
node = "d"
dof = "theta"
type = "harmonic"
amplitude = 3.0
angular_frequency = 10.0
[integrator]
end_time = 1.0
)");
  const Json contact = check(folder.file("disc.toml"))["contact"];
  EXPECT_NEAR(contact["static_deflection"].get<double>(), 5.0 / 1e4, 1e-15);
  EXPECT_NEAR(contact["smallest_gap"].get<double>(), 1e-3, 1e-15);
  EXPECT_NEAR(contact["static_rotation"].get<double>(), 3.0 / 200.0, 1e-14);
  EXPECT_NEAR(contact["smallest_gap_of_rotation"].get<double>(), 0.02, 1e-15);
  const Outcome outcome = run_program({"check", folder.file("disc.toml")}, folder.path());
  EXPECT_NE(
      outcome.output.find("rotation at a stop under the load amplitudes is 0.015 rad; the smallest gap is 0.02 rad"),
      std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.errors.find("residual force of up to 1.01321 N m"), std::string::npos) << outcome.errors;
  EXPECT_NE(outcome.errors.find("displace the structure at rest by 0.00506606 rad, 0.253303 of the gap"),
            std::string::npos)
      << outcome.errors;
}

/// The force of an unbalance of 2e-3 kg m at 150 rad/s has the constant size 45 N, whatever its components are; with
/// stiffnesses of 1e5 and 2e5 N/m the body goes round an ellipse.
TEST(CheckAdvice, AddsTheComponentsOfAnUnbalanceByTheirPhases) {
  const TemporaryFolder folder;
  const auto deflection = [&](const std::string& across) {
    folder.write("rotor.toml",
                 "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"d\"\nmass = 4.0\n[[element]]\ntype = "
                 "\"bearing\"\nnode = \"d\"\nstiffness = [[1e5, 0.0], [0.0, " +
                     across +
                     "]]\n[rotation]\nspeed = 150.0\n[[load]]\ntype = \"unbalance\"\nnode = \"d\"\nmoment = "
                     "2e-3\n[[contact]]\ntype = \"ring\"\nnodes = \"d\"\ngap = 6e-4\nstiffness = "
                     "1.5e6\n[integrator]\nend_time = 0.1\n");
    return check(folder.file("rotor.toml"))["contact"]["static_deflection"].get<double>();
  };
  EXPECT_NEAR(deflection("1e5"), 4.5e-4, 1e-12);
  EXPECT_NEAR(deflection("2e5"), 4.5e-4, 1e-12);
  EXPECT_NEAR(deflection("5e4"), 9e-4, 1e-12);
}

/// Output of `butee run`: steps, rows of history.csv and their bytes.
struct Written {
  double steps, rows, bytes;
};
Written run(const std::string& model, const std::vector<std::string>& settings) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"run", model, "-q", "-o", "out"};
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  const Outcome outcome = run_program(arguments, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string history = read_file(folder.file("out/history.csv"));
  return {Json::parse(read_file(folder.file("out/summary.json")))["steps"].get<double>(),
          static_cast<double>(std::count(history.begin(), history.end(), '\n')) - 1.0,
          static_cast<double>(history.size())};
}

/// Estimates must hold within this factor, or be absent.
constexpr double kFactor = 1.5;

TEST(CheckAdvice, EstimatesStepsAndSize) {
  const std::string casing = std::string(BUTEE_TEST_SOURCE) + "/apps/templates/rotor-casing.toml";
  const std::vector<std::pair<std::string, std::vector<std::string>>> scenes = {
      {beam1(), {"integrator.type=newmark", "output={interval=1e-3}"}},
      {beam1(), {"integrator.type=newmark", "integrator.end_time=0.500003", "output={every=7}"}},
      {beam1(), {"integrator={tolerance=1e-4,end_time=1.0}"}},
      {beam1(), {"integrator={type=\"rodas4\",tolerance=1e-4,end_time=1.0}", "output={every=1}"}},
      {casing, {}},
  };
  for (const auto& [model, settings] : scenes) {
    const Json estimate = check(model, settings)["estimate"];
    const Written written = run(model, settings);
    const auto expect_near = [&](const char* name, double value) {
      if (estimate[name].is_null()) return;
      EXPECT_LT(std::max(estimate[name].get<double>() / value, value / estimate[name].get<double>()), kFactor)
          << name << " " << model << " " << ::testing::PrintToString(settings);
    };
    expect_near("steps", written.steps);
    expect_near("rows", written.rows);
    expect_near("bytes", written.bytes);
    if (estimate["whole"] == true) {
      EXPECT_EQ(estimate["steps"], written.steps);
    }
    if (!estimate["seconds"].is_null()) {
      EXPECT_GT(estimate["seconds"].get<double>(), 0.0);
    }
  }
  // The number of fixed steps is known even if a trial covers little of the run.
  const Json fixed = check(beam1(), {"integrator.type=newmark", "integrator.end_time=1e5"})["estimate"];
  EXPECT_EQ(fixed["steps"], 1e10);
  EXPECT_EQ(fixed["whole"], false);
}

TEST(CheckAdvice, EstimatesNothingThatATrialCannotTell) {
  // The beam does not reach its stops within a trial, and the steps of an adaptive method over months cannot
  // be predicted.
  const Json open =
      check(beam1(), {"integrator.type=newmark", "integrator.end_time=1e5", "contact[0].gap=1e3"})["estimate"];
  EXPECT_TRUE(open["seconds"].is_null());
  const Json adaptive =
      check(beam1(), {"integrator={tolerance=1e-4,end_time=1e7}", "output={interval=1e4}"})["estimate"];
  EXPECT_TRUE(adaptive["seconds"].is_null());
  EXPECT_TRUE(adaptive["steps"].is_null());
}

TEST(CheckAdvice, LeavesNoTraceOfItsTrial) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"check", model_path("oscillator"), "--set", "output.impacts=true"},
                                      folder.path(), {"TMPDIR=" + folder.path()});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_TRUE(folder.entries().empty());
}

TEST(CheckPicture, ShowsASceneAsTextInPlainOrLineDrawingCharacters) {
  const TemporaryFolder folder;
  const std::string plain = run_program({"check", beam1()}, folder.path(), {"LC_ALL=C"}).output;
  EXPECT_NE(plain.find("string  +===="), std::string::npos) << plain;
  EXPECT_NE(plain.find("300 N at 1 Hz"), std::string::npos) << plain;
  EXPECT_NE(plain.find("gap 0.01 m, 1e+06 N/m, arctan"), std::string::npos) << plain;
  EXPECT_EQ(std::count_if(plain.begin(), plain.end(), [](char c) { return (c & 0x80) != 0; }), 0);
  const std::string drawn = run_program({"check", beam1()}, folder.path(), {"LC_ALL=C.UTF-8"}).output;
  EXPECT_NE(drawn.find("╋━━━"), std::string::npos) << drawn;
  const std::string both = run_program({"check", std::string(BUTEE_TEST_SOURCE) + "/apps/templates/rotor-casing.toml"},
                                       folder.path(), {"LC_ALL=C"})
                               .output;
  // The casing is drawn below the rotor, with the stops between them.
  EXPECT_LT(both.find("\nrotor "), both.find("\ncasing ")) << both;
  const std::string between = both.substr(both.find("\nrotor "), both.find("\ncasing ") - both.find("\nrotor "));
  EXPECT_EQ(std::count(between.begin(), between.end(), ':'), 5) << between;
}

TEST(CheckPicture, IsDrawnAsSvg) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program({"check", beam1(), "--picture", "beam.svg", "--set", "title=a < b & c"}, folder.path()).status,
            0);
  const std::string svg = read_file(folder.file("beam.svg"));
  EXPECT_EQ(svg.rfind("<?xml", 0), 0U);
  EXPECT_NE(svg.find("a &lt; b &amp; c"), std::string::npos);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  for (const char* part : {"string: 35 m, 34 elements", "300 N at 1 Hz", "gap 0.01 m"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  const auto count = [&](const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1)) ++found;
    return found;
  };
  // 35 stops on both sides, 2 supports, an arrow with two heads, a symbol in the legend.
  EXPECT_EQ(count("<polygon"), 2U * 35U + 2U + 2U + 1U);
  EXPECT_EQ(count("<text"), count("</text>"));
  EXPECT_EQ(run_program({"check", beam1(), "--picture", "no/such/folder.svg"}, folder.path()).status, 1);
}

}  // namespace
}  // namespace butee::test::check_advice_test
