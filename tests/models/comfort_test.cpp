#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::comfort_test {
namespace {

using Json = nlohmann::json;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string printed(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program(arguments, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
  return outcome.output;
}

bool has_tool(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null 2>&1").c_str()) == 0;
}

/// The commands that --help lists.
std::vector<std::string> commands() {
  std::istringstream lines(printed({"--help"}));
  std::vector<std::string> names;
  bool listed = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) listed = false;
    std::smatch match;
    if (listed && std::regex_search(line, match, std::regex("^  ([a-z-]+) "))) names.push_back(match[1]);
    listed = listed || line.rfind("Subcommands", 0) == 0;
  }
  EXPECT_GE(names.size(), 7U);
  return names;
}

/// The topics that `butee help` lists.
std::vector<std::string> topics() {
  const std::string text = printed({"help"});
  std::istringstream lines(text.substr(text.find("Topics of")));
  std::vector<std::string> names;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) names.push_back(line.substr(2, line.find(' ', 2) - 2));
  EXPECT_GE(names.size(), 12U);
  return names;
}

TEST(Help, ExplainsEveryTopicAndCommand) {
  for (const std::string& topic : topics()) {
    const std::string text = printed({"help", topic});
    EXPECT_GT(std::count(text.begin(), text.end(), '\n'), 3) << topic;
    EXPECT_EQ(text.back(), '\n');
  }
  for (const std::string& command : commands()) EXPECT_TRUE(holds(printed({"help", command}), "Usage:")) << command;
  const TemporaryFolder folder;
  const Outcome wrong = run_program({"help", "contcat"}, folder.path());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(holds(wrong.errors, "did you mean \"contact\"?")) << wrong.errors;
}

TEST(Help, KnowsWhatIsDeclared) {
  EXPECT_TRUE(holds(printed({"help", "contact"}), "regularization"));
  EXPECT_TRUE(holds(printed({"help", "loads"}), "unbalance"));
  EXPECT_TRUE(holds(printed({"help", "elements"}), "outer_radius"));
  EXPECT_TRUE(holds(printed({"help", "integrators"}), "newmark_adaptive"));
}

/// If a topic lists keys by hand, the list must contain all keys of the reader, taken from its message about
/// an unknown key.
TEST(Help, ListsEveryKeyThatTheReaderTakes) {
  const std::vector<std::pair<std::string, std::string>> places = {
      {"model", "nonsense"},           {"damping", "damping.nonsense"},
      {"output", "output.nonsense"},   {"contact", "contact[0].nonsense"},
      {"loads", "load[0].nonsense"},   {"model", "initial.nonsense"},
      {"model", "support[0].nonsense"}};
  const TemporaryFolder folder;
  for (const auto& [topic, key] : places) {
    const Outcome outcome = run_program({"check", model_path("beam1"), "--set", key + "=1"}, folder.path());
    ASSERT_EQ(outcome.status, 2) << key;
    std::smatch match;
    ASSERT_TRUE(std::regex_search(outcome.errors, match, std::regex("known here: ([^\n)]*)"))) << outcome.errors;
    const std::string text = printed({"help", topic});
    std::istringstream known(match[1]);
    int count = 0;
    for (std::string name; std::getline(known >> std::ws, name, ','); ++count)
      EXPECT_TRUE(holds(text, name)) << topic << " lacks " << name;
    EXPECT_GE(count, 2) << outcome.errors;
  }
}

TEST(Help, NamesEveryFileThatARunWrites) {
  const std::string text = printed({"help", "results"});
  for (const char* name : {"history.csv", "summary.json", "model.toml", "impacts.csv", "energy.csv", "fields.h5",
                           "fields.xdmf", "plots/", "checkpoint.bin", ".butee-lock"})
    EXPECT_TRUE(holds(text, name)) << name;
  EXPECT_TRUE(holds(printed({"help", "model"}), "theta = du/dx"));
  EXPECT_TRUE(holds(read_file(BUTEE_TEST_SOURCE "/README.md"), "`theta` = du/dx"));
}

