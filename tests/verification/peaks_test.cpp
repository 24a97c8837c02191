#include <algorithm>
#include <cmath>
#include <map>

#include <butee/core/text.hpp>
#include <butee/embed/structure.hpp>
#include <butee/record/energy.hpp>
#include <butee/record/history.hpp>
#include <butee/record/peaks.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "conformance/methods.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::peaks_test {
namespace {

using Json = nlohmann::json;

/// Relative error of a method on these scenes; 1e-3 s is 1/800 of the shortest period.
constexpr double kMethod = 2e-3;
/// Between steps rodas4 interpolates accelerations linearly; at its default tolerance steps are longer.
constexpr double kStraight = 4e-3;
/// Errors of locating a peak on the dense output, and of printed digits.
constexpr double kSame = 1e-9, kPrinted = 1e-5;

std::string integrator(const MethodCase& method, const std::string& end_time) {
  return "schema = 1\n[integrator]\ntype = \"" + method.name + "\"\ntime_step = 1e-3\nend_time = " + end_time + "\n" +
         method.keys;
}

const std::string kOscillator = R"(
[[element]]
type = "mass"
name = "ball"
mass = 1.0
[[element]]
type = "spring"
node = "ball"
stiffness = 10.0
)";

const std::string kProbe = R"(
[[output.probe]]
label = "ball"
node = "ball"
quantities = ["u", "v", "a", "contact_force"]
)";

/// Free motion with an energy of v^2/2 against a stop of 50 N/m at 0.01 m; rows and steps miss the peaks.
const std::string kStop = kOscillator + R"(
[[contact]]
type = "stop"
nodes = "ball"
gap = 0.01
sides = "positive"
law = "linear"
stiffness = 50.0
[initial]
velocity = [{ nodes = "ball", value = 0.11402704796459576 }]
[output]
interval = 0.25
energy = true
impacts = true
)" + kProbe;

std::map<std::string, double> closed_form_at_stop() {
  const double k = 10.0, stop = 50.0, gap = 0.01, v = 0.11402704796459576, energy = 0.5 * v * v;
  // k u^2/2 + stop (u - gap)^2/2 = energy
  const double p = 0.5 * (k + stop), q = -stop * gap, r = 0.5 * stop * gap * gap - energy;
  const double u = (-q + std::sqrt(q * q - 4.0 * p * r)) / (2.0 * p), force = stop * (u - gap);
  return {{"ball.u", v / std::sqrt(k)}, {"ball.v", v}, {"ball.a", k * u + force}, {"ball.contact_force", force}};
}

/// cos(2 t) on the oscillator, with a row every 2.5 periods.
const std::string kDriven = kOscillator + R"(
[[load]]
type = "harmonic"
node = "ball"
amplitude = 1.0
angular_frequency = 2.0
[output]
interval = 8.0
)" + kProbe;

std::map<std::string, double> closed_form_driven(double end) {
  constexpr int kSamples = 200000;
  const double w = std::sqrt(10.0), drive = 2.0, amplitude = 1.0 / (w * w - drive * drive);
  std::map<std::string, double> peaks = {{"ball.contact_force", 0.0}};
  for (int i = 0; i <= kSamples; ++i) {
    const double t = end * i / kSamples, c = std::cos(drive * t), s = std::sin(drive * t), cw = std::cos(w * t),
                 sw = std::sin(w * t);
    const double values[] = {c - cw, w * sw - drive * s, w * w * cw - drive * drive * c};
    const char* names[] = {"ball.u", "ball.v", "ball.a"};
    for (int k = 0; k < 3; ++k) peaks[names[k]] = std::max(peaks[names[k]], amplitude * std::abs(values[k]));
  }
  return peaks;
}

