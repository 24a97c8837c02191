// Fields of all nodes: they equal the probes, other programs can read them, and a killed run leaves whole
// records.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <gtest/gtest.h>

#include "plots/field_parts.hpp"
#include "support/process.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::fields_test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::string scene(const std::string& more) {
  return std::string(kParts) + R"([[contact]]
type = "stop"
nodes = "string:all"
gap = 2.0e-3
stiffness = 1.0e6
law = "linear"
[[load]]
type = "harmonic"
node = "string:middle"
amplitude = 2000.0
angular_frequency = 30.0
[integrator]
type = "newmark"
time_step = 1.0e-4
end_time = 0.3
residual_tolerance = 1e-9
increment_tolerance = 1e-9
max_iterations = 20
[output]
interval = 1.0e-3
)" + more +
         R"([[output.probe]]
label = "mid"
node = "string:middle"
quantities = ["u", "v", "theta", "contact_force"]
[[output.probe]]
label = "rotor"
node = "rotor"
quantities = ["u"]
)";
}

const model::FieldFormat* hdf5() {
  static const plugin::Catalogue catalogue = [] {
    plugin::Catalogue made;
    made.add(BUTEE_TEST_PLUGINS);
    return made;
  }();
  return model::find_type(catalogue.types().formats, "hdf5");
}

#define NEEDS_HDF5() \
  if (hdf5() == nullptr) GTEST_SKIP() << "built without HDF5"

std::size_t field(const model::FieldReader& reader, const std::string& name) {
  const auto& fields = reader.layout().fields;
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (fields[i].name == name) return i;
  throw std::runtime_error("no field " + name);
}

/// One node's values over the records.
std::vector<double> course(model::FieldReader& reader, const std::string& name, const std::string& node) {
  const auto& nodes = reader.layout().nodes;
  const auto at = static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
  std::vector<double> values(nodes.size()), all;
  for (std::size_t i = 0; i < reader.times().size(); ++i) {
    reader.read(i, field(reader, name), values);
    all.push_back(values.at(at));
  }
  return all;
}

TEST(Fields, AreWhatTheProbesSay) {
  NEEDS_HDF5();
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("formats = [\"csv\", \"hdf5\"]\n"));
  const Outcome outcome = run_program({"run", "scene.toml", "-q"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const CsvTable history(folder.file("scene-results/history.csv"));
  const auto reader = hdf5()->open(folder.file("scene-results"));
  EXPECT_EQ(reader->layout().title, "a string & a rotor");
  EXPECT_EQ(reader->times(), history.column("t"));
  EXPECT_EQ(course(*reader, "u", "string:5"), history.column("mid.u"));
  EXPECT_EQ(course(*reader, "v", "string:5"), history.column("mid.v"));
  EXPECT_EQ(course(*reader, "theta", "string:5"), history.column("mid.theta"));
  EXPECT_EQ(course(*reader, "contact_force", "string:5"), history.column("mid.contact_force"));
  EXPECT_EQ(course(*reader, "u", "rotor"), history.column("rotor.u"));
  // A stop is closed exactly when u is beyond the gap, on that side.
  const auto u = course(*reader, "u", "string:5"), state = course(*reader, "stop_state", "string:5");
  int closed = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    EXPECT_EQ(state[i], u[i] > 2e-3 ? 1.0 : u[i] < -2e-3 ? -1.0 : 0.0) << "record " << i;
    closed += state[i] != 0.0 ? 1 : 0;
  }
  EXPECT_GT(closed, 20);
  // A fixed DOF, and an absent one: a lone mass has no rotation.
  for (const double value : course(*reader, "u", "string:0")) EXPECT_EQ(value, 0.0);
  for (const double value : course(*reader, "theta", "rotor")) EXPECT_EQ(value, 0.0);
}

