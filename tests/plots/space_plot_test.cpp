// Pictures and fields of shafts and frames.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include "apps/butee/plot/spectrum.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::space_plot_test {
namespace {

namespace fs = std::filesystem;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A rotor in a run-up, with probes in both planes.
constexpr const char* kRotor = R"(schema = 1
[[element]]
type = "disc"
name = "rotor"
mass = 1.0
[[element]]
type = "bearing"
node = "rotor"
stiffness = [[4000.0, 0], [0, 4000.0]]
damping = [[3.0, 0], [0, 3.0]]
[rotation]
speed = { type = "ramp", to = 100.0, end = 1.0 }
[[load]]
type = "unbalance"
node = "rotor"
moment = 1e-4
[integrator]
type = "exact"
end_time = 1.0
[output]
interval = 0.005
[[output.probe]]
label = "disc"
node = "rotor"
quantities = ["uy", "uz"]
)";

TEST(SpacePlot, ShowsOrbitsRunUpAndFullSpectrum) {
  const TemporaryFolder folder;
  folder.write("rotor.toml", kRotor);
  ASSERT_EQ(run_program({"run", "rotor.toml", "-q"}, folder.path()).status, 0);
  const Outcome plot = run_program(
      {"plot", "rotor-results", "--format", "script", "--kind", "orbit,run-up,full-spectrum"}, folder.path());
  ASSERT_EQ(plot.status, 0) << plot.errors;
  const auto script = [&](const std::string& name) {
    return read_file(folder.file("rotor-results/plots/" + name + ".gp"));
  };
  const CsvTable history(folder.file("rotor-results/history.csv"));
  const auto y = history.column("disc.uy"), z = history.column("disc.uz");
  // Both axes have the same scale, in micrometres according to the larger one.
  EXPECT_TRUE(holds(script("orbit"), "set size ratio -1"));
  EXPECT_TRUE(holds(script("orbit"), "uy / ")) << script("orbit").substr(0, 500);
  // The last row: 100 rad/s.
  const std::string run_up = script("run-up");
  EXPECT_TRUE(holds(run_up, "speed of rotation / rad/s"));
  EXPECT_TRUE(holds(run_up, "\n100 ")) << run_up;
  EXPECT_TRUE(holds(script("full-spectrum"), "backward whirl below zero"));
  const Outcome still = run_program({"plot", "rotor-results", "--format", "script", "--kind", "frame"}, folder.path());
  EXPECT_EQ(still.status, 2);
  EXPECT_TRUE(holds(still.errors, "lacks beams that do not all lie along x")) << still.errors;
}

/// A shaft that strikes a ring, and a lone body beside it between two stops and a plane.
constexpr const char* kRubbing = R"(schema = 1
[material.steel]
young_modulus = 2e11
density = 7850.0
[section.round]
shape = "circle"
radius = 0.01
[[element]]
type = "beam"
name = "tube"
motion = "lateral"
material = "steel"
section = "round"
length = 4.0
elements = 4
[[support]]
nodes = ["tube:first", "tube:last"]
fix = ["uy", "uz"]
[[contact]]
type = "ring"
nodes = ["tube:1", "tube:2", "tube:3"]
gaps = [0.5, 1e-3, 2e-3]
centre = [1e-4, 0.0]
stiffness = 1e5
friction = { coefficient = 0.2, slip_speed = 1e-2 }
[[contact]]
type = "stop"
nodes = "tube:3"
dof = "uz"
gap = 3e-3
stiffness = 1e5
[[load]]
type = "harmonic"
node = "tube:2"
amplitude = 40.0
angular_frequency = 20.0
[[load]]
type = "harmonic"
node = "tube:2"
dof = "uz"
amplitude = 40.0
angular_frequency = 20.0
phase = 1.57
[integrator]
tolerance = 1e-4
end_time = 1.0
[output]
interval = 0.005
impacts = true
[[output.probe]]
label = "middle"
node = "tube:2"
quantities = ["uy", "uz"]
[[output.probe]]
label = "side"
node = "tube:1"
quantities = ["uy", "uz"]
[[output.probe]]
label = "other"
node = "tube:3"
quantities = ["uy", "uz"]
)";