double largest(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Tracks the peaks in an embedded structure, as an embedding program would.
std::map<std::string, double> embedded_peaks(const std::string& scene, double end) {
  auto structure = embed::Structure::from_toml(scene, {{}, {BUTEE_TEST_PLUGINS}, {}});
  using model::Quantity;
  structure.follow_peaks("ball", {Quantity::u, Quantity::v, Quantity::a, Quantity::contact_force});
  structure.advance_to(end);
  return structure.peaks();
}

/// 1 kg, 1e-3 N/m and 3.5 m/s against stops of 1e12 N/m at 100 m: the penetration of 1.5 um is 1.5e-8 of the
/// displacement. Without the spring's work in contact the force is sqrt(1e12 N/m 1 kg) times the speed of impact, 1.5
/// m/s.
TEST(PeaksAtStiffStops, AreThoseOfThePenetration) {
  const double spring = 1e-3, stop = 1e12, gap = 100.0, v = 3.5;
  const double b = 2.0 * spring * gap, c = spring * gap * gap - v * v, a = stop + spring;
  const double truth = stop * (-2.0 * c) / (b + std::sqrt(b * b - 4.0 * a * c));
  for (const char* method : {"piecewise", "exact", "rodas4"}) {
    SceneRun run(
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
        "\"ball\"\nstiffness = 1e-3\n[[contact]]\ntype = \"stop\"\nnodes = \"ball\"\ngap = 100.0\nstiffness = "
        "1e12\n[initial]\nvelocity = [{ nodes = \"ball\", value = 3.5 }]\n[integrator]\nend_time = 200.0\n" +
            kProbe,
        {std::string("integrator.type=") + method});
    record::Peaks peaks(
        {{"ball", run.model().nodes.select("ball").nodes.front(), {model::Quantity::contact_force}, ""}},
        run.dynamics());
    run.simulation().add(peaks);
    ASSERT_TRUE(run.run().completed) << method;
    EXPECT_NEAR(peaks.largest().at("ball.contact_force"), truth, 2e-5 * truth) << method;
  }
}

/// A pulse of 1 ms sets fast modes in motion; steps are then as long as the displacements at the stop allow. Peaks of
/// velocities are those of the motion by rodas4 with a thousandth of the tolerance.
TEST(PeaksOfVelocities, IncludeFastModesBesideAStop) {
  const std::string scene =
      "schema = 1\n[material.s]\nyoung_modulus = 2.1e11\ndensity = 7850.0\n[section.r]\nshape = \"tube\"\nouter_radius "
      "= "
      "0.06\ninner_radius = 0.04\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = "
      "\"r\"\nlength = 10.0\nelements = 10\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = "
      "[\"u\"]\n[[contact]]\n"
      "type = \"stop\"\nnodes = \"b:7\"\ngap = 0.03\nlaw = \"linear\"\nstiffness = 1e6\nsides = "
      "\"negative\"\n[[load]]\ntype = \"table\"\nnode = \"b:5\"\ntimes = [0.2, 0.2005, 0.201]\nvalues = [0.0, -4e4, "
      "0.0]\n[damping]\nmass_proportional = 0.2\n[gravity]\nacceleration = [0.0, -9.81, 0.0]\nstatic = "
      "true\n[integrator]\nend_time = 0.3\n";
  const auto peak_of = [&](const char* node, const std::string& method, double tolerance) {
    SceneRun run(scene, {"integrator.type=" + method, "integrator.tolerance=" + to_text(tolerance)});
    record::Peaks peaks({{"b", run.model().nodes.select(node).nodes.front(), {model::Quantity::v}, ""}},
                        run.dynamics());
    run.simulation().add(peaks);
    EXPECT_TRUE(run.run().completed);
    return peaks.largest().at("b.v");
  };
  for (const char* node : {"b:4", "b:5", "b:7"}) {
    const double truth = peak_of(node, "rodas4", 1e-6);
    EXPECT_NEAR(peak_of(node, "exponential", 1e-3), truth, 2e-3 * truth) << node;
  }
}

class PeaksOf : public testing::TestWithParam<MethodCase> {
 protected:
  /// Runs the scene with the program, and compares all outputs of a peak.
  Json run(const std::string& scene, const std::map<std::string, double>& truth, double tolerance) {
    folder.write("scene.toml", scene);
    const Outcome outcome = run_program({"run", "scene.toml", "-o", "results"}, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    Json summary = Json::parse(read_file(folder.file("results/summary.json")));
    const CsvTable history(folder.file("results/history.csv"));
    for (const auto& [column, value] : truth) {
      const double peak = summary["peak"].at(column);
      EXPECT_NEAR(peak, value, tolerance * value) << column;
      EXPECT_LE(largest(history.column(column)), peak) << column;
      const std::string line = "largest |" + column + "| = ";
      const std::size_t place = outcome.output.find(line);
      if (place == std::string::npos) {
        ADD_FAILURE() << column << " is not printed";
        continue;
      }
      EXPECT_NEAR(std::stod(outcome.output.substr(place + line.size())), peak, kPrinted * peak) << column;
    }
    return summary;
  }

  TemporaryFolder folder;
};

TEST_P(PeaksOf, OscillatorAtAStopAreThoseOfItsEnergyInAllPlaces) {
  const std::string scene = integrator(GetParam(), "4.0") + kStop;
  const bool is_exact = GetParam().name == "exact";
  const Json summary = run(scene, closed_form_at_stop(), is_exact ? kSame : kMethod);
  const double force = summary["peak"].at("ball.contact_force");
  const CsvTable impacts(folder.file("results/impacts.csv"));
  EXPECT_EQ(impacts.rows(), 3U);
  EXPECT_NEAR(largest(impacts.column("peak_force")), force, kSame * force);
  // Output rows end the steps of extrapolation8; an embedded structure has no rows, so its steps differ.
  const double same = GetParam().name == "extrapolation8" ? kPrinted : kSame;
  for (const auto& [column, peak] : embedded_peaks(scene, 4.0)) {
    const double printed = summary["peak"].at(column);
    EXPECT_NEAR(peak, printed, same * printed) << column;
  }
}

TEST_P(PeaksOf, DrivenOscillatorLieBetweenRowsAndSteps) {
  const bool is_exact = GetParam().name == "exact" || GetParam().name == "exponential";
  run(integrator(GetParam(), "8.0") + kDriven, closed_form_driven(8.0),
      is_exact                      ? 1e-8
      : GetParam().name == "rodas4" ? kStraight
                                    : kMethod);
}

INSTANTIATE_TEST_SUITE_P(AllMethods, PeaksOf, testing::ValuesIn(method_cases()),
                         [](const auto& method) { return method.param.name; });

TEST(PeaksOfTrust, HoldTheTrueForceOfAStop) {
  TemporaryFolder folder;
  folder.write("scene.toml", "schema = 1\n[integrator]\ntype = \"exact\"\ntime_step = 1e-3\nend_time = 4.0\n" + kStop);
  ASSERT_EQ(run_program({"run", "scene.toml", "-o", "results", "--trust"}, folder.path()).status, 0);
  const Json summary = Json::parse(read_file(folder.file("results/summary.json")));
  const double truth = closed_form_at_stop().at("ball.contact_force");
  const Json& force = summary["trust"]["statistics"]["largest contact force"];
  EXPECT_LE(force["least"].get<double>(), truth * (1.0 + kSame));
  EXPECT_GE(force["greatest"].get<double>(), truth * (1.0 - kSame));
  EXPECT_NEAR(force["value"].get<double>(), truth, kSame * truth);
}

/// Two stops on one node: their forces add, and the sum may be largest when neither force is.
TEST(PeaksOfSums, AreThoseOfTheRowsOfAFineHistory) {
  const std::string scene = R"(
schema = 1
[integrator]
type = "exact"
end_time = 3.0
time_step = 1e-3
[[element]]
type = "mass"
name = "other"
mass = 0.3
[[element]]
type = "spring"
node = "other"
stiffness = 30.0
[[contact]]
type = "stop"
between = ["ball", "other"]
gap = 0.002
law = "linear"
stiffness = 80.0
)" + kStop;
  TemporaryFolder folder;
  folder.write("scene.toml", scene);
  const auto run = [&](const std::string& interval) {
    EXPECT_EQ(run_program({"run", "scene.toml", "-o", "results", "--set", "output.interval=" + interval}, folder.path())
                  .status,
              0);
  };
  run("1e-4");
  const double fine = largest(CsvTable(folder.file("results/history.csv")).column("ball.contact_force"));
  run("0.3");
  const Json summary = Json::parse(read_file(folder.file("results/summary.json")));
  EXPECT_NEAR(summary["peak"]["ball.contact_force"].get<double>(), fine, 3e-6 * fine);
}

/// A mass between the ground and another mass on top of it: the forces of its stops have opposite senses, and their sum
/// is its own inertia and weight.
TEST(PeaksOfSums, OfOppositeForcesAreInertiaAndWeight) {
  const std::string scene = R"(
schema = 1
[[element]]
type = "mass"
name = "lower"
mass = 2.0
[[element]]
type = "mass"
name = "upper"
mass = 1.5
[[contact]]
type = "stop"
nodes = "lower"
sides = "negative"
gap = 0.0
law = "linear"
stiffness = 2.0e6
[[contact]]
type = "stop"
between = ["upper", "lower"]
sides = "negative"
gap = 0.0
law = "linear"
stiffness = 9.0e6
[[load]]
node = "upper"
type = "harmonic"
amplitude = 10.0
angular_frequency = 60.0
[gravity]
acceleration = [0.0, -9.81, 0.0]
static = true
[integrator]
tolerance = 1e-9
end_time = 0.05
[output]
interval = 1e-5
[[output.probe]]
label = "lower"
node = "lower"
quantities = ["contact_force", "a"]
)";
  for (const std::string method : {"exact", "piecewise", "dopri5"}) {
    TemporaryFolder folder;
    folder.write("scene.toml", scene);
    ASSERT_EQ(
        run_program({"run", "scene.toml", "-q", "-o", "results", "--set", "integrator.type=" + method}, folder.path())
            .status,
        0);
    const CsvTable history(folder.file("results/history.csv"));
    double expected = 0.0;
    for (const double acceleration : history.column("lower.a"))
      expected = std::max(expected, std::abs(2.0 * (acceleration + 9.81)));
    const double peak = Json::parse(read_file(folder.file("results/summary.json")))["peak"]["lower.contact_force"];
    EXPECT_NEAR(peak, expected, 3e-6 * expected) << method;
    EXPECT_GT(expected, 1.003 * 2.0 * 9.81);
    EXPECT_GE(peak, largest(history.column("lower.contact_force")));
  }
}

