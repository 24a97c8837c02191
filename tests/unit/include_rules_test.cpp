#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::include_rules_test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

Names with(Names names, const Names& others) {
  names.insert(others.begin(), others.end());
  return names;
}

const Names kAllRooms = {"core",   "config", "model",  "linalg", "dynamics", "time",
                         "plugin", "scene",  "record", "run",    "study",    "embed"};

/// The framework folders from which a folder may include headers.
Names allowed_rooms(const std::string& folder) {
  static const Names to_model = {"core", "config", "model"},
                     to_time = {"core", "config", "model", "linalg", "dynamics", "time"};
  static const std::map<std::string, Names> rules = {
      {"framework/core", {"core"}},
      {"framework/config", {"core", "config"}},
      {"framework/model", to_model},
      {"framework/linalg", {"core", "linalg"}},
      {"framework/dynamics", {"core", "config", "model", "linalg", "dynamics"}},
      {"framework/time", to_time},
      {"framework/plugin", with(to_time, {"plugin"})},
      {"framework/scene", with(to_time, {"plugin", "scene"})},
      {"framework/record", with(to_time, {"record"})},
      {"framework/run", with(to_time, {"plugin", "scene", "record", "run"})},
      {"framework/study", with(to_time, {"plugin", "scene", "record", "study"})},
      {"framework/embed", kAllRooms},
      {"framework/python", with(kAllRooms, {"python"})},
      {"elements", to_model},
      {"contact", to_model},
      {"integrators", to_time},
      {"plugins", {"core", "model", "dynamics", "plugin", "study"}},
      {"apps", kAllRooms}};
  return rules.at(folder);
}

/// Third-party headers, and the only files or folders that may include them.
const std::map<std::string, Names> kDoors = {
    {"suitesparse/", {"framework/linalg/symmetric_factor.cpp", "framework/linalg/general_factor.cpp"}},
    {"toml.hpp", {"framework/config/toml.cpp"}},
    {"dlfcn.h", {"framework/plugin/module.cpp"}},
    {"spdlog/", {"framework/core/log.cpp"}},
    {"nlohmann/", {"framework/record/summary.cpp", "apps/"}},
    {"Spectra/", {"framework/linalg/lanczos.cpp", "framework/dynamics/whirl.cpp"}},
    {"CLI/", {"apps/"}},
    {"pybind11/", {"framework/python/"}},
    {"hwy/", {"framework/core/target.cpp", "framework/linalg/kernel/", "framework/dynamics/kernel/"}},
};

struct Include {
  std::string file, folder, target;
};

std::string folder_of(const std::string& file) {
  const auto first = file.find('/');
  if (file.substr(0, first) != "framework") return file.substr(0, first);
  const auto second = file.find('/', first + 1);
  return second == std::string::npos ? "framework" : file.substr(0, second);
}

std::vector<Include> all_includes() {
  std::vector<Include> found;
  const fs::path root = BUTEE_TEST_SOURCE;
  const std::regex pattern("^#include [<\"]([^>\"]+)[>\"]");
  for (const char* top : {"framework", "elements", "contact", "integrators", "plugins", "apps"})
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      const std::string file = fs::relative(entry.path(), root).string();
      std::istringstream lines(read_file(entry.path().string()));
      for (std::string line; std::getline(lines, line);)
        if (std::smatch match; std::regex_search(line, match, pattern))
          found.push_back({file, folder_of(file), match[1]});
    }
  return found;
}

TEST(IncludeRules, RoomsLookOnlyWhereTheyMay) {
  int checked = 0;
  for (const Include& include : all_includes()) {
    if (include.target.rfind("butee/", 0) != 0) continue;
    const auto slash = include.target.find('/', 6);
    if (slash == std::string::npos) continue;  // <butee/export.hpp>, <butee/version.hpp>
    const std::string room = include.target.substr(6, slash - 6);
    EXPECT_TRUE(allowed_rooms(include.folder).count(room) > 0) << include.file << " includes " << include.target;
    ++checked;
  }
  EXPECT_GT(checked, 100);
}