/// Contacts with dissipation, in the plane or on uz, as the probes see them.
TEST(Fields, HaveTheForcesOfAllContacts) {
  NEEDS_HDF5();
  const std::string body = R"(schema = 1
[[element]]
type = "mass"
name = "a"
mass = 1.0
[[element]]
type = "spring"
node = "a"
dof = "DOF"
stiffness = 1000.0
[initial]
velocity = [{ nodes = "a", dof = "DOF", value = 0.3 }]
[integrator]
type = "dopri5"
end_time = 0.1
[output]
interval = 1e-3
formats = ["csv", "hdf5"]
[[output.probe]]
label = "a"
node = "a"
quantities = ["DOF", "contact_force"]
[[contact]]
nodes = "a"
gap = 1e-3
stiffness = 1e6
)";
  const std::map<std::string, std::pair<std::string, std::string>> contacts = {
      {"damped", {"u", "type = \"stop\"\ndamping = { type = \"kelvin_voigt\", coefficient = 10.0 }\n"}},
      {"ring",
       {"uy", "type = \"ring\"\n[[element]]\ntype = \"spring\"\nnode = \"a\"\ndof = \"uz\"\nstiffness = 1000.0\n"}},
      {"across", {"uz", "type = \"stop\"\ndof = \"uz\"\n"}}};
  for (const auto& [name, contact] : contacts) {
    SCOPED_TRACE(name);
    const auto& [dof, keys] = contact;
    std::string text = body;
    for (std::size_t at = text.find("DOF"); at != std::string::npos; at = text.find("DOF")) text.replace(at, 3, dof);
    const TemporaryFolder folder;
    folder.write("scene.toml", text + keys);
    const Outcome outcome = run_program({"run", "scene.toml", "-q"}, folder.path());
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    const CsvTable history(folder.file("scene-results/history.csv"));
    const auto reader = hdf5()->open(folder.file("scene-results"));
    const auto force = course(*reader, "contact_force", "a"), state = course(*reader, "stop_state", "a");
    EXPECT_EQ(force, history.column("a.contact_force"));
    EXPECT_GT(*std::max_element(force.begin(), force.end()), 100.0);
    const auto w = history.column("a." + dof);
    for (std::size_t i = 0; i < w.size(); ++i)
      EXPECT_EQ(state[i], w[i] > 1e-3 ? 1.0 : w[i] < -1e-3 ? -1.0 : 0.0) << "record " << i;
  }
}

TEST(Fields, CostTheRunNothingAndChangeNothing) {
  NEEDS_HDF5();
  const TemporaryFolder folder;
  folder.write("plain.toml", scene(""));
  folder.write("both.toml", scene("formats = [\"csv\", \"hdf5\"]\n"));
  ASSERT_EQ(run_program({"run", "plain.toml", "-q"}, folder.path()).status, 0);
  ASSERT_EQ(run_program({"run", "both.toml", "-q"}, folder.path()).status, 0);
  EXPECT_EQ(read_file(folder.file("plain-results/history.csv")), read_file(folder.file("both-results/history.csv")));
  EXPECT_FALSE(fs::exists(folder.file("plain-results/fields.h5")));
  // A reused folder keeps no files of the previous run.
  ASSERT_EQ(run_program({"run", "plain.toml", "-q", "-o", "both-results"}, folder.path()).status, 0);
  EXPECT_FALSE(fs::exists(folder.file("both-results/fields.h5")));
  EXPECT_FALSE(fs::exists(folder.file("both-results/fields.xdmf")));
}

TEST(Fields, OpenTheLibraryOnlyWhereTheyAreAskedFor) {
  NEEDS_HDF5();
  const TemporaryFolder folder;
  folder.write("plain.toml", scene(""));
  folder.write("both.toml", scene("formats = [\"csv\", \"hdf5\"]\n"));
  // Makes the dynamic loader print the files it opens.
  const std::vector<std::string> telling = {"LD_DEBUG=files"};
  const Outcome plain = run_program({"run", "plain.toml", "-q"}, folder.path(), telling);
  EXPECT_NE(plain.errors.find("newmark.so"), std::string::npos);
  EXPECT_EQ(plain.errors.find("hdf5"), std::string::npos);
  const Outcome both = run_program({"run", "both.toml", "-q"}, folder.path(), telling);
  EXPECT_NE(both.errors.find("libhdf5"), std::string::npos);
}

