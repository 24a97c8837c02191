#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "conformance/methods.hpp"
#include "support/large_scenes.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::reproducible_test {
namespace {

using Json = nlohmann::json;

Json without_times(const std::string& path) {
  Json json = Json::parse(read_file(path));
  json.erase("setup_seconds");
  json.erase("wall_seconds");
  return json;
}

/// Runs twice with different environments, which shifts the stack.
void expect_the_same_twice(const TemporaryFolder& folder, const std::vector<std::string>& set = {}) {
  for (const char* name : {"one", "two"}) {
    std::vector<std::string> arguments = {"run", "scene.toml", "-q", "-o", name};
    for (const std::string& assignment : set) arguments.insert(arguments.end(), {"--set", assignment});
    const std::string padding = "PADDING=" + std::string(name == std::string("one") ? 1 : 1037, 'x');
    const Outcome outcome = run_program(arguments, folder.path(), {padding});
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
  }
  for (const char* file : {"/history.csv", "/impacts.csv", "/model.toml"}) {
    if (!std::filesystem::exists(folder.file(std::string("one") + file))) continue;
    EXPECT_TRUE(read_file(folder.file(std::string("one") + file)) == read_file(folder.file(std::string("two") + file)))
        << file;
  }
  EXPECT_EQ(without_times(folder.file("one/summary.json")), without_times(folder.file("two/summary.json")));
}

class Reproducible : public testing::TestWithParam<MethodCase> {};

TEST_P(Reproducible, TwoRunsGiveTheSameFiles) {
  const TemporaryFolder folder;
  const MethodCase& method = GetParam();
  folder.write("scene.toml",
               "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\n"
               "radius = 0.02\n"
               "[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 4.0\n"
               "elements = 6\n[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n"
               "[[contact]]\ntype = \"stop\"\nnodes = \"b:all\"\ngap = 1e-3\nstiffness = 1e6\nlaw = \"linear\"\n"
               "[[load]]\ntype = \"harmonic\"\nnode = \"b:middle\"\namplitude = 500.0\nangular_frequency = 60.0\n"
               "[damping]\nmass_proportional = 0.5\n"
               "[initial]\nvelocity = [{nodes = \"b:1..5\", value = 0.8}]\n"
               "[integrator]\ntype = \"" +
                   method.name + "\"\ntime_step = 1e-5\nend_time = 5e-3\n" + method.keys +
                   "[output]\ninterval = 1e-4\nenergy = true\nimpacts = true\n");
  expect_the_same_twice(folder);
}

std::vector<MethodCase> all_methods() {
  std::vector<MethodCase> all = method_cases();
  if (std::filesystem::exists(std::string(BUTEE_TEST_PLUGINS) + "/sundials.so"))
    for (const char* name : {"cvode_bdf", "cvode_adams", "arkode_erk", "arkode_dirk"}) all.push_back({name, "", 0.0});
  return all;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Reproducible, testing::ValuesIn(all_methods()),
                         [](const auto& one) { return one.param.name; });

/// A mesh without a narrow band; its matrices are factorized by CHOLMOD.
TEST(Reproducible, ALargeSceneGivesTheSameFilesTwice) {
  const TemporaryFolder folder;
  folder.write("scene.toml", tied_beams(elements_of_tied_beams(2000)));
  for (const char* method : {"newmark", "rodas4"})
    expect_the_same_twice(folder, {"integrator.end_time=5e-3", std::string("integrator.type=") + method});
}

}  // namespace
}  // namespace butee::test::reproducible_test