/// An element of 1 mm has modes of 6e7 rad/s that follow the load and do not oscillate: the search between rows that
/// are far apart must not look for them.
TEST(PeaksOfStiffParts, AreThoseOfTheRowsOfAFineHistory) {
  TemporaryFolder folder;
  folder.write("scene.toml", R"(
schema = 1
[material.s]
young_modulus = 2.1e11
density = 7850.0
[section.c]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "b"
material = "s"
section = "c"
coordinates = [0, 0.25, 0.5, 0.75, 1.0, 1.001, 1.25, 1.5, 1.75, 2.0]
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[[load]]
node = "b:4"
type = "harmonic"
amplitude = 200.0
angular_frequency = 50.0
phase = -1.5707963267948966
[integrator]
type = "exponential"
tolerance = 1e-5
end_time = 0.3
[[output.probe]]
label = "m"
node = "b:4"
quantities = ["u"]
)");
  const auto run = [&](const std::string& interval) {
    EXPECT_EQ(
        run_program({"run", "scene.toml", "-q", "-o", "results", "--set", "output.interval=" + interval}, folder.path())
            .status,
        0);
    return Json::parse(read_file(folder.file("results/summary.json")))["peak"]["m.u"].get<double>();
  };
  const double fine = run("1e-5"), rows = largest(CsvTable(folder.file("results/history.csv")).column("m.u"));
  EXPECT_NEAR(fine, rows, 1e-6 * rows);
  EXPECT_NEAR(run("5e-3"), rows, 1e-6 * rows);
}

