#include <filesystem>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::table_file_test {
namespace {

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A mass on a spring under a table load; `table` holds its keys except type, node and dof.
std::string scene(const std::string& table, const std::string& output = "") {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = \"spring\"\nnode = "
         "\"m\"\n"
         "stiffness = 800.0\n[[load]]\ntype = \"table\"\nnode = \"m\"\n" +
         table +
         "\n[integrator]\ntype = \"newmark_modified\"\ntime_step = 1e-3\nend_time = 0.2\n[output]\ninterval = 0.01\n" +
         output;
}

const std::string kInline = "times = [0.0, 0.05, 0.1, 0.15]\nvalues = [0.0, 30.0, -10.0, 5.0]\n";

class TableFile : public ::testing::Test {
 protected:
  Outcome run(const std::string& toml, const std::vector<std::string>& more = {}) {
    folder_.write("s.toml", toml);
    std::vector<std::string> arguments = {"run", "s.toml", "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments, folder_.path());
  }
  std::string history_of(const std::string& toml) {
    const Outcome outcome = run(toml);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return read_file(folder_.file("s-results/history.csv"));
  }
  void refused(const std::string& text, const std::string& says, const std::string& keys = "") {
    folder_.write("t.csv", text);
    const Outcome outcome = run(scene("file = \"t.csv\"\n" + keys));
    EXPECT_EQ(outcome.status, 2) << text;
    EXPECT_TRUE(holds(outcome.errors, "s.toml:13: load[0].file = \"t.csv\": " + says)) << outcome.errors;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_.file("s-results"))) << text;
  }

  TemporaryFolder folder_;
};

TEST_F(TableFile, GivesTheMotionOfTheSameTableInTheScene) {
  const std::string expected = history_of(scene(kInline));
  folder_.write("a.csv", "0,0\n0.05,30\n0.1,-10\n0.15,5\n");
  EXPECT_EQ(history_of(scene("file = \"a.csv\"")), expected);
  folder_.write("b.csv", "# an accelerogram\n\nt; x; \"force\"\r\n0.0;9;0.0\r\n5e-2; 9; +3.0\r\n .1;9;-1\r\n0.15;9;.5");
  EXPECT_EQ(history_of(scene("file = \"b.csv\"\ncolumns = [\"t\", \"force\"]\nscale = 10")), expected);
  EXPECT_EQ(history_of(scene("file = \"b.csv\"\ncolumns = [1, 3]\nscale = 10")), expected);
  folder_.write("d.csv", "Time (s),no. 2,\"Force, total (N)\"\n0,9,0\n0.05,9,30\n0.1,9,-10\n0.15,9,5\n");
  EXPECT_EQ(history_of(scene("file = \"d.csv\"\ncolumns = [\"Time (s)\", \"Force, total (N)\"]")), expected);
  folder_.write("c.txt", "station 12 15 99\n1 2 3\n  0   0  0.00\n 30\t1 0.05\n-10 1 0.10 extra\n5 1 0.15\n");
  EXPECT_EQ(history_of(scene("file = \"c.txt\"\ncolumns = [3, 1]\nskip = 2")), expected);
}

TEST_F(TableFile, StandsUnderInTimeToo) {
  const std::string load =
      "[[element]]\ntype = \"beam\"\nname = \"b\"\nlength = 1\nelements = 2\nmaterial = \"s\"\nsection = "
      "\"r\"\n[material.s]\nyoung_modulus = 2e11\ndensity = 8000\n[section.r]\nshape = \"circle\"\nradius "
      "= 0.01\n[[support]]\nnodes = \"b:first\"\nfix = [\"u\", \"theta\"]\n[[load]]\ntype = "
      "\"distributed\"\nbeam = \"b\"\nvalue = 2\n[load.in_time]\ntype = \"table\"\n";
  const std::string rest =
      "\n[integrator]\ntype = \"newmark_modified\"\ntime_step = 1e-3\nend_time = 0.2\n[[output.probe]]\n"
      "label = \"tip\"\nnode = \"b:last\"\nquantities = \"u\"\n";
  const std::string expected = history_of("schema = 1\n" + load + kInline + rest);
  folder_.write("a.csv", "0,0\n0.05,30\n0.1,-10\n0.15,5\n");
  EXPECT_EQ(history_of("schema = 1\n" + load + "file = \"a.csv\"" + rest), expected);
}

