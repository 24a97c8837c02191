#include <chrono>
#include <filesystem>
#include <fstream>
#include <sys/wait.h>

#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::hostile_test {
namespace {

namespace fs = std::filesystem;

std::string scene_with(const std::string& integrator, const std::string& rest = "") {
  return "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n"
         "[initial]\nvelocity = [{nodes = \"a\", value = 1.0}]\n"
         "[integrator]\nend_time = 1e-2\ntime_step = 1e-3\ntype = \"" +
         integrator + "\"\n" + rest;
}

/// Runs a scene in a nested folder; only its own results may be created.
Outcome run_confined(const TemporaryFolder& folder, const std::string& scene) {
  fs::create_directories(folder.file("in/side"));
  folder.write("in/side/scene.toml", scene);
  Outcome outcome = run_program({"run", "scene.toml"}, folder.file("in/side"));
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"in"});
  for (const auto& entry : fs::directory_iterator(folder.file("in/side")))
    EXPECT_TRUE(entry.path().filename() == "scene.toml" || entry.path().filename() == "scene-results") << entry.path();
  return outcome;
}

/// A scene names methods, laws and elements; these names are never file names.
TEST(HostileScenes, CannotMakeButeeLoadAFile) {
  const std::string module = std::string(BUTEE_TEST_BROKEN) + "/static_crash.so";
  ASSERT_TRUE(fs::exists(module));
  int refused = 0;
  for (const std::string& name : {module, std::string("../../x"), std::string("./static_crash"),
                                  std::string("static_crash.so"), std::string("file://x.so")}) {
    const std::string quoted = "\"" + name + "\"";
    for (const std::string& scene : {scene_with(name),
                                     scene_with("rk4",
                                                "[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 1.0\nstiffness = "
                                                "1.0\nlaw = " +
                                                    quoted + "\n"),
                                     scene_with("rk4", "[[load]]\ntype = " + quoted + "\nnode = \"a\"\n"),
                                     scene_with("rk4", "[[element]]\ntype = " + quoted + "\nname = \"b\"\n"),
                                     scene_with("rk4", "[output]\nformats = [" + quoted + "]\n"),
                                     scene_with("rk4", "plugin = " + quoted + "\n")}) {
      const TemporaryFolder folder;
      const Outcome outcome = run_confined(folder, scene);
      EXPECT_EQ(outcome.status, 2) << outcome.errors;
      EXPECT_EQ(outcome.errors.find("crashed"), std::string::npos) << outcome.errors;
      EXPECT_FALSE(fs::exists(folder.file("in/side/scene-results")));
      ++refused;
    }
  }
  EXPECT_EQ(refused, 30);
}

TEST(HostileScenes, CannotWriteOutsideTheirFolder) {
  int tried = 0;
  for (const std::string name : {"../../escaped", "/tmp/butee-escaped", "..", "a/b", "nul\\u0000", "new\\nline"}) {
    const std::string quoted = "\"" + name + "\"";
    for (const std::string& scene :
         {scene_with("rk4", "[[output.probe]]\nlabel = " + quoted + "\nnode = \"a\"\nquantities = [\"u\"]\n"),
          scene_with("rk4", "[[element]]\ntype = \"mass\"\nmass = 1.0\nname = " + quoted + "\n"),
          "title = " + quoted + "\n" + scene_with("rk4")}) {
      const TemporaryFolder folder;
      const Outcome outcome = run_confined(folder, scene);
      EXPECT_EQ(outcome.status, scene.starts_with("title") ? 0 : 2) << scene << outcome.errors;
      ++tried;
    }
  }
  EXPECT_EQ(tried, 18);
  EXPECT_FALSE(fs::exists("/tmp/butee-escaped"));
}

/// Text of a scene is printed, but never interpreted by the terminal.
TEST(HostileScenes, DoNotReachTheTerminal) {
  const TemporaryFolder folder;
  const std::string title = "title = \"\\u001B]0;owned\\u0007 \\u009B31m\"\n";
  const Outcome titled = run_confined(folder, title + scene_with("rk4"));
  EXPECT_EQ(titled.status, 0) << titled.errors;
  const Outcome refused = run_confined(folder, scene_with("\\u001B[2Jrk4"));
  EXPECT_EQ(refused.status, 2);
  for (const std::string& text : {titled.output, titled.errors, refused.output, refused.errors}) {
    EXPECT_EQ(text.find('\x1B'), std::string::npos) << text;
    EXPECT_EQ(text.find("\xC2\x9B"), std::string::npos) << text;
  }
  EXPECT_EQ(printable("a\tb\nc\x7F\xC2\x85\xC3\xA9"), "a\tb?c??\xC3\xA9");
  EXPECT_EQ(printable("a\nb", true), "a\nb");
}

/// The title is written into a script for gnuplot, which could run commands.
TEST(HostileScenes, CannotGiveGnuplotCommands) {
  const TemporaryFolder folder;
  folder.write("scene.toml", "title = \"it's `touch backquoted`\\n' ; system 'touch quoted' #\"\n" +
                                 scene_with("rk4",
                                            "[[output.probe]]\nlabel = \"a\"\nnode = \"a\"\nquantities = "
                                            "[\"u\"]\n"));
  folder.write("study.toml",
               "schema = 1\n[study]\nscenes = [\"scene.toml\"]\ntargets = [1e-2]\n[[study.method]]\ntype = \"rk4\"\n"
               "sweep = \"time_step\"\nvalues = [1e-3]\n");
  const Outcome outcome = run_program({"compare", "study.toml", "-q", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string script = read_file(folder.file("out/work-precision-scene.gp"));
  EXPECT_NE(script.find("it''s `touch backquoted`?'' ; system ''touch quoted'' #' noenhanced"), std::string::npos)
      << script;
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"out", "scene.toml", "study.toml"}));
}