TEST(SpacePlot, ShowsRingsContactsAndWear) {
  const TemporaryFolder folder;
  folder.write("tube.toml", kRubbing);
  const Outcome run = run_program({"run", "tube.toml", "-q"}, folder.path());
  ASSERT_EQ(run.status, 0) << run.errors;
  const Outcome plot =
      run_program({"plot", "tube-results", "--format", "script", "--kind", "orbit,contact-map,wear"}, folder.path());
  ASSERT_EQ(plot.status, 0) << plot.errors;
  const auto script = [&](const std::string& name) {
    return read_file(folder.file("tube-results/plots/" + name + ".gp"));
  };
  // 1 mm around the centre at 0.1 mm.
  EXPECT_TRUE(holds(script("orbit-middle"), "# ring 1 mm\n$curve1 << EOD\n1.1 0\n")) << script("orbit-middle");
  EXPECT_TRUE(holds(script("orbit-middle"), "with lines dt 2 lw 2 lc rgb '#222222' title 'ring 1 mm'"));
  EXPECT_TRUE(holds(script("orbit-side"), "ring 500 mm (out of sight)")) << script("orbit-side");
  EXPECT_TRUE(holds(script("orbit-other"), "gap of uz 3 mm")) << script("orbit-other");
  // A row for each closing, at its node's position, starting at t_in.
  const std::string impacts = read_file(folder.file("tube-results/impacts.csv")), map = script("contact-map");
  const auto count = [](const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  };
  const auto of_middle = count(impacts, "\ntube:2,");
  ASSERT_GT(of_middle, 2);
  const std::string data = map.substr(map.find("<< EOD\n") + 6, map.find("\nEOD") - map.find("<< EOD\n") - 6);
  EXPECT_EQ(count(data, "\n"), count(impacts, "\ntube:")) << map;
  EXPECT_EQ(count(data, " 2 "), of_middle) << map;
  EXPECT_TRUE(holds(map, "set ylabel 'x / m'"));
  EXPECT_TRUE(holds(map, "largest force of a contact / "));
  const std::string wear = script("wear");
  EXPECT_TRUE(holds(wear, "\n1 0 0\n")) << wear;  // never in contact
  EXPECT_TRUE(holds(wear, "with impulses") && holds(wear, "share of the time in contact")) << wear;

  // The axis shows names of lone bodies; no contact rubs.
  folder.write("body.toml",
               "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 1.0\n[[contact]]\ntype = "
               "\"stop\"\nnodes = \"ball\"\ngap = 0.01\nstiffness = 1e4\n[initial]\nvelocity = [{ nodes = "
               "\"ball\", value = 1.0 }]\n[integrator]\nend_time = 1.0\n[output]\nimpacts = true\n");
  ASSERT_EQ(run_program({"run", "body.toml", "-q"}, folder.path()).status, 0);
  const Outcome named =
      run_program({"plot", "body-results", "--format", "script", "--kind", "contact-map"}, folder.path());
  ASSERT_EQ(named.status, 0) << named.errors;
  EXPECT_TRUE(holds(read_file(folder.file("body-results/plots/contact-map.gp")), "ytics noenhanced ('ball' 1)"));
  const Outcome none = run_program({"plot", "body-results", "--format", "script", "--kind", "wear"}, folder.path());
  EXPECT_EQ(none.status, 2);
  EXPECT_TRUE(holds(none.errors, "dissipation or friction, that touch")) << none.errors;
}

TEST(SpacePlot, FullSpectrumTellsForwardFromBackward) {
  std::vector<double> t, y, z;
  for (int i = 0; i < 1000; ++i) {
    t.push_back(0.001 * i);
    const double forward = 2.0 * M_PI * 50.0 * t.back(), backward = 2.0 * M_PI * 120.0 * t.back();
    y.push_back(3.0 * std::cos(forward) + 0.5 * std::cos(backward));
    z.push_back(3.0 * std::sin(forward) - 0.5 * std::sin(backward));
  }
  const auto spectrum = app::plot::full_spectrum(t, y, z);
  double at_50 = 0.0, at_minus_120 = 0.0, elsewhere = 0.0;
  for (std::size_t i = 0; i < spectrum.frequencies.size(); ++i) {
    const double f = spectrum.frequencies[i];
    // The Hann window spreads a line over its two neighbours.
    if (std::abs(f - 50.0) < 0.5)
      at_50 = spectrum.amplitudes[i];
    else if (std::abs(f + 120.0) < 0.5)
      at_minus_120 = spectrum.amplitudes[i];
    else if (std::abs(f - 50.0) > 2.5 && std::abs(f + 120.0) > 2.5)
      elsewhere = std::max(elsewhere, spectrum.amplitudes[i]);
  }
  EXPECT_NEAR(at_50, 3.0, 1e-6);
  EXPECT_NEAR(at_minus_120, 0.5, 1e-6);
  EXPECT_LT(elsewhere, 1e-6);
}