/// The first scene of the README, saved as a file.
TEST(Readme, ItsSceneRunsWithoutAWarning) {
  const std::string readme = read_file(BUTEE_TEST_SOURCE "/README.md");
  const std::string fence = "```toml\n";
  const auto begin = readme.find(fence) + fence.size();
  const TemporaryFolder folder;
  folder.write("scene.toml", readme.substr(begin, readme.find("```", begin) - begin));
  for (const char* command : {"check", "run"}) {
    const Outcome outcome = run_program({command, "scene.toml"}, folder.path());
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.errors, "") << command;
  }
}

TEST(Help, ManualPageHasEveryCommandAndOption) {
  const std::string page = printed({"help", "--man"});
  for (const std::string& command : commands()) {
    const std::string printed_name = std::regex_replace(command, std::regex("-"), "\\-");
    EXPECT_TRUE(holds(page, ".SS \"butee " + printed_name)) << command;
  }
  for (const char* part : {"\\-\\-set KEY=VALUE", "\\-n, \\-\\-number N", ".SH EXIT STATUS", "BUTEE_PLUGIN_PATH"})
    EXPECT_TRUE(holds(page, part)) << part;
  if (!has_tool("man")) GTEST_SKIP() << "man is not installed";
  const TemporaryFolder folder;
  folder.write("butee.1", page);
  const std::string command =
      "cd " + folder.path() + " && LC_ALL=C.UTF-8 MANWIDTH=100 man --warnings -l butee.1 > out 2> err";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read_file(folder.file("err")), "");
  EXPECT_TRUE(holds(read_file(folder.file("out")), "butee modes"));
}

TEST(Plugins, AreListedAsJson) {
  const Json all = Json::parse(printed({"plugins", "--json"}));
  std::set<std::string> kinds;
  for (const Json& entry : all) kinds.insert(entry["kind"].get<std::string>());
  EXPECT_EQ(kinds, (std::set<std::string>{"contact", "element", "format", "integrator", "law", "load", "quantity",
                                          "section"}));
  const Json one = Json::parse(printed({"plugins", "NM2", "--json"}));
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0]["name"], "newmark_adaptive");
  EXPECT_EQ(one[0]["aliases"][0], "NM2");
  bool found = false;
  for (const Json& parameter : one[0]["parameters"])
    if (parameter["name"] == "beta") {
      found = true;
      EXPECT_EQ(parameter["default"], "0.25");
    }
  EXPECT_TRUE(found);
}

TEST(Completion, OfBashKnowsCommandsOptionsValuesAndScenes) {
  const TemporaryFolder folder;
  folder.write("butee.bash", printed({"completion", "bash"}));
  folder.write("scene.toml", "");
  folder.write("notes.txt", "");
  const auto completed = [&](const std::string& words) {
    const std::string script = "source butee.bash; COMP_WORDS=(butee " + words +
                               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _butee; echo \"${COMPREPLY[*]}\" > out";
    const std::string command = "cd " + folder.path() + " && bash -c '" + script + "'";
    EXPECT_EQ(std::system(command.c_str()), 0) << words;
    return read_file(folder.file("out"));
  };
  EXPECT_EQ(completed("mo"), "modes\n");
  for (const std::string& command : commands()) EXPECT_TRUE(holds(completed("\"\""), command)) << command;
  EXPECT_EQ(completed("run --pr"), "--progress\n");
  EXPECT_EQ(completed("run --progress al"), "always\n");
  EXPECT_EQ(completed("run sc"), "scene.toml\n");
  EXPECT_EQ(completed("run no"), "\n");
  EXPECT_TRUE(holds(completed("help exit"), "exit-codes"));
  EXPECT_TRUE(holds(completed("plugins newmark_a"), "newmark_adaptive"));
  EXPECT_TRUE(holds(completed("init osc"), "oscillator"));
  EXPECT_TRUE(holds(completed("completion z"), "zsh"));
  EXPECT_TRUE(holds(completed("stability rk"), "rk4"));
}