/// In a title within double quotes, gnuplot would run text after a backquote as a command.
TEST(HostileScenes, CannotGivePlotsCommands) {
  const TemporaryFolder folder;
  folder.write("scene.toml", "title = \"`touch backquoted` \\\" ; system 'touch quoted' #\"\n" + scene_with("rk4"));
  ASSERT_EQ(run_program({"run", "scene.toml", "-q"}, folder.path()).status, 0);
  run_program({"plot", "scene-results", "-q"}, folder.path());
  int scripts = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    EXPECT_FALSE(entry.path().filename() == "backquoted" || entry.path().filename() == "quoted") << entry.path();
    if (entry.path().extension() != ".gp") continue;
    EXPECT_EQ(read_file(entry.path().string()).find('`'), std::string::npos) << entry.path();
    ++scripts;
  }
  EXPECT_GT(scripts, 0);
}

/// Texts on which the parser would take minutes or exhaust the stack are refused at once.
TEST(HostileScenes, OfGreatDepthAreRefusedBeforeTheyAreParsed) {
  const auto repeated = [](const std::string& text, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += text;
    return all;
  };
  const std::vector<std::pair<std::string, std::string>> texts = {
      {"a" + repeated(".a", 20000) + " = 1\n", "parts make one dotted key"},
      {"[a" + repeated(" . a", 10000) + "]\n", "parts make one dotted key"},
      {"x = {a" + repeated(".\"b\"", 10000) + " = 1}\n", "parts make one dotted key"},
      {"x = " + repeated("[", 50000) + "\n", "brackets stand in one another"},
      {"x = " + repeated("{a=", 20000) + "\n", "brackets stand in one another"},
      {"x = [" + repeated("'a',", 50000) + "]\n", "the line is longer than"},
      {"x = {a = 1" + repeated(", a = 1", 20000) + "}\n", "the line is longer than"},
      {repeated("# a comment\n", 6000000), "larger than 64 MB"},
      // Four quotes: a multi-line string that begins with a quote; the text after it is not a string.
      {"x = [\"\"\"\"a\"\"\", " + repeated("[", 50000) + "\n", "brackets stand in one another"}};
  for (const auto& [text, complaint] : texts) {
    const TemporaryFolder folder;
    const Outcome outcome = run_confined(folder, text);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.errors.find(complaint), std::string::npos) << outcome.errors.substr(0, 500);
  }
}

/// A table of twenty thousand instants is accepted, and its written form can be read again.
TEST(HostileScenes, LongArraysOverManyLinesAreNotRefused) {
  std::string times = "times = [\n", values = "values = [\n";
  for (int i = 0; i < 20000; ++i) {
    times += std::to_string(i) + (i % 10 == 9 ? ",\n" : ",");
    values += std::to_string(i % 7) + ".123456789" + (i % 10 == 9 ? ",\n" : ",");
  }
  const TemporaryFolder folder;
  const Outcome outcome = run_confined(
      folder, scene_with("rk4", "[[load]]\ntype = \"table\"\nnode = \"a\"\n" + times + "]\n" + values + "]\n"));
  EXPECT_EQ(outcome.status, 0) << outcome.errors.substr(0, 500);
  const std::string history = read_file(folder.file("in/side/scene-results/history.csv"));
  const Outcome again = run_program({"run", "in/side/scene-results/model.toml", "-o", "again"}, folder.path());
  EXPECT_EQ(again.status, 0) << again.errors.substr(0, 500);
  EXPECT_EQ(read_file(folder.file("again/history.csv")), history);
}

TEST(HostileScenes, AHundredLevelsAreNotTooMany) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_confined(folder, scene_with("rk4", "[output]\n# " + std::string(1000, '[') +
                                                 "\n# a.b.c.d\ninterval = 1.0e-3 # " + std::string(200, '.') + "\n"));
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
}

/// Devices and pipes may never end and are refused; a pipe that ends is read like a file.
TEST(HostileFiles, ThatNeverEndAreRefusedAndPipesAreRead) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene_with("rk4"));
  for (const std::string file : {"/dev/zero", "endless"}) {
    std::string line = "cd '" + folder.path() + "' && ";
    if (file == "endless") line += "mkfifo endless && { yes '# a comment' > endless & } && ";
#ifndef __SANITIZE_ADDRESS__  // the sanitizer reserves more address space than any limit allows
    line += "ulimit -v 1000000 && ";
#endif
    line += std::string("'") + BUTEE_TEST_PROGRAM + "' check " + file + " > out 2> err < /dev/null";
    const int status = std::system(line.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 2) << file;
    EXPECT_EQ(read_file(folder.file("err")), file + ":1: the file is larger than 64 MB\n");
  }
  const std::string piped =
      "cd '" + folder.path() + "' && cat scene.toml | '" + BUTEE_TEST_PROGRAM + "' check /dev/stdin > out 2> err";
  EXPECT_EQ(std::system(piped.c_str()), 0) << read_file(folder.file("err"));
  EXPECT_EQ(run_program({"check", "."}, folder.path()).status, 2);
}

}  // namespace
}  // namespace butee::test::hostile_test