TEST_F(TableFile, RefusesWhatIsNoTableWithItsLine) {
  refused("0,0\n1,2\n1,3\n", "t.csv:3: column 1 must ascend, and 1 follows 1");
  refused("t,f\n0,0\n# more\n1,abc\n", "t.csv:4: column 2: \"abc\" is not a number");
  refused("0,0\n1\n", "t.csv:2: has 1 columns, but column 2 is requested");
  refused("0,0\n1,\n", "t.csv:2: column 2: \"\" is not a number");
  refused("0,0\n1,,2\n", "t.csv:2: column 2: \"\" is not a number");
  refused("0,0\n1,nan\n", "t.csv:2: column 2: \"nan\" is not finite");
  refused("0,0\n1,inf\n", "t.csv:2: column 2: \"inf\" is not finite");
  refused("0,0\n1,1e999\n", "t.csv:2: column 2: \"1e999\" is not a number");
  refused("0;0\n1;0,5\n", "t.csv:2: column 2: \"0,5\" is not a number; write decimals with a point");
  refused("0\t1,5\n1\t2,5\n", "t.csv:1: separates columns both by blanks and by \",\"; write decimals with a point");
  refused("0,0 1,5\n1,1 2,5\n", "t.csv:1: separates columns both by blanks and by \",\"; write decimals with a point");
  refused("O,0\n1,1\n",
          "t.csv:1: column 1: \"O\" is not a number, but column 2 is; if this line names the columns, skip it");
  refused("", "t.csv: holds no numbers");
  refused("t,f\n", "t.csv: holds no numbers");
  refused("0,0\n1,1\n", "t.csv: holds no numbers", "skip = 9");
  refused("time,force\n0,0\n", "t.csv:1: names no column \"forc\" (did you mean \"force\"?); it names: time, force",
          "columns = [\"time\", \"forc\"]");
  refused("time,forc,forc\n0,0,0\n", "t.csv:1: names two columns \"forc\"; count columns from 1 instead",
          "columns = [\"time\", \"forc\"]");
  refused("0,0\n1,1D0\n", "t.csv:2: column 2: \"1D0\" is not a number; write exponents with e");
  refused("Time (s),\"Force, N\"\n0,0\n", "t.csv:1: names no column \"Force\"; it names: Time (s), Force, N",
          "columns = [\"Time (s)\", \"Force\"]");
  refused("0,0\n", "t.csv:1: has no column names, but columns requests \"t\"", "columns = [\"t\", \"f\"]");
  refused("0,0\n1,1\n", "t.csv:1: has 2 columns, but column 7 is requested", "columns = [1, 7]");
  refused("0,0\n1,1\n", "t.csv:1: columns requests column 1 twice; give one for the times", "columns = [1, 1]");
}

TEST_F(TableFile, RefusesWhatIsNoFile) {
  const auto says = [&](const std::string& file, const std::string& what) {
    const Outcome outcome = run(scene("file = \"" + file + "\""));
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(holds(outcome.errors, "load[0].file = \"" + file + "\": " + what)) << outcome.errors;
  };
  says("none.csv", "does not exist");
  says(".", "is a folder, not a file");
  says("/dev/zero", "is not a regular file");
  EXPECT_TRUE(holds(run(scene(kInline + "file = \"a.csv\"")).errors, "conflicts with file; give one of the two"));
  EXPECT_TRUE(holds(run(scene("times = [0]")).errors, "load[0].values: missing; give the values there, or a file"));
  EXPECT_TRUE(holds(run(scene(kInline + "skip = 2")).errors, "load[0].skip = 2: belongs to file, which is not given"));
  EXPECT_TRUE(holds(run(scene("file = \"a.csv\"\ncolumns = [0, 1]")).errors, "columns are counted from 1"));
}

TEST_F(TableFile, IsNamedInModelTomlAndFoundFromThere) {
  std::filesystem::create_directory(folder_.file("data"));
  folder_.write("data/a.csv", "0,0\n0.05,30\n0.1,-10\n0.15,5\n");
  const std::string history = history_of(scene("file = \"data/a.csv\""));
  const std::string model = read_file(folder_.file("s-results/model.toml"));
  EXPECT_TRUE(holds(model, "file = \"../data/a.csv\"\nsize = 27\nchecksum = \"")) << model;
  const auto again = [&] { return run_program({"run", "s-results/model.toml", "-o", "again", "-q"}, folder_.path()); };
  EXPECT_EQ(again().status, 0);
  EXPECT_EQ(read_file(folder_.file("again/history.csv")), history);
  folder_.write("data/a.csv", "0,0\n0.05,31\n0.1,-10\n0.15,5\n");
  const Outcome changed = again();
  EXPECT_EQ(changed.status, 2);
  EXPECT_TRUE(holds(changed.errors, "load[0].file = \"../data/a.csv\": is not the file that the model was run with"))
      << changed.errors;
  std::filesystem::remove(folder_.file("data/a.csv"));
  EXPECT_TRUE(holds(again().errors, "does not exist"));
  const Outcome pictures = run_program({"plot", "s-results", "--format", "script"}, folder_.path());
  EXPECT_EQ(pictures.status, 0) << pictures.errors;
}

TEST_F(TableFile, LongArraysOfASceneAreReadAsShortOnes) {
  // 40000 numbers on one line: longer than any line passed to the parser.
  std::string times = "0.0", values = "0.0", rows = "0,0\n";
  for (int i = 1; i < 20000; ++i) {
    const std::string t = std::to_string(i) + "e-5", f = std::to_string(i * 7919 % 1001) + ".25";
    times += ", " + t;
    values += ", " + f;
    rows += t + "," + f + "\n";
  }
  folder_.write("a.csv", rows);
  EXPECT_EQ(history_of(scene("times = [" + times + "]\nvalues = [" + values + "]")),
            history_of(scene("file = \"a.csv\"")));
}

}  // namespace
}  // namespace butee::test::table_file_test
