// The command `compare`: its output, the correctness of its errors, and a second call that keeps finished
// runs.
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::compare_test {
namespace {

/// An oscillator without stops: u = cos(w t), w = 10.
constexpr const char* kSwing =
    "schema = 1\ntitle = \"a swing\"\n[[element]]\ntype = \"mass\"\nname = \"ball\"\nmass = 2.0\n[[element]]\n"
    "type = \"spring\"\nnode = \"ball\"\nstiffness = 200.0\n[initial]\ndisplacement = [{nodes = \"ball\", value = "
    "1.0}]\n"
    "[integrator]\ntype = \"rk4\"\ntime_step = 1e-3\nend_time = 0.5\n[output]\ninterval = 0.125\n[[output.probe]]\n"
    "label = \"ball\"\nnode = \"ball\"\nquantities = [\"u\"]\n";

constexpr const char* kStudy =
    "schema = 1\n[study]\ntitle = \"two methods\"\nscenes = [\"swing.toml\"]\ntargets = [1e-3]\n[[study.method]]\n"
    "type = \"rk4\"\nsweep = \"time_step\"\nvalues = [0.125, 0.0625]\n[[study.method]]\ntype = \"NM1\"\n"
    "sweep = \"time_step\"\nvalues = [0.125]\n[[study.method]]\ntype = \"exact\"\nsweep = \"none\"\n";

/// One classical Runge-Kutta step of x'' = -w^2 x as a matrix on (x, v), in closed form.
double runge_kutta_error(double h, int per_row) {
  const double w = 10.0, z = w * h;
  const double c = 1.0 - z * z / 2.0 + z * z * z * z / 24.0, s = z - z * z * z / 6.0;
  double x = 1.0, v = 0.0, squares = 0.0, all = 1.0;
  for (int row = 1; row <= 4; ++row) {
    for (int i = 0; i < per_row; ++i) {
      const double next = c * x + s / w * v;
      v = c * v - s * w * x;
      x = next;
    }
    const double exact = std::cos(w * 0.125 * row);
    squares += (x - exact) * (x - exact);
    all += exact * exact;
  }
  return std::sqrt(squares / all);
}

/// The error column of runs.csv by method and value.
std::map<std::string, std::string> rows_of(const std::string& csv) {
  std::map<std::string, std::string> rows;
  std::size_t begin = 0;
  while (begin < csv.size()) {
    const std::size_t end = csv.find('\n', begin);
    const std::string line = csv.substr(begin, end - begin);
    const std::size_t key = line.find("\",");
    if (key != std::string::npos) rows[line.substr(key + 2, line.find(",\"completed", key) - key - 2)] = line;
    begin = end + 1;
  }
  return rows;
}

double error_in(const std::string& line) {
  const std::string mark = "\"completed\",";
  return std::stod(line.substr(line.find(mark) + mark.size()));
}

TEST(Compare, MeasuresTheErrorsThatTheMethodsHave) {
  const TemporaryFolder folder;
  folder.write("swing.toml", kSwing);
  folder.write("study.toml", kStudy);
  const Outcome outcome = run_program({"compare", "study.toml", "-o", "out"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string csv = read_file(folder.file("out/runs.csv"));
  const auto rows = rows_of(csv);
  ASSERT_EQ(rows.size(), 4U) << csv;
  ASSERT_TRUE(rows.contains("rk4,time_step,0.125") && rows.contains("rk4,time_step,0.0625")) << csv;
  // The reference is exact to rounding, so the errors are those of the step's closed form.
  EXPECT_NEAR(error_in(rows.at("rk4,time_step,0.125")), runge_kutta_error(0.125, 1), 1e-12);
  EXPECT_NEAR(error_in(rows.at("rk4,time_step,0.0625")), runge_kutta_error(0.0625, 2), 1e-12);
  const std::string report = read_file(folder.file("out/report.md"));
  for (const char* part : {"# two methods", "a swing", "They agree to the end", "| newmark |", "as written"})
    EXPECT_NE(report.find(part), std::string::npos) << part;
}

TEST(Compare, LeavesTheScenesOwnToleranceToItsOwnMethod) {
  const TemporaryFolder folder;
  std::string scene = kSwing;
  const std::string method = "type = \"rk4\"\ntime_step = 1e-3\n";
  scene.replace(scene.find(method), method.size(), "tolerance = 0.1\n");
  folder.write("swing.toml", scene);
  folder.write("study.toml", kStudy);
  const Outcome outcome = run_program({"compare", "study.toml", "-o", "out"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  // A reference computed with the scene's own tolerance would be off by some percent.
  const auto rows = rows_of(read_file(folder.file("out/runs.csv")));
  EXPECT_NEAR(error_in(rows.at("rk4,time_step,0.0625")), runge_kutta_error(0.0625, 2), 1e-12);
}

/// Many of the installed methods refuse a contact with dissipation.
TEST(Compare, ListsTheMethodsThatRefuseAScene) {
  const TemporaryFolder folder;
  folder.write("swing.toml",
               kSwing + std::string("[[contact]]\ntype = \"stop\"\nnodes = \"ball\"\ngap = 0.5\nstiffness = "
                                    "1e4\ndamping = {type = \"hunt_crossley\", factor = 0.1}\n"));
  const Outcome outcome = run_program({"compare", "swing.toml", "-o", "result"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder.file("result/report.md"));
  for (const char* part :
       {"| bathe | ", "refused: swing.toml: integrator.type: bathe cannot treat contacts", "| dopri5 | "})
    EXPECT_NE(report.find(part), std::string::npos) << part << "\nin\n" << report;
}

TEST(Compare, KeepsWhatAnEarlierCallHasDone) {
  const TemporaryFolder folder;
  folder.write("swing.toml", kSwing);
  folder.write("study.toml", kStudy);
  ASSERT_EQ(run_program({"compare", "study.toml", "-o", "out"}, folder.path()).status, 0);
  const std::string first = read_file(folder.file("out/runs.csv"));
  ASSERT_EQ(run_program({"compare", "study.toml", "-o", "out"}, folder.path()).status, 0);
  EXPECT_EQ(read_file(folder.file("out/runs.csv")), first);  // equal times show that nothing was run again
  ASSERT_EQ(run_program({"compare", "study.toml", "-o", "out", "--fresh"}, folder.path()).status, 0);
  EXPECT_NE(read_file(folder.file("out/runs.csv")), first);
}

TEST(Compare, TakesErrorsOnlyAsFarAsItsReferenceIsOne) {
  // beam4 with the arctan law: rounding differences, amplified by e^(20 t) and by the law's discontinuity at
  // rest, reach a thousandth of the peak before half a second; 0.45 s was observed.
  const TemporaryFolder folder;
  folder.write("study.toml", "schema = 1\n[study]\nscenes = [\"" + model_path("beam4") +
                                 "\"]\nend_time = 0.6\n[[study.method]]\ntype = \"rk4\"\nsweep = \"none\"\n");
  const Outcome outcome = run_program({"compare", "study.toml", "-o", "out"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder.file("out/report.md")), mark = "diverge at t = ";
  ASSERT_NE(report.find(mark), std::string::npos) << report;
  const double horizon = std::stod(report.substr(report.find(mark) + mark.size()));
  EXPECT_GT(horizon, 0.3);
  EXPECT_LT(horizon, 0.6);
}

TEST(Compare, TakesAReferenceFromAFile) {
  const TemporaryFolder folder;
  folder.write("swing.toml", kSwing);
  std::string csv = "t,ball.u\n";
  for (int row = 0; row <= 4; ++row)
    csv += std::to_string(0.125 * row) + "," + std::to_string(std::cos(1.25 * row) + (row == 2 ? 0.5 : 0.0)) + "\n";
  folder.write("given.csv", csv);
  std::string study = kStudy;
  study.replace(study.find("targets"), 0, "reference = \"given.csv\"\n");
  folder.write("study.toml", study);
  ASSERT_EQ(run_program({"compare", "study.toml", "-o", "out"}, folder.path()).status, 0);
  // exact is now measured like any other method: it differs from the one wrong row by 0.5.
  const auto rows = rows_of(read_file(folder.file("out/runs.csv")));
  double squares = 0.0;
  for (int row = 0; row <= 4; ++row) squares += std::pow(std::cos(1.25 * row) + (row == 2 ? 0.5 : 0.0), 2);
  ASSERT_TRUE(rows.contains("exact,,0"));
  EXPECT_NEAR(error_in(rows.at("exact,,0")), 0.5 / std::sqrt(squares), 1e-6);  // the file has six digits
  EXPECT_NE(read_file(folder.file("out/report.md")).find("Its own error is not known"), std::string::npos);
  // With another reference the errors are measured again.
  std::string other = "t,ball.u\n";
  for (int row = 0; row <= 4; ++row)
    other += std::to_string(0.125 * row) + "," + std::to_string(std::cos(1.25 * row)) + "\n";
  // A spreadsheet's file: byte order mark, carriage returns.
  for (std::size_t i = 0; (i = other.find('\n', i)) != std::string::npos; i += 2) other.replace(i, 1, "\r\n");
  folder.write("given.csv", "\xEF\xBB\xBF" + other);
  ASSERT_EQ(run_program({"compare", "study.toml", "-o", "out"}, folder.path()).status, 0);
  EXPECT_LT(error_in(rows_of(read_file(folder.file("out/runs.csv"))).at("exact,,0")), 1e-6);
  folder.write("given.csv", "t,ball.u\n0.0,1.0\n");
  const Outcome outcome = run_program({"compare", "study.toml", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("has no row at t = 0.125"), std::string::npos) << outcome.errors;
}

TEST(Compare, TellsOfAColumnThatIsZeroAndMeasuresTheOthers) {
  const TemporaryFolder folder;
  std::string scene = kSwing;
  scene.replace(scene.find("[\"u\"]"), 5, "[\"u\", \"contact_force\"]");
  // A body at rest beside it differs between the two computations of the reference by their perturbation.
  scene.insert(scene.find("[[element]]"),
               "[[element]]\ntype = \"mass\"\nname = \"rest\"\nmass = 1.0\n[[element]]\ntype = \"spring\"\nnode = "
               "\"rest\"\nstiffness = 1.0\n");
  folder.write("swing.toml", scene + "\n[[output.probe]]\nlabel = \"rest\"\nnode = \"rest\"\nquantities = [\"u\"]\n");
  std::string study = kStudy;
  study.replace(study.find("targets"), 0, "quantity = [\"ball.u\", \"ball.contact_force\", \"rest.u\"]\n");
  folder.write("study.toml", study);
  const Outcome outcome = run_program({"compare", "study.toml", "-o", "out"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.errors.find("ball.contact_force is zero throughout the reference"), std::string::npos)
      << outcome.errors;
  EXPECT_NE(outcome.errors.find("rest.u is zero throughout the reference"), std::string::npos) << outcome.errors;
  const auto rows = rows_of(read_file(folder.file("out/runs.csv")));
  EXPECT_NEAR(error_in(rows.at("rk4,time_step,0.0625")), runge_kutta_error(0.0625, 2), 1e-12);
}

TEST(Compare, RefusesWhatItCannotCompare) {
  const TemporaryFolder folder;
  folder.write("swing.toml", kSwing);
  folder.write("study.toml", "schema = 1\n[study]\nscenes = [\"swing.toml\"]\nquantity = \"ball.w\"\n");
  const Outcome column = run_program({"compare", "study.toml"}, folder.path());
  EXPECT_EQ(column.status, 2);
  EXPECT_NE(column.errors.find("there is no column \"ball.w\""), std::string::npos) << column.errors;
  folder.write("study.toml", "schema = 1\n[study]\nscenes = [\"swing.toml\"]\ntarget = [1.0]\n");
  const Outcome key = run_program({"compare", "study.toml"}, folder.path());
  EXPECT_EQ(key.status, 2);
  EXPECT_NE(key.errors.find("did you mean \"targets\""), std::string::npos) << key.errors;
}

TEST(Trust, KnowsAnOrderlySceneFromAChaoticOne) {
  const TemporaryFolder folder;
  const Outcome orderly = run_program(
      {"run", model_path("beam1"), "--set", "integrator.time_step=1e-4", "--trust", "-o", "out"}, folder.path());
  ASSERT_EQ(orderly.status, 0) << orderly.errors;
  EXPECT_NE(orderly.output.find("to the end, within the 0.01 demanded (trust_accuracy)"), std::string::npos)
      << orderly.output;
  EXPECT_EQ(orderly.output.find("grow like e^"), std::string::npos) << orderly.output;
  // `exact` would take ten times as long as all other runs.
  EXPECT_NE(orderly.output.find("compared with a run by exponential"), std::string::npos) << orderly.output;
  // Small differences begin as displacements at rest, smaller than those caused by the residual forces of the
  // stops; methods must handle that.
  const Outcome chaotic = run_program({"run", model_path("beam4"), "--set", "integrator.type=exponential", "--set",
                                       "integrator.end_time=0.6", "--trust", "-o", "out"},
                                      folder.path());
  ASSERT_EQ(chaotic.status, 0) << chaotic.errors;
  const std::string summary = read_file(folder.file("out/summary.json"));
  EXPECT_NE(summary.find("\"chaotic\": true"), std::string::npos) << summary;
  const auto number = [&](const std::string& key) {
    return std::stod(summary.substr(summary.find("\"" + key + "\": ") + key.size() + 4));
  };
  EXPECT_NEAR(number("growth_rate"), 20.0, 6.0);  // other measurements give 20 1/s; a fit over 0.6 s scatters
  EXPECT_LT(number("horizon"), 0.5);
}

/// The method refuses tolerances below 1e-8 in a scene with stops.
TEST(Compare, EndsASweepWhereTheMethodRefusesTheTolerance) {
  const TemporaryFolder folder;
  std::string scene = kSwing;
  scene.insert(scene.find("[initial]"), "[[contact]]\ntype = \"stop\"\nnodes = \"ball\"\ngap = 0.5\nstiffness = 2e3\n");
  folder.write("swing.toml", scene);
  const auto study = [](const std::string& values) {
    return "schema = 1\n[study]\ntitle = \"limits\"\nscenes = [\"swing.toml\"]\ntargets = [1e-12]\n"
           "[[study.method]]\ntype = \"exponential\"\nsweep = \"tolerance\"\nvalues = " +
           values + "\n";
  };
  folder.write("study.toml", study("[1e-6, 1e-9]"));
  const auto outcome = run_program({"compare", "study.toml"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(rows_of(read_file(folder.file("study-compare/runs.csv"))).size(), 1U);
  // No run at all is an error.
  folder.write("study.toml", study("[1e-9]"));
  const auto none = run_program({"compare", "study.toml", "--fresh"}, folder.path());
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.errors.find("no method could run"), std::string::npos) << none.errors;
  // Other methods go on beside one that refuses.
  folder.write("study.toml", study("[1e-9]") +
                                 "[[study.method]]\ntype = \"rodas4\"\nvalues = [1e-4]\nsweep = "
                                 "\"tolerance\"\n");
  EXPECT_EQ(run_program({"compare", "study.toml", "--fresh"}, folder.path()).status, 0);
  const auto rows = rows_of(read_file(folder.file("study-compare/runs.csv")));
  EXPECT_EQ(rows.size(), 2U);
}

TEST(Compare, RefusesEmptyLists) {
  const TemporaryFolder folder;
  folder.write("swing.toml", kSwing);
  const std::string head = "schema = 1\n[study]\ntitle = \"empty\"\n", scenes = "scenes = [\"swing.toml\"]\n";
  for (const auto& [study, key] : {std::pair(head + scenes + "targets = []\n", "study.targets = []: is empty"),
                                   std::pair(head + "scenes = []\n", "study.scenes = []: is empty"),
                                   std::pair(head + scenes +
                                                 "[[study.method]]\ntype = \"rk4\"\nsweep = "
                                                 "\"time_step\"\nvalues = []\n",
                                             "study.method[0].values = []: is empty")}) {
    folder.write("study.toml", study);
    const auto outcome = run_program({"compare", "study.toml"}, folder.path());
    EXPECT_EQ(outcome.status, 2) << study;
    EXPECT_NE(outcome.errors.find(key), std::string::npos) << outcome.errors;
  }
}

TEST(Trust, GoesOnWithoutATightenedRunThatTheMethodRefuses) {
  const TemporaryFolder folder;
  std::string scene = kSwing;
  const std::string method = "type = \"rk4\"\ntime_step = 1e-3\n";
  scene.replace(scene.find(method), method.size(), "type = \"exponential\"\ntolerance = 5e-8\n");
  scene.insert(scene.find("[initial]"), "[[contact]]\ntype = \"stop\"\nnodes = \"ball\"\ngap = 0.5\nstiffness = 2e3\n");
  folder.write("swing.toml", scene);
  const auto outcome = run_program({"run", "swing.toml", "--trust"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
}

TEST(Compare, TakesExponentialWhereExactRefusesTheLaw) {
  const TemporaryFolder folder;
  std::string scene = kSwing;
  scene.insert(scene.find("[initial]"),
               "[[contact]]\ntype = \"stop\"\nnodes = \"ball\"\ngap = 0.5\nlaw = \"smooth\"\nstiffness = 2e3\nwidth = "
               "0.1\n");
  folder.write("swing.toml", scene);
  folder.write("study.toml",
               "schema = 1\n[study]\ntitle = \"a bend\"\nscenes = [\"swing.toml\"]\ntargets = [1e-3]\n"
               "[[study.method]]\ntype = \"rk4\"\nsweep = \"time_step\"\nvalues = [1e-3]\n");
  const auto outcome = run_program({"compare", "study.toml", "-q"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string report = read_file(folder.file("study-compare/report.md"));
  EXPECT_NE(report.find("Reference: exponential with a tolerance of 1e-08"), std::string::npos) << report;
  EXPECT_NE(report.find("since exact refuses the scene"), std::string::npos);
  // A method of order 4 with 500 steps over two contacts is far more accurate than this.
  const auto rows = rows_of(read_file(folder.file("study-compare/runs.csv")));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_LT(error_in(rows.begin()->second), 1e-4);
}

}  // namespace
}  // namespace butee::test::compare_test