/// contact_force belongs to the DOF of the stops; contact_uy and contact_uz tell directions apart.
TEST(PeaksOfContacts, AreThoseOfStopsAlongAnyDof) {
  const std::string scene = R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 100.0
[[element]]
type = "spring"
node = "m"
dof = "uz"
stiffness = 100.0
damping = 8.0
[[contact]]
type = "stop"
nodes = "m"
dof = "uz"
law = "linear"
gap = 0.01
stiffness = 1000.0
[[load]]
type = "constant"
node = "m"
dof = "uz"
value = 10.0
[integrator]
type = "exact"
end_time = 1.0
[output]
impacts = true
[[output.probe]]
label = "m"
node = "m"
quantities = ["contact_force", "contact_uy", "contact_uz"]
)";
  for (const std::string more : {"", "damping = { type = \"kelvin_voigt\", coefficient = 1e-9 }\n"}) {
    std::string toml = scene;
    toml.replace(toml.find("gap = 0.01\n"), 0, more);
    TemporaryFolder folder;
    folder.write("s.toml", toml);
    ASSERT_EQ(run_program({"run", "s.toml", "-q"}, folder.path()).status, 0);
    const auto peak = nlohmann::json::parse(read_file(folder.file("s-results/summary.json")))["peak"];
    const CsvTable impacts(folder.file("s-results/impacts.csv"));
    const auto forces = impacts.column("peak_force");
    const double largest = *std::max_element(forces.begin(), forces.end());
    EXPECT_GT(largest, 10.0);
    EXPECT_NEAR(peak.at("m.contact_force").get<double>(), largest, 1e-6 * largest);
    EXPECT_NEAR(peak.at("m.contact_uz").get<double>(), largest, 1e-6 * largest);
    EXPECT_EQ(peak.at("m.contact_uy").get<double>(), 0.0);
    const CsvTable history(folder.file("s-results/history.csv"));
    // At rest the load is held by the spring and the stop: 100 u + 1000 (u - 0.01) = 10.
    EXPECT_NEAR(history.column("m.contact_uz").back(), -1000.0 * (20.0 / 1100.0 - 0.01), 0.2);
    EXPECT_EQ(history.column("m.contact_force").back(), history.column("m.contact_uz").back());
  }
}