TEST(IncludeRules, FoldersKnowEachOtherOnlyWhereTheyMay) {
  const std::map<std::string, Names> allowed = {{"elements", {"elements", "framework/plugin"}},
                                                {"contact", {"contact", "framework/plugin"}},
                                                {"integrators", {"integrators", "plugins"}}};
  int checked = 0;
  for (const Include& include : all_includes()) {
    const auto rule = allowed.find(include.target.substr(0, include.target.find('/')));
    if (rule == allowed.end()) continue;
    EXPECT_TRUE(rule->second.count(include.folder) > 0) << include.file << " includes " << include.target;
    if (include.folder == "framework/plugin") {
      EXPECT_EQ(include.file, "framework/plugin/builtin.cpp");
    }
    ++checked;
  }
  EXPECT_GT(checked, 20);
}

/// For each folder, the other folders from which it includes headers.
std::map<std::string, Names> folder_graph() {
  std::map<std::string, Names> graph;
  for (const Include& include : all_includes()) {
    const bool in_framework = include.target.rfind("butee/", 0) == 0;
    const std::string to = folder_of(in_framework ? "framework/" + include.target.substr(6) : include.target);
    if (to != include.folder && to != "framework") graph[include.folder].insert(to);
  }
  return graph;
}

/// Extends `way` along includes until a folder repeats; false if there is no cycle.
bool comes_back(const std::map<std::string, Names>& graph, std::vector<std::string>& way) {
  const auto next = graph.find(way.back());
  if (next == graph.end()) return false;
  for (const std::string& folder : next->second) {
    const bool is_met = std::find(way.begin(), way.end(), folder) != way.end();
    way.push_back(folder);
    if (is_met || comes_back(graph, way)) return true;
    way.pop_back();
  }
  return false;
}

TEST(IncludeRules, FoldersDoNotIncludeEachOtherInACircle) {
  const auto graph = folder_graph();
  EXPECT_GT(graph.size(), kAllRooms.size());
  for (const auto& [folder, targets] : graph) {
    std::vector<std::string> way = {folder};
    std::string text;
    if (comes_back(graph, way))
      for (const std::string& name : way) text += " -> " + name;
    EXPECT_EQ(text, "");
  }
}

TEST(IncludeRules, TheModelKnowsNoToml) {
  const Names known = {"butee/config/number_file.hpp", "butee/config/parameter.hpp", "butee/config/parameters.hpp"};
  int checked = 0;
  for (const Include& include : all_includes()) {
    if (include.folder != "framework/model" || include.target.rfind("butee/config/", 0) != 0) continue;
    EXPECT_TRUE(known.contains(include.target)) << include.file << " includes " << include.target;
    ++checked;
  }
  EXPECT_GT(checked, 0);
}

TEST(IncludeRules, LibrariesStandBehindOneDoor) {
  std::map<std::string, int> seen;
  for (const Include& include : all_includes())
    for (const auto& [library, places] : kDoors) {
      if (include.target.rfind(library, 0) != 0) continue;
      const bool may = std::any_of(places.begin(), places.end(), [&](const std::string& place) {
        return place.back() == '/' ? include.file.rfind(place, 0) == 0 : include.file == place;
      });
      EXPECT_TRUE(may) << include.file << " includes " << include.target;
      ++seen[library];
    }
  EXPECT_EQ(seen.size(), kDoors.size());
}

TEST(IncludeRules, EigenIsTheOnlyLibraryInInstalledHeaders) {
  const std::regex standard("^[a-z_0-9]+$");
  for (const Include& include : all_includes()) {
    if (include.folder.rfind("framework", 0) != 0 || fs::path(include.file).extension() != ".hpp") continue;
    if (include.folder == "framework/python") continue;  // not installed
    const std::string& target = include.target;
    const bool known =
        target.rfind("butee/", 0) == 0 || target.rfind("Eigen/", 0) == 0 || std::regex_match(target, standard);
    EXPECT_TRUE(known) << include.file << " includes " << target;
  }
}

}  // namespace
}  // namespace butee::test::include_rules_test
