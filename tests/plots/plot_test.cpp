// The command `butee plot`: the contents of its scripts, its refusals and, if gnuplot is found, the existence
// of pictures.
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::plot_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"(schema = 1
title  = "It's a swing \\ with 100 % \"quotes\""

[[element]]
type = "mass"
name = "ball"
mass = 2.0

[[element]]
type      = "spring"
node      = "ball"
stiffness = 200.0

[[contact]]
type      = "stop"
nodes     = "ball"
gap       = 0.02
stiffness = 1.0e4

[[load]]
type              = "harmonic"
node              = "ball"
amplitude         = 5.0
angular_frequency = 12.566370614359172

[integrator]
type      = "rk4"
time_step = 1.0e-3
end_time  = 4.0

[output]
interval = 0.01
energy   = true

[[output.probe]]
label      = "ball"
node       = "ball"
quantities = ["u", "v", "contact_force"]
)";

bool has_gnuplot() {
  return std::system("command -v gnuplot >/dev/null 2>&1") == 0;
}

class Plot : public testing::Test {
 protected:
  Plot() {
    folder_.write("swing.toml", kScene);
    const Outcome run = run_program({"run", "swing.toml", "-q"}, folder_.path());
    EXPECT_EQ(run.status, 0) << run.errors;
  }

  Outcome plot(std::vector<std::string> arguments, const std::vector<std::string>& environment = {}) {
    arguments.insert(arguments.begin(), "plot");
    return run_program(arguments, folder_.path(), environment);
  }
  std::string script(const std::string& name) { return read_file(folder_.file("swing-results/plots/" + name + ".gp")); }

  static void expect_in(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "no " << part << " in\n" << text.substr(text.size() / 2);
  }

  TemporaryFolder folder_;
};

