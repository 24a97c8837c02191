#include <cmath>
#include <map>
#include <optional>

#include <butee/config/toml.hpp>
#include <butee/record/history.hpp>
#include <butee/scene/read_output.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "unit/scenes.hpp"

namespace butee::test::history_test {
namespace {

/// Every method and interpolant here is exact for a parabola; only the rounding of some hundred steps
/// remains.
constexpr double kExact = 1e-12;

/// A mass under a constant force, u = F t^2/(2 m) = t^2, v = 2 t, a = 2.
std::string falling_mass(const std::string& integrator, const std::string& output) {
  return "schema = 1\n\n[integrator]\n" + integrator + "\n" + mass("ball", "3.0") +
         "\n[[load]]\ntype = \"constant\"\nnode = \"ball\"\nvalue = 6.0\n\n[output]\n" + output + R"(
[[output.probe]]
label      = "fall"
node       = "ball"
quantities = ["v", "u", "a", "contact_force"]
)";
}

/// Runs the scene with a history like the program, and reads the file.
class Recorded {
 public:
  explicit Recorded(const std::string& toml) : run_(toml) {
    const auto document = config::parse_toml(toml, "scene.toml");
    config::Diagnostics diagnostics(document);
    const double end_time = as_number(*document.root.table()->find("integrator")->table()->find("end_time")).value();
    const auto request = scene::read_output(document.root, run_.model(), end_time, diagnostics);
    diagnostics.throw_if_any();
    record::CsvWriter writer(folder_.file("history.csv"), record::HistoryRecorder::columns(request));
    record::HistoryRecorder history(request, end_time, run_.dynamics(), &writer);
    run_.simulation().add(history);
    EXPECT_TRUE(run_.run().completed);
    writer.close();
    peaks = history.peaks();
    table.emplace(folder_.file("history.csv"));
    text = read_file(folder_.file("history.csv"));
  }

  std::vector<double> column(const std::string& name) const { return table->column(name); }

  std::map<std::string, double> peaks;
  std::optional<CsvTable> table;
  std::string text;

 private:
  TemporaryFolder folder_;
  SceneRun run_;
};

void expect_parabola(const Recorded& recorded, const std::vector<double>& times) {
  const auto t = recorded.column("t"), u = recorded.column("fall.u"), v = recorded.column("fall.v"),
             a = recorded.column("fall.a");
  ASSERT_EQ(t.size(), times.size());
  for (std::size_t i = 0; i < t.size(); ++i) {
    EXPECT_EQ(t[i], times[i]) << "row " << i;
    EXPECT_NEAR(u[i], t[i] * t[i], kExact);
    EXPECT_NEAR(v[i], 2.0 * t[i], kExact);
    EXPECT_NEAR(a[i], 2.0, kExact);
  }
}

TEST(History, OutputTimesDoNotDependOnTheSteps) {
  const std::string end = "\nend_time = 1.0";
  std::vector<double> times;
  for (int i = 0; i < 10; ++i) times.push_back(i * 0.1);
  times.push_back(1.0);
  for (const char* integrator :
       {"type = \"rk4\"\ntime_step = 0.03", "type = \"rk4\"\ntime_step = 0.7",
        "type = \"newmark_modified\"\ntime_step = 0.1", "type = \"newmark_modified\"\ntime_step = 0.0371",
        "type = \"newmark_modified_adaptive\"\ntime_step = 0.01\ntarget_error = 1e-3",
        "type = \"rk4_error_scaled\"\ntime_step = 0.01\ntolerance = 1e-6\nsafety = 0.9"}) {
    SCOPED_TRACE(integrator);
    expect_parabola(Recorded(falling_mass(integrator + end, "interval = 0.1")), times);
  }
}

TEST(History, LastRowIsAtTheEndWhereTheIntervalDoesNotDivide) {
  const Recorded recorded(falling_mass("type = \"rk4\"\ntime_step = 0.02\nend_time = 0.1", "interval = 0.03"));
  expect_parabola(recorded, {0.0, 0.03, 2 * 0.03, 3 * 0.03, 0.1});
}

TEST(History, AnIntervalThatDividesButForRoundingHasNoDoubleRow) {
  const Recorded recorded(falling_mass("type = \"rk4\"\ntime_step = 0.01\nend_time = 0.3", "interval = 0.1"));
  expect_parabola(recorded, {0.0, 0.1, 0.2, 0.3});
}

TEST(History, AnIntervalBeyondTheEndGivesFirstAndLastRow) {
  const Recorded recorded(falling_mass("type = \"rk4\"\ntime_step = 0.1\nend_time = 0.5", "interval = 7"));
  expect_parabola(recorded, {0.0, 0.5});
}

TEST(History, EveryNthStepAndTheLast) {
  const Recorded recorded(falling_mass("type = \"newmark_modified\"\ntime_step = 0.125\nend_time = 1.25", "every = 4"));
  expect_parabola(recorded, {0.0, 0.5, 1.0, 1.25});
}

TEST(History, EveryStepHasItsRow) {
  const Recorded recorded(falling_mass("type = \"rk4\"\ntime_step = 0.25\nend_time = 0.75", "every = 1"));
  expect_parabola(recorded, {0.0, 0.25, 0.5, 0.75});
}

TEST(History, WithoutAnIntervalThereAreAThousand) {
  const Recorded recorded(falling_mass("type = \"rk4\"\ntime_step = 0.25\nend_time = 2.0", ""));
  EXPECT_EQ(recorded.table->rows(), 1001U);
}

TEST(History, ColumnsKeepTheOrderOfTheFile) {
  const Recorded recorded(falling_mass("type = \"rk4\"\ntime_step = 0.1\nend_time = 0.5", "interval = 0.1"));
  EXPECT_EQ(recorded.text.substr(0, recorded.text.find('\n')), "t,fall.v,fall.u,fall.a,fall.contact_force,h");
  EXPECT_EQ(recorded.text.back(), '\n');
}

TEST(History, ColumnHIsTheStepThatHoldsTheRow) {
  const Recorded recorded(falling_mass("type = \"rk4\"\ntime_step = 0.25\nend_time = 0.625", "interval = 0.125"));
  // Steps end at 0.25, 0.5 and, shorter, at 0.625. A row at the end of a step belongs to that step.
  EXPECT_EQ(recorded.column("h"), (std::vector<double>{0.25, 0.25, 0.25, 0.25, 0.25, 0.125}));
}

TEST(History, PeaksRunOverAllStepsAndHoldUUnasked) {
  const std::string scene = R"(
schema = 1

[integrator]
type      = "rk4"
time_step = 0.01
end_time  = 6.2

[initial]
velocity = [{ nodes = "ball", value = -1.5 }]

[[element]]
type      = "spring"
node      = "ball"
stiffness = 2.0

[output]
interval = 3.1

[[output.probe]]
label      = "swing"
node       = "ball"
quantities = ["v"]
)" + mass("ball", "2.0");
  const Recorded recorded(scene);
  // u = -1.5 sin t is small in all rows; the step nearest to its peak differs from it by less than h^2/8.
  EXPECT_NEAR(recorded.peaks.at("swing.u"), 1.5, 1.5 * 0.01 * 0.01 / 8);
  EXPECT_NEAR(recorded.peaks.at("swing.v"), 1.5, kExact);
  EXPECT_EQ(recorded.table->header(), (std::vector<std::string>{"t", "swing.v", "h"}));
}