TEST(Completion, OfOtherShellsIsValidAndWhole) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_program({"completion", "csh"}, folder.path()).status, 2);
  for (const char* shell : {"zsh", "fish"}) {
    const std::string script = printed({"completion", shell});
    for (const std::string& command : commands()) EXPECT_TRUE(holds(script, command)) << shell << command;
    EXPECT_TRUE(holds(script, "newmark_adaptive"));
    folder.write(shell, script);
    if (!has_tool(shell)) GTEST_SKIP() << shell << " is not installed";
    const std::string command = "cd " + folder.path() + " && " + shell + " -n " + shell;
    EXPECT_EQ(std::system(command.c_str()), 0) << shell;
  }
}

TEST(Init, EveryKindIsCheckedAndRuns) {
  const TemporaryFolder folder;
  std::istringstream lines(printed({"init"}));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const std::string kind = line.substr(2, line.find(' ', 2) - 2);
    ASSERT_EQ(run_program({"init", kind}, folder.path()).status, 0) << kind;
    const std::string file = kind + ".toml";
    const Outcome check = run_program({"check", file}, folder.path());
    EXPECT_EQ(check.status, 0) << kind << check.errors;
    EXPECT_EQ(check.errors, "") << kind;
    const Outcome run = run_program({"run", file}, folder.path());
    EXPECT_EQ(run.status, 0) << kind << run.errors;
    const Json summary = Json::parse(read_file(folder.file(kind + "-results/summary.json")));
    EXPECT_EQ(summary["status"], "completed");
    if (!holds(read_file(folder.file(file)), "[[contact]]")) continue;
    EXPECT_GT(CsvTable(folder.file(kind + "-results/impacts.csv")).rows(), 0U) << kind;
  }
  EXPECT_GE(count, 8);
}

TEST(Init, OverwritesNothing) {
  const TemporaryFolder folder;
  folder.write("beam.toml", "mine");
  const Outcome refused = run_program({"init", "beam"}, folder.path());
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(holds(refused.errors, "beam.toml: exists and is not overwritten")) << refused.errors;
  EXPECT_EQ(read_file(folder.file("beam.toml")), "mine");
  EXPECT_EQ(run_program({"init", "beam", "-o", "other.toml"}, folder.path()).status, 0);
  EXPECT_TRUE(holds(run_program({"init", "baem"}, folder.path()).errors, "did you mean \"beam\"?"));
  EXPECT_EQ(run_program({"init", "beam", "-o", "no/such/folder.toml"}, folder.path()).status, 1);
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"beam.toml", "other.toml"}));
}

TEST(Run, SaysWhereRowsAreTooFarApartForAnImpact) {
  const auto errors = [](const std::string& interval, const std::string& more) {
    const TemporaryFolder folder;
    return run_program({"run", model_path("oscillator"), "--set", "integrator.end_time=0.02", "--set",
                        "integrator.type=\"rk4\"", "--set", "output.interval=" + interval, "--set", more, "-o", "out"},
                       folder.path())
        .errors;
  };
  const std::string mark = "too few to resolve its force";
  EXPECT_TRUE(holds(errors("1e-3", "output.impacts=false"), mark));
  EXPECT_FALSE(holds(errors("2e-5", "output.impacts=false"), mark));
  EXPECT_FALSE(holds(errors("1e-3", "output.impacts=true"), mark));
  EXPECT_FALSE(holds(errors("1e-3", "load[0].amplitude=1e-3"), mark));  // The mass never strikes the stop.
}

TEST(Colours, AreForTerminalsAndCanBeRefused) {
  const TemporaryFolder folder;
  const Outcome piped = run_program({"check", model_path("beam1")}, folder.path(), {"TERM=xterm-256color"});
  EXPECT_TRUE(holds(piped.errors, "butee: warning:")) << piped.errors;
  EXPECT_FALSE(holds(piped.errors, "\033["));
  if (!has_tool("script")) GTEST_SKIP() << "script is not installed";
  const auto on_terminal = [&](const std::string& variables) {
    const std::string command = "cd " + folder.path() + " && " + variables + " TERM=xterm-256color script -qec '" +
                                BUTEE_TEST_PROGRAM + " check " + model_path("beam1") + "' out > /dev/null < /dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return read_file(folder.file("out"));
  };
  EXPECT_TRUE(holds(on_terminal(""), "\033["));
  EXPECT_FALSE(holds(on_terminal("NO_COLOR=1"), "\033["));
}

}  // namespace
}  // namespace butee::test::comfort_test