/// A ball with v = 1 m/s against a Kelvin-Voigt stop, x = v e^(-d t) sin(w t)/w with d = c/2m: its force
/// begins with c v and is largest there for c^2 > k m, else where w t = atan2(w (w^2 - 3 d^2),
/// d (3 w^2 - d^2)). Long steps and short ones beside changes of contact must find the same.
TEST(PeaksOfDashpots, AreThoseOfTheClosedForm) {
  for (const double c : {40.0, 90.0, 130.0}) {
    const double k = 1e4, d = 0.5 * c, w = std::sqrt(k - d * d);
    const double t = c * c > k ? 0.0 : std::atan2(w * (w * w - 3.0 * d * d), d * (3.0 * w * w - d * d)) / w;
    const double decay = std::exp(-d * t), x = decay * std::sin(w * t) / w;
    const double force = k * x + c * (decay * std::cos(w * t) - d * x);
    for (const std::string method : {"piecewise", "exact", "rodas4", "dopri5", "extrapolation8"}) {
      TemporaryFolder folder;
      folder.write("scene.toml",
                   "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 1.0\n[[contact]]\ntype = "
                   "\"stop\"\nnodes = \"ball\"\ngap = 0.01\nsides = \"positive\"\nlaw = \"linear\"\nstiffness = 1e4\n"
                   "damping = { type = \"kelvin_voigt\", coefficient = " +
                       std::to_string(c) +
                       " }\n[initial]\nvelocity = [{ nodes = \"ball\", value = 1.0 }]\n[integrator]\ntype = \"" +
                       method + "\"\ntolerance = 1e-10\nend_time = 0.1\n[output]\ninterval = 0.01\n" + kProbe);
      const Outcome outcome = run_program({"run", "scene.toml", "-o", "results"}, folder.path());
      ASSERT_EQ(outcome.status, 0) << outcome.errors;
      const Json peak = Json::parse(read_file(folder.file("results/summary.json")))["peak"];
      EXPECT_NEAR(peak["ball.contact_force"].get<double>(), force, 1e-7 * force) << method << ", c = " << c;
      EXPECT_NEAR(peak["ball.a"].get<double>(), force, 1e-6 * force) << method << ", c = " << c;
      EXPECT_NEAR(peak["ball.v"].get<double>(), 1.0, 1e-9) << method << ", c = " << c;
    }
  }
}