TEST(Fields, KeepWhatIsAskedFor) {
  NEEDS_HDF5();
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("formats = \"hdf5\"\nfields = {nodes = [\"string:2..4\", \"rotor\"], quantities = "
                                   "[\"a\", \"u\"], interval = 0.02}\n"));
  const Outcome outcome = run_program({"run", "scene.toml", "-q"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_FALSE(fs::exists(folder.file("scene-results/history.csv"))) << "csv was not among the formats";
  const auto reader = hdf5()->open(folder.file("scene-results"));
  EXPECT_EQ(reader->layout().nodes, (std::vector<std::string>{"string:2", "string:3", "string:4", "rotor"}));
  ASSERT_EQ(reader->layout().lines.size(), 1U);
  EXPECT_EQ(reader->layout().lines[0].nodes, (std::vector<Index>{0, 1, 2}));
  EXPECT_EQ(reader->layout().fields.size(), 2U);
  EXPECT_EQ(reader->times().size(), 16U);
  EXPECT_EQ(reader->times().back(), 0.3);
}

/// A Python interpreter that has the module, or "".
std::string python_with(const std::string& module) {
  for (const char* python : {"python3", "/usr/bin/python3"})
    if (std::system((std::string(python) + " -c 'import " + module + "' >/dev/null 2>&1").c_str()) == 0) return python;
  return "";
}

std::string run_and_check(const std::string& python, const TemporaryFolder& folder) {
  const std::string command = python + " '" BUTEE_TEST_SOURCE "/tests/plots/check_fields.py' '" +
                              folder.file("scene-results") + "' > '" + folder.file("out") + "' 2>&1";
  const bool ok = std::system(command.c_str()) == 0;
  const std::string out = read_file(folder.file("out"));
  return ok ? out : "failed:\n" + out;
}

TEST(Fields, AreReadByOthers) {
  NEEDS_HDF5();
  const std::string python = python_with("h5py");
  if (python.empty()) GTEST_SKIP() << "no Python with h5py";
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("formats = [\"csv\", \"hdf5\"]\n"));
  ASSERT_EQ(run_program({"run", "scene.toml", "-q"}, folder.path()).status, 0);
  // The script compares fields with history.csv through h5py, and checks every reference of the XDMF. If VTK
  // is available, it also reads the XDMF with VTK's reader, as ParaView does.
  const std::string said = run_and_check(python, folder);
  EXPECT_NE(said.find("h5py: 301 records of 12 nodes agree"), std::string::npos) << said;
  EXPECT_NE(said.find("xdmf: 301 grids agree"), std::string::npos) << said;
}

TEST(Fields, OfAFailedRunAreWhole) {
  NEEDS_HDF5();
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("formats = [\"csv\", \"hdf5\"]\n"));
  const Outcome outcome =
      run_program({"run", "scene.toml", "-q", "--set", "integrator.type=rk4", "--set",
                   "integrator.residual_tolerance=", "--set", "integrator.increment_tolerance=", "--set",
                   "integrator.max_iterations=", "--set", "integrator.time_step=1e-3", "--set", "output.interval=1e-3"},
                  folder.path());
  ASSERT_EQ(outcome.status, 1) << outcome.errors;
  const CsvTable history(folder.file("scene-results/history.csv"));
  const auto reader = hdf5()->open(folder.file("scene-results"));
  EXPECT_GT(history.rows(), 2U);
  EXPECT_EQ(reader->times(), history.column("t"));
}