TEST(History, PeaksOfElementForcesAreThoseOfTheRows) {
  // A soft spring: its force is a thousandth of the displacement, so the two cannot be confused.
  const std::string scene = R"(
schema = 1

[integrator]
type      = "rk4"
time_step = 0.01
end_time  = 6.2

[initial]
displacement = [{ nodes = "ball", value = 1.5 }]

[[element]]
type      = "spring"
node      = "ball"
stiffness = 1.0e-3

[output]
interval = 3.1

[[output.probe]]
label      = "swing"
node       = "ball"
quantities = ["spring_force"]
)" + mass("ball", "2.0");
  const Recorded recorded(scene);
  EXPECT_NEAR(recorded.peaks.at("swing.spring_force"), 1.5e-3, kExact);
  EXPECT_NEAR(recorded.peaks.at("swing.u"), 1.5, kExact);
}

/// The probe sums all stops at the node: F = -k (u - gap) to ground, and the force of the pair with its sign.
TEST(History, ContactForceIsTheSumOverTheStopsOfANode) {
  const std::string scene = R"(
schema = 1

[integrator]
type      = "rk4"
time_step = 1.0e-4
end_time  = 1.0e-3

[initial]
displacement = [{ nodes = "a", value = 0.05 }, { nodes = "b", value = 0.01 }]

[[contact]]
type      = "stop"
nodes     = "a"
gap       = 0.02
stiffness = 100.0

[[contact]]
type      = "stop"
between   = ["a", "b"]
gap       = 0.01
stiffness = 1000.0

[output]
every = 1

[[output.probe]]
label      = "a"
node       = "a"
quantities = ["contact_force"]

[[output.probe]]
label      = "b"
node       = "b"
quantities = ["contact_force"]
)" + mass("a", "1.0") + mass("b", "1.0");
  const Recorded recorded(scene);
  EXPECT_NEAR(recorded.column("a.contact_force").front(), -100.0 * 0.03 - 1000.0 * 0.03, kExact);
  EXPECT_NEAR(recorded.column("b.contact_force").front(), 1000.0 * 0.03, kExact);
}

}  // namespace
}  // namespace butee::test::history_test