constexpr const char* kFrame = R"(schema = 1
[material.s]
young_modulus = 2e11
poisson_ratio = 0.3
density = 7850.0
[section.c]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "leg"
motion = "spatial"
material = "s"
section = "c"
points = [[1, 0, 0], [1, 2, 0]]
up = [0, 0, 1]
elements = 2
[[element]]
type = "beam"
name = "arm"
motion = "spatial"
material = "s"
section = "c"
points = [[1, 2, 0], [1, 2, 3]]
elements = 3
start_node = "leg:last"
[[support]]
nodes = "leg:first"
fix = ["ux", "uy", "uz", "rx", "ry", "rz"]
[[load]]
type = "constant"
node = "arm:last"
dof = "ux"
value = 50.0
[integrator]
type = "rodas4"
tolerance = 1e-3
end_time = 0.1
[output]
interval = 0.01
formats = ["csv", "hdf5"]
[[output.probe]]
label = "tip"
node = "arm:last"
quantities = ["ux", "uy", "uz", "rx", "ry", "rz"]
)";

TEST(SpaceFields, HoldAllDisplacementsAndRotations) {
  plugin::Catalogue catalogue;
  catalogue.add(BUTEE_TEST_PLUGINS);
  const auto* format = model::find_type(catalogue.types().formats, "hdf5");
  if (format == nullptr) GTEST_SKIP() << "no HDF5";
  const TemporaryFolder folder;
  folder.write("frame.toml", kFrame);
  const Outcome run = run_program({"run", "frame.toml", "-q"}, folder.path());
  ASSERT_EQ(run.status, 0) << run.errors;
  const auto reader = format->open(folder.file("frame-results"));
  const model::FieldLayout& layout = reader->layout();
  const auto node =
      static_cast<std::size_t>(std::find(layout.nodes.begin(), layout.nodes.end(), "arm:3") - layout.nodes.begin());
  ASSERT_LT(node, layout.nodes.size());
  EXPECT_EQ(layout.positions[node], (std::array<double, 3>{1.0, 2.0, 3.0}));
  const CsvTable history(folder.file("frame-results/history.csv"));
  std::vector<double> values(layout.nodes.size());
  int compared = 0;
  for (std::size_t i = 0; i < layout.fields.size(); ++i) {
    const auto kind = dof_named(layout.fields[i].name);
    if (!kind) continue;
    const char* const names[] = {"tip.ux", "tip.uy", "tip.uz", "tip.rx", "tip.ry", "tip.rz"};
    const auto column = history.column(names[static_cast<std::size_t>(*kind)]);
    for (std::size_t record = 0; record < column.size(); ++record, ++compared) {
      reader->read(record, i, values);
      EXPECT_EQ(values[node], column[record]) << layout.fields[i].name;
    }
  }
  EXPECT_EQ(compared, 6 * 11);
  const std::string xdmf = read_file(folder.file("frame-results/fields.xdmf"));
  EXPECT_TRUE(holds(xdmf, "<Attribute Name=\"displacement\" AttributeType=\"Vector\">"));
  EXPECT_TRUE(holds(xdmf, "<Attribute Name=\"rotation\" AttributeType=\"Vector\">"));
  const auto joined = xdmf.substr(xdmf.find("Name=\"displacement\""), 2000);
  EXPECT_LT(joined.find("/fields/ux"), joined.find("/fields/u<"));
  EXPECT_LT(joined.find("/fields/u<"), joined.find("/fields/uz"));
  const Outcome plot = run_program({"plot", "frame-results", "--format", "script", "--kind", "frame"}, folder.path());
  ASSERT_EQ(plot.status, 0) << plot.errors;
  EXPECT_TRUE(holds(read_file(folder.file("frame-results/plots/frame.gp")), "plot $rest"));
  // The load bends the leg, which points along y, along x.
  ASSERT_EQ(run_program({"plot", "frame-results", "--format", "script", "--kind", "shape"}, folder.path()).status, 0);
  EXPECT_TRUE(holds(read_file(folder.file("frame-results/plots/shape-leg.gp")), "'displacement ux / mm'"));
}

/// Quantities without a kind of picture of their own are drawn under their names, velocities only if asked for.
TEST(SpacePlot, ShowsEveryQuantityOfTheProbes) {
  const TemporaryFolder folder;
  const std::string probe =
      "[[output.probe]]\nlabel = \"base_1\"\nnode = \"leg:first\"\nquantities = [\"N\", "
      "\"reaction_ux\", \"ux_v\"]\n";
  folder.write("frame.toml", std::string(kFrame) + probe);
  ASSERT_EQ(run_program({"run", "frame.toml", "-q", "--set", "output.formats=[\"csv\"]"}, folder.path()).status, 0);
  ASSERT_EQ(run_program({"plot", "frame-results", "--format", "script"}, folder.path()).status, 0);
  const std::string force = read_file(folder.file("frame-results/plots/N.gp"));
  EXPECT_TRUE(holds(force, "set ylabel 'normal force of a beam (N) / N' noenhanced")) << force;
  EXPECT_TRUE(std::filesystem::exists(folder.file("frame-results/plots/reaction_ux.gp")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("frame-results/plots/ux_v.gp")));
  const Outcome asked = run_program({"plot", "frame-results", "--format", "script", "--kind", "ux_v"}, folder.path());
  EXPECT_EQ(asked.status, 0) << asked.errors;
  EXPECT_TRUE(holds(read_file(folder.file("frame-results/plots/ux_v.gp")), "set ylabel 'ux_v / "));
}