/// Peaks of a probe and the balance of energy by `exponential` and `auto` beside those by `exact`, which follows every
/// motion; the balance is closed by definition.
void expect_peaks_of_exact(const std::string& scene, const std::string& node, double end_time,
                           const std::vector<model::Quantity>& quantities) {
  std::map<std::string, double> expected;
  for (const std::string method : {"exact", "exponential", "auto"}) {
    SceneRun run(scene, {"integrator.type=" + method});
    model::OutputRequest request;
    request.interval = 0.2 * end_time;
    request.probes = {{"m", run.model().nodes.select(node).nodes.front(), quantities, ""}};
    record::HistoryRecorder history(request, end_time, run.dynamics(), nullptr);
    record::EnergyRecorder energy(run.dynamics());
    run.simulation().add(history);
    run.simulation().add(energy);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    EXPECT_NEAR(energy.balance_error(), 0.0, method == "exact" ? 1e-12 : 1e-4) << method;
    if (expected.empty()) expected = history.peaks();
    for (const auto& [column, peak] : expected)
      EXPECT_NEAR(history.peaks().at(column), peak, 1e-4 * peak) << method << " " << column;
  }
}

/// A stop in one plane, loads and motion in the other: the steps of exponential follow the stop, and its modes hide
/// those of the other plane. Peaks, energies and breakpoints must follow all of them.
TEST(PeaksOfHiddenModes, AreThoseOfExact) {
  const std::string beam =
      "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7800.0\n[section.p]\nshape = \"tube\"\nouter_radius = "
      "0.05\ninner_radius = 0.04\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = "
      "\"p\"\nlength = 5.0\nelements = 4\nmotion = \"lateral\"\n[[support]]\nnodes = [\"b:first\", "
      "\"b:last\"]\nfix = [\"uy\", \"uz\"]\n[[contact]]\ntype = \"stop\"\nnodes = \"b:middle\"\ngap = 2e-4\nlaw = "
      "\"linear\"\nstiffness = 1e6\ndof = \"uz\"\n[damping]\nmass_proportional = 2.0\n[integrator]\nend_time = 0.25\n";
  const std::string loaded =
      "[[load]]\ntype = \"harmonic\"\nnode = \"b:1\"\ndof = \"uy\"\namplitude = 500.0\nangular_frequency = 133.0\n";
  const std::string released = "[initial]\nvelocity = [{ nodes = \"b:middle\", dof = \"uy\", value = 0.1 }]\n";
  for (const std::string& motion : {loaded, released})
    expect_peaks_of_exact(beam + motion, "b:middle", 0.25,
                          {model::Quantity::uy, model::Quantity::uy_v, model::Quantity::uy_a});
}

