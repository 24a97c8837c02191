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

const std::vector<std::string> kRooms = {"core", "config", "model", "linalg", "dynamics", "time", "record"};

/// The rooms of the framework that a folder may include.
Names allowed_rooms(const std::string& folder) {
  const auto up_to = [](const std::string& last) {
    Names rooms;
    for (const std::string& room : kRooms) {
      rooms.insert(room);
      if (room == last) break;
    }
    return rooms;
  };
  if (folder == "framework/plugin") return {"core", "config", "model", "linalg", "dynamics", "time", "plugin"};
  if (folder == "framework/embed")
    return {"core", "config", "model", "linalg", "dynamics", "time", "record", "plugin", "embed"};
  if (folder == "framework/linalg") return {"core", "linalg"};
  if (folder.rfind("framework/", 0) == 0) return up_to(folder.substr(10));
  if (folder == "elements" || folder == "contact") return up_to("model");
  if (folder == "integrators") return up_to("time");
  if (folder == "plugins") return {"core", "model", "plugin"};
  return {"core", "config", "model", "linalg", "dynamics", "time", "record", "plugin", "embed"};
}

/// Third-party headers and the only files, or folders, that may include them.
const std::map<std::string, Names> kDoors = {
    {"suitesparse/", {"framework/linalg/symmetric_factor.cpp", "framework/linalg/general_factor.cpp"}},
    {"toml.hpp", {"framework/config/toml.cpp"}},
    {"dlfcn.h", {"framework/plugin/module.cpp"}},
    {"spdlog/", {"framework/core/log.cpp"}},
    {"nlohmann/", {"framework/record/summary.cpp", "apps/"}},
    {"Spectra/", {"framework/linalg/lanczos.cpp", "framework/dynamics/whirl.cpp"}},
    {"CLI/", {"apps/"}},
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
    const std::string& target = include.target;
    const bool known =
        target.rfind("butee/", 0) == 0 || target.rfind("Eigen/", 0) == 0 || std::regex_match(target, standard);
    EXPECT_TRUE(known) << include.file << " includes " << target;
  }
}

}  // namespace
}  // namespace butee::test::include_rules_test