/// The lowest mode of the bent arm is a rotation about its leg: ux and rx of its end, scaled to the modal
/// mass of 1 kg.
TEST(SpaceModes, WriteShapesOfAllMotions) {
  const TemporaryFolder folder;
  folder.write("frame.toml", kFrame);
  ASSERT_EQ(run_program({"modes", "frame.toml", "-n", "2", "-o", "out"}, folder.path()).status, 0);
  const CsvTable shapes(folder.file("out/shapes.csv"));
  for (const char* name : {"u1", "theta1", "ux1", "uz1", "rx1", "ry1", "ux2"})
    EXPECT_EQ(shapes.column(name).size(), shapes.rows()) << name;
  const auto along_x = shapes.column("ux1");
  EXPECT_EQ(along_x.front(), 0.0);
  EXPECT_GT(std::abs(along_x.back()), 0.1);
}

TEST(SpacePicture, ShowsAFrameWhereItStands) {
  const TemporaryFolder folder;
  folder.write("frame.toml", kFrame);
  const Outcome check = run_program({"check", "frame.toml", "--picture", "frame.svg"}, folder.path());
  ASSERT_EQ(check.status, 0) << check.errors;
  const std::string svg = read_file(folder.file("frame.svg"));
  for (const char* text : {">leg<", ">arm<", ">x<", ">y<", ">z<", "50 N"}) EXPECT_TRUE(holds(svg, text)) << text;
  EXPECT_FALSE(holds(svg, "nan"));
}

/// The y coordinates, downwards, of the tip and the base of the triangle of a stop on one side.
std::pair<double, double> drawn_stop(const std::string& side) {
  const TemporaryFolder folder;
  folder.write("frame.toml", std::string(kFrame) +
                                 "[[contact]]\ntype = \"stop\"\nnodes = \"arm:last\"\ndof = \"uy\"\ngap = 0.01\n"
                                 "stiffness = 1e6\nsides = \"" +
                                 side + "\"\n");
  const Outcome check = run_program({"check", "frame.toml", "--picture", "frame.svg"}, folder.path());
  EXPECT_EQ(check.status, 0) << check.errors;
  const std::string svg = read_file(folder.file("frame.svg"));
  const std::size_t end = svg.find("\" fill=\"#d17a00\""), begin = svg.rfind("points=\"", end);
  double tip = 0.0, base = 0.0;
  EXPECT_EQ(std::sscanf(svg.c_str() + begin, "points=\"%*f,%lf %*f,%lf", &tip, &base), 2) << svg.substr(begin, 80);
  return {tip, base};
}

TEST(SpacePicture, DrawsStopsOnTheirSide) {
  const auto [above_tip, above_base] = drawn_stop("positive");
  EXPECT_LT(above_base, above_tip);
  const auto [below_tip, below_base] = drawn_stop("negative");
  EXPECT_GT(below_base, below_tip);
  EXPECT_LT(above_tip, below_tip);
}

/// The name of a folder is part of the names of pictures, and thus of their scripts: a line of it must not become a
/// command.
TEST(SpacePlot, TakesNoCommandsFromNamesOfFolders) {
  const TemporaryFolder folder;
  const std::string hostile = "r\nsystem \"touch made\"\n#";
  folder.write("rotor.toml",
               std::string(kRotor) + "[[contact]]\ntype = \"ring\"\nnodes = \"rotor\"\ngap = 1e-5\nstiffness = 1e6\n");
  ASSERT_EQ(
      run_program({"run", "rotor.toml", "-q", "--set", "output.impacts=true", "-o", hostile}, folder.path()).status, 0);
  fs::copy(folder.file(hostile), folder.file("good"), fs::copy_options::recursive);
  ASSERT_EQ(run_program({"plot", "good", hostile, "-o", "plots", "--format", "script"}, folder.path()).status, 0);
  int scripts = 0;
  for (const auto& file : fs::directory_iterator(folder.file("plots"))) {
    EXPECT_FALSE(holds(file.path().filename().string(), "\n"));
    EXPECT_FALSE(holds(read_file(file.path().string()), "\nsystem")) << file.path();
    ++scripts;
  }
  EXPECT_GT(scripts, 3);
}

}  // namespace
}  // namespace butee::test::space_plot_test
