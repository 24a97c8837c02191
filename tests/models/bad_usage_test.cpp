#include <filesystem>

#include <gtest/gtest.h>

#include "bad_scenes.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::bad_usage_test {
namespace {

using Names = std::vector<std::string>;

constexpr const char* kFile = "scene.toml";

void expect_refusal(const Names& arguments, const TemporaryFolder& folder, const Names& says) {
  SCOPED_TRACE(testing::PrintToString(arguments));
  const Names before = folder.entries();
  const Outcome outcome = run_program(arguments, folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
  for (const std::string& part : says) EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  EXPECT_EQ(folder.entries(), before);
}

TEST(BadUsage, OfTheCommandLine) {
  const TemporaryFolder folder;
  folder.write(kFile, kGoodScene);
  expect_refusal({}, folder, {"subcommand"});
  expect_refusal(
      {"runn", kFile}, folder,
      {"butee runn: there is no such command (did you mean \"run\"?)", "check, modes, compare, study, plot"});
  expect_refusal({"run"}, folder, {"model"});
  expect_refusal({"run", kFile, "--stes", "a=1"}, folder, {"--stes"});
  expect_refusal({"run", kFile, "--repeat", "0"}, folder, {"--repeat"});
  expect_refusal({"run", kFile, "--progress", "sometimes"}, folder, {"--progress", "auto"});
  expect_refusal({"run", kFile, "-q", "-v"}, folder, {"-q", "-v"});
  expect_refusal({"run", kFile, "-o", ""}, folder, {"--output", "must not be empty"});
  expect_refusal({"check", kFile, "--picture", ""}, folder, {"--picture", "must not be empty"});
  expect_refusal({"run", kFile, "--plugin", "nowhere.so"}, folder, {"nowhere.so: there is no such module"});
  expect_refusal({"new-plugin", "rk4"}, folder, {"NAME = \"rk4\": is the name of another integrator"});
  expect_refusal({"new-plugin", "ring", "--kind", "contact"}, folder, {"\"ring\": is the name of another contact"});
  expect_refusal({"run", kFile, "--set", "gravity.acceleration=[-9.81, 0, 0]"}, folder,
                 {"gravity.acceleration", "acts along no displacement of the scene, which moves along"});
}

TEST(BadUsage, OfFiles) {
  const TemporaryFolder folder;
  folder.write("empty.toml", "");
  expect_refusal({"run", "nowhere.toml"}, folder, {"nowhere.toml: cannot be read"});
  expect_refusal({"run", "."}, folder, {".: is a folder; name the TOML file in it"});
  folder.write("compared.toml", "schema = 1\n[study]\nscenes = [\"a.toml\"]\n");
  folder.write("varied.toml", "schema = 1\nscene = \"a.toml\"\n[[vary]]\nkey = \"load[0].value\"\nvalues = [1.0]\n");
  expect_refusal({"run", "compared.toml"}, folder, {"compared.toml: is not a scene", "`butee compare`"});
  expect_refusal({"check", "compared.toml"}, folder, {"compared.toml: is not a scene", "`butee compare`"});
  expect_refusal({"run", "varied.toml"}, folder, {"varied.toml: is not a scene", "`butee study`"});
  expect_refusal(
      {"run", "empty.toml"}, folder,
      {"empty.toml:1: schema: missing", "empty.toml:1: element: missing", "empty.toml:1: integrator: missing"});
}

TEST(BadUsage, OfResultFolders) {
  const TemporaryFolder folder;
  folder.write(kFile, kGoodScene);
  folder.write("file", "");
  std::filesystem::create_directory(folder.file("precious"));
  folder.write("precious/model.toml", "mine\n");
  expect_refusal({"run", kFile, "-o", "file"}, folder, {"file: is a file, not a folder for results"});
  expect_refusal({"run", kFile, "-o", "precious"}, folder,
                 {"precious: is not empty and holds no results of butee",
                  "its model.toml does not begin with the line \"# butee: the model as run\""});
  std::filesystem::create_directory(folder.file("notes"));
  folder.write("notes/b.txt", "");
  folder.write("notes/a.txt", "");
  folder.write("notes/model.toml.part", "");
  expect_refusal({"run", kFile, "-o", "notes"}, folder, {"(it has no model.toml of a run, but a.txt and 1 more)"});
  std::filesystem::rename(folder.file("precious"), folder.file("scene-results"));
  expect_refusal({"run", kFile}, folder, {"scene-results: is not empty and holds no results of butee"});
  EXPECT_EQ(read_file(folder.file("scene-results/model.toml")), "mine\n");
}

TEST(BadUsage, LeavesEarlierResultsAlone) {
  const TemporaryFolder folder;
  folder.write(kFile, kGoodScene);
  ASSERT_EQ(run_program({"run", kFile, "-q", "--set", "integrator.end_time=1e-3"}, folder.path()).status, 0);
  const std::string before = read_file(folder.file("scene-results/history.csv"));
  expect_refusal({"run", kFile, "--set", "contact[0].gap=-1"}, folder, {"contact[0].gap = -1: must be >= 0 (m)"});
  EXPECT_EQ(read_file(folder.file("scene-results/history.csv")), before);
}

}  // namespace
}  // namespace butee::test::bad_usage_test