TEST_F(Plot, DrawsWhatTheResultsAllow) {
  const Outcome outcome = plot({"swing-results", "--format", "script"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  std::string expected;
  for (const char* kind : {"displacement", "force", "step", "energy", "phase-ball", "spectrum"}) {
    const bool apart = std::string(kind) == "phase-ball";
    expected += std::string("swing-results/plots/") + (apart ? "phase" : kind) + ".gp\n";
  }
  EXPECT_EQ(outcome.output, expected);
  const std::string displacement = script("displacement");
  expect_in(displacement, "set ylabel 'displacement / mm' noenhanced");
  expect_in(displacement, "set xlabel 'time / s'");
  expect_in(displacement, "\n     20 with lines dt 2");  // the gap, in mm
  expect_in(displacement, "-20 with lines dt 2");
  expect_in(displacement, "title 'gap ±20 mm'");
  expect_in(displacement, "It's a swing / with 100 % 'quotes'");
  expect_in(script("spectrum"), "from first 2, graph 0");  // Hz, frequency of the load
  expect_in(script("spectrum"), "title 'load 2 Hz'");
  expect_in(script("phase"), "title 'once per load period'");
  for (const char* part : {"kinetic", "strain", "contact", "total", "work - dissipated"})
    expect_in(script("energy"), part);
}

/// The rows of a block of data in a script.
std::size_t rows_of(const std::string& text, const std::string& block) {
  const std::size_t begin = text.find('\n', text.find("$" + block + " <<")) + 1, end = text.find("EOD\n", begin);
  return static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                             text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
}

TEST_F(Plot, TakesAWindowAndAProbe) {
  ASSERT_EQ(
      plot({"swing-results", "--format=script", "--from=1.0", "--to=1.5", "--probe=ball", "--kind=force,displacement"})
          .status,
      0);
  EXPECT_EQ(rows_of(script("displacement"), "curve0"), 51U);
  expect_in(script("displacement"), "set xrange [1:1.5]");
  EXPECT_FALSE(fs::exists(folder_.file("swing-results/plots/step.gp")));
}

TEST_F(Plot, PutsSeveralRunsIntoOnePicture) {
  ASSERT_EQ(
      run_program({"run", "swing.toml", "-q", "--set", "load[0].amplitude=2.0", "-o", "soft"}, folder_.path()).status,
      0);
  const Outcome outcome = plot({"swing-results", "soft", "--format", "script", "-o", "both"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string text = read_file(folder_.file("both/displacement-ball.gp"));
  expect_in(text, "set ylabel 'displacement of ball / mm'");
  expect_in(text, "title 'swing'");
  expect_in(text, "title 'soft'");
  EXPECT_EQ(rows_of(text, "curve1"), 401U);
}

/// Values that differ in their last digits only, for which gnuplot would be given an empty range.
TEST_F(Plot, DrawsAConstantCurve) {
  folder_.write("rest.toml", R"(schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 100.0
[[load]]
type = "constant"
node = "m"
value = 1e6
[gravity]
acceleration = [0.0, -9.81, 0.0]
static = true
[integrator]
end_time = 1.0
[[output.probe]]
label = "p"
node = "m"
quantities = ["u"]
)");
  ASSERT_EQ(run_program({"run", "rest.toml", "-q"}, folder_.path()).status, 0);
  const Outcome outcome = plot({"rest-results", "--format", "script", "--kind", "displacement"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string text = read_file(folder_.file("rest-results/plots/displacement.gp")), key = "set yrange [";
  const std::size_t begin = text.find(key) + key.size(), middle = text.find(':', begin), end = text.find(']', middle);
  EXPECT_LT(std::stod(text.substr(begin, middle - begin)), std::stod(text.substr(middle + 1, end - middle - 1)));
}

TEST_F(Plot, LeavesOutALineCutShort) {
  std::string history = read_file(folder_.file("swing-results/history.csv"));
  folder_.write("swing-results/history.csv", history.substr(0, history.size() - 30));
  ASSERT_EQ(plot({"swing-results", "--format=script", "--kind=displacement"}).status, 0);
  EXPECT_EQ(rows_of(script("displacement"), "curve0"), 400U);
}

TEST_F(Plot, NamesTheFirstOfTheRowsThatItCannotRead) {
  std::string history = read_file(folder_.file("swing-results/history.csv"));
  std::size_t begin = 0;
  for (int line = 1; line < 20; ++line) begin = history.find('\n', begin) + 1;
  history.replace(begin, history.find('\n', begin) - begin, "0.18,none\n0.185");
  folder_.write("swing-results/history.csv", history);
  const Outcome outcome = plot({"swing-results", "--format=script", "--kind=displacement"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  expect_in(outcome.errors,
            "swing-results/history.csv:20: is not a row of 5 numbers; left out of the pictures with 1 more");
  EXPECT_EQ(rows_of(script("displacement"), "curve0"), 400U);
}

TEST_F(Plot, RefusesWhatIsNotThere) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& part) {
    const Outcome outcome = plot(std::move(arguments));
    EXPECT_EQ(outcome.status, 2) << outcome.output;
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  };
  refused({"nowhere"}, "nowhere: is not a folder; name the result folder");
  refused({"."}, "model.toml is missing");
  refused({"swing-results", "--kind", "shap"}, "--kind shap: there is no such kind (did you mean \"shape\"?)");
  refused({"swing-results", "--format=script", "--kind=M"}, "lacks a probe of M: [[output.probe]]");
  refused({"swing-results", "--format", "gif"}, "--format");
  refused({"swing-results", "--format=script", "--probe", "bal"}, "did you mean \"ball\"");
  refused({"swing-results", "--format=script", "--from=5"}, "no rows between --from and --to");
  refused({"swing-results", "--format=script", "--from=2", "--to=1"}, "--from must be less than --to");
  refused({"swing-results", "--format=script", "--kind=shape"}, "output.formats=[\"csv\", \"hdf5\"]");
  EXPECT_FALSE(fs::exists(folder_.file("swing-results/plots")));
}

TEST_F(Plot, SaysWhatToDoWithoutGnuplot) {
  // A search path with only the programs that the test itself needs.
  fs::create_directory(folder_.file("bin"));
  for (const char* tool : {"timeout", "sh"})
    for (const char* place : {"/usr/bin/", "/bin/"})
      if (fs::exists(place + std::string(tool)) && !fs::exists(folder_.file("bin/") + tool))
        fs::create_symlink(place + std::string(tool), folder_.file("bin/") + tool);
  const std::vector<std::string> alone = {"PATH=" + folder_.file("bin")};
  const Outcome plotted = plot({"swing-results"}, alone);
  EXPECT_EQ(plotted.status, 2);
  expect_in(plotted.errors, "gnuplot is not found; install it (Debian: gnuplot-nox), or use --format script");
  const Outcome run = run_program({"run", "swing.toml", "--plot", "-o", "new"}, folder_.path(), alone);
  EXPECT_EQ(run.status, 2);
  EXPECT_FALSE(fs::exists(folder_.file("new"))) << "nothing is run in vain";
  EXPECT_EQ(plot({"swing-results", "--format=script"}, alone).status, 0);
}

TEST_F(Plot, MakesPicturesOfEveryFormat) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Outcome outcome = plot({"swing-results", "--format", "png,svg,pdf"});
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  for (const char* name : {"displacement", "force", "step", "energy", "phase", "spectrum"}) {
    const std::string base = folder_.file("swing-results/plots/") + name;
    EXPECT_EQ(read_file(base + ".png").substr(1, 3), "PNG");
    EXPECT_EQ(read_file(base + ".pdf").substr(0, 4), "%PDF");
    const std::string svg = read_file(base + ".svg");
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    EXPECT_GT(svg.size(), 5000U);
  }
}

TEST_F(Plot, ComesWithARun) {
  if (!has_gnuplot()) GTEST_SKIP() << "gnuplot is not installed";
  const Outcome outcome = run_program({"run", "swing.toml", "--plot", "-o", "new"}, folder_.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  expect_in(outcome.output, "picture new/plots/displacement.png");
  EXPECT_TRUE(fs::exists(folder_.file("new/plots/phase.png")));
}

TEST_F(Plot, HasARowOfEnergiesForEachOutputTime) {
  const CsvTable energy(folder_.file("swing-results/energy.csv"));
  EXPECT_EQ(energy.header(), (std::vector<std::string>{"t", "kinetic", "strain", "contact", "work", "dissipated"}));
  const CsvTable history(folder_.file("swing-results/history.csv"));
  ASSERT_EQ(energy.rows(), history.rows());
  const auto u = history.column("ball.u"), v = history.column("ball.v");
  const auto kinetic = energy.column("kinetic"), strain = energy.column("strain"), contact = energy.column("contact");
  const auto t = energy.column("t"), work = energy.column("work"), rows = history.column("t");
  double least = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    // Steps of 1 ms end on the output times up to the rounding of n h.
    ASSERT_NEAR(t[i], rows[i], 1e-12);
    EXPECT_NEAR(kinetic[i], 0.5 * 2.0 * v[i] * v[i], 1e-9);
    EXPECT_NEAR(strain[i], 0.5 * 200.0 * u[i] * u[i], 1e-9);
    least = std::min(least, contact[i]);
    // There is no dissipation; RK4 at this step keeps the balance to some 1e-5 of the energy.
    EXPECT_NEAR(kinetic[i] + strain[i] + contact[i], work[i], 1e-3);
  }
  EXPECT_GE(least, 0.0);
}

}  // namespace
}  // namespace butee::test::plot_test