TEST(Fields, OfAKilledRunAreWhole) {
  NEEDS_HDF5();
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("formats = [\"csv\", \"hdf5\"]\n"));
  constexpr int kRuns = 3;
  constexpr std::uintmax_t kSomeRecords = 100000;  // bytes of fields.xdmf, which grows as records are written
  for (int run = 0; run < kRuns; ++run) {
    const std::string results = "killed" + std::to_string(run), xdmf = folder.file(results + "/fields.xdmf");
    Process process(
        {"run", "scene.toml", "-q", "-o", results, "--set", "integrator.end_time=1e3", "--set", "output.interval=1e-4"},
        folder.path());
    while ((!fs::exists(xdmf) || fs::file_size(xdmf) < kSomeRecords) && !process.ends_within(1ms)) continue;
    process.ends_within(7ms * run);
    process.send(SIGKILL);
    process.wait();
    const auto reader = hdf5()->open(folder.file(results));
    const auto times = reader->times();
    ASSERT_GT(times.size(), 0U);
    for (std::size_t i = 0; i < times.size(); ++i) ASSERT_NEAR(times[i], 1e-4 * static_cast<double>(i), 1e-12);
    EXPECT_NE(course(*reader, "u", "string:5").back(), 0.0);
    EXPECT_NE(read_file(xdmf).find("</Domain></Xdmf>"), std::string::npos);
  }
}

TEST(Fields, NeedAFormatThatKeepsThem) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& more, const std::string& part) {
    folder.write("scene.toml", scene(more));
    const Outcome outcome = run_program({"run", "scene.toml"}, folder.path());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
    EXPECT_FALSE(fs::exists(folder.file("scene-results")));
  };
  refused("formats = [\"csv\", \"hdf\"]\n", "there is no format \"hdf\"");
  refused("formats = [\"csv\", \"hdf\"]\n", "known: csv");
  refused("formats = []\n", "must name at least one format");
  refused("formats = [\"csv\", \"csv\"]\n", "names csv twice");
  refused("fields = {quantities = \"u\"}\n", "no format writes them; set formats = [\"csv\", \"hdf5\"]");
  if (hdf5() == nullptr) {
    refused("formats = [\"hdf5\"]\n", "install it (Debian: libhdf5-dev) and build butee again");
    return;
  }
  const std::string with = "formats = \"hdf5\"\nfields = ";
  refused("formats = \"hdf5\"\ncheckpoint = 100\n", "cannot resume from a checkpoint; remove one of the two");
  refused(with + "{quantities = [\"u\", \"w\"]}\n", "output.fields.quantities");
  refused(with + "{quantities = []}\n", "must name at least one quantity");
  refused(with + "{nodes = \"sting:all\"}\n", "did you mean \"string\"");
  refused(with + "{interval = 0}\n", "output.fields.interval = 0: must be > 0");
  refused(with + "{node = \"rotor\"}\n", "did you mean \"nodes\"");
}

/// XML 1.0 allows no control characters, not even as character references.
TEST(Fields, TitlesWithControlCharactersLeaveXmlWellFormed) {
  NEEDS_HDF5();
  const TemporaryFolder folder;
  folder.write("scene.toml", scene("formats = [\"csv\", \"hdf5\"]\n"));
  const std::string title = "title=\"a \\u0007 b \\u001B[1m c \\uFFFE \\n\\t <&\\\" \\u00E9\"";
  const Outcome outcome =
      run_program({"run", "scene.toml", "-q", "--set", "integrator.end_time=0.01", "--set", title}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string xml = read_file(folder.file("scene-results/fields.xdmf"));
  for (const char c : xml) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n') << static_cast<int>(c);
  const std::string mark = "\xEF\xBF\xBD";
  EXPECT_NE(xml.find("Name=\"a " + mark + " b " + mark + "[1m c " + mark + " &#10;&#9; &lt;&amp;&quot; \xC3\xA9\""),
            std::string::npos)
      << xml.substr(0, 400);
  if (std::system("python3 -c '' > /dev/null 2>&1") != 0) GTEST_SKIP() << "Python is not installed";
  const std::string parse = "python3 -c 'import sys, xml.etree.ElementTree as t; t.parse(sys.argv[1])' '" +
                            folder.file("scene-results/fields.xdmf") + "'";
  EXPECT_EQ(std::system(parse.c_str()), 0);
}

}  // namespace
}  // namespace butee::test::fields_test