/// A disc that only turns, at 100 rad/s, beside a slow mass with a stop.
TEST(PeaksOfHiddenModes, OfRotationsAreThoseOfExact) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"m\"\nstiffness = 1.0\n[[element]]\ntype = \"mass\"\nname = \"d\"\nmass = 1.0\nrotary_inertia = "
      "1.0\n[[element]]\ntype = \"spring\"\nnode = \"d\"\ndof = \"theta\"\nstiffness = 1e4\n[[support]]\nnodes = "
      "\"d\"\nfix = [\"u\"]\n[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 10.0\nstiffness = "
      "100.0\n[damping]\nmass_proportional = 20.0\n[initial]\ndisplacement = [{ nodes = \"m\", value = 1.0 "
      "}]\nvelocity = [{ nodes = \"d\", dof = \"theta\", value = 100.0 }]\n[integrator]\nend_time = 20.0\n";
  expect_peaks_of_exact(scene, "d", 20.0, {model::Quantity::theta, model::Quantity::theta_v, model::Quantity::theta_a});
}

/// Free vibration of two masses on springs, sum A cos(omega t) of incommensurate frequencies, over 20 000 periods of
/// the slower mode without a row in between: the largest |x'| is the sum of the amplitudes of both speeds, which the
/// motion nearly reaches.
TEST(PeaksOfLongSteps, AreThoseOfTheClosedForm) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
      "\"b\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 1.0\n[[element]]\ntype = "
      "\"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 400.0\n[[element]]\ntype = \"spring\"\nnode = "
      "\"b\"\nstiffness = 1.0\n[initial]\ndisplacement = [{ nodes = \"a\", value = 1.0 }]\n[integrator]\ntype = "
      "\"exponential\"\nend_time = 5000.0\n";
  // x_a = (cos t + cos(801^(1/2) t))/2
  const double fast = std::sqrt(801.0), speed = 0.5 * (1.0 + fast);
  SceneRun run(scene);
  model::OutputRequest request;
  request.interval = 5000.0;
  request.probes = {
      {"a", run.model().nodes.select("a").nodes.front(), {model::Quantity::uy, model::Quantity::uy_v}, ""}};
  record::HistoryRecorder history(request, 5000.0, run.dynamics(), nullptr);
  run.simulation().add(history);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  EXPECT_NEAR(history.peaks().at("a.uy_v"), speed, 1e-6 * speed);
  EXPECT_NEAR(history.peaks().at("a.uy"), 1.0, 1e-9);
}

/// A pinned beam under a harmonic load, thousands of periods of its fastest modes with one row at the end; `exact`
/// takes short steps.
TEST(PeaksOfLongSteps, AreThoseOfExact) {
  const std::string beam =
      "schema = 1\n[material.s]\nyoung_modulus = 2.1e11\ndensity = 7800.0\n[section.p]\nshape = "
      "\"tube\"\nouter_radius = 0.03\ninner_radius = 0.02\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = "
      "\"s\"\nsection = \"p\"\nlength = 3.0\nelements = 6\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = "
      "[\"u\"]\n[[load]]\ntype = \"harmonic\"\nnode = \"b:2\"\namplitude = 300.0\nangular_frequency = "
      "211.0\n[integrator]\nend_time = 1.0\n";
  std::map<std::string, double> expected;
  for (const std::string method : {"exact", "exponential"}) {
    SceneRun run(beam, {"integrator.type=" + method});
    model::OutputRequest request;
    request.interval = 1.0;
    request.probes = {{"p",
                       run.model().nodes.select("b:2").nodes.front(),
                       {model::Quantity::uy, model::Quantity::uy_v, model::Quantity::rz, model::Quantity::rz_v},
                       ""}};
    record::HistoryRecorder history(request, 1.0, run.dynamics(), nullptr);
    run.simulation().add(history);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    if (expected.empty()) expected = history.peaks();
    for (const auto& [column, peak] : expected) EXPECT_NEAR(history.peaks().at(column), peak, 1e-8 * peak) << column;
  }
}

}  // namespace
}  // namespace butee::test::peaks_test
