#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "package.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::run_path_test {
namespace {

/// The bracketed values of `readelf -d` lines with `tag`, by file, for all programs, libraries and modules in
/// `tree`.
std::map<std::string, std::vector<std::string>> entries(const std::string& tree, const std::string& tag) {
  const TemporaryFolder folder;
  EXPECT_TRUE(shell(folder.path(), "find '" + tree +
                                       "' -type f \\( -perm -u+x -o -name '*.so*' \\) -exec readelf -dW {} + "
                                       "> dynamic 2> /dev/null || true"));
  std::map<std::string, std::vector<std::string>> found;
  std::istringstream lines(read_file(folder.file("dynamic")));
  std::string file;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("File: ", 0) == 0) found[file = line.substr(6)];
    if (const auto open = line.find('['); open != std::string::npos && line.find(tag) != std::string::npos)
      found[file].push_back(line.substr(open + 1, line.find(']') - open - 1));
  }
  return found;
}

/// Every entry of a run-time search path must be a folder that does not depend on the current folder.
void check_run_paths(const std::string& tree, std::size_t least) {
  std::size_t checked = 0;
  for (const char* tag : {"(RUNPATH)", "(RPATH)"})
    for (const auto& [file, paths] : entries(tree, tag))
      for (const std::string& path : paths) {
        ++checked;
        for (std::size_t begin = 0; begin <= path.size();) {
          const std::size_t end = std::min(path.find(':', begin), path.size());
          const std::string entry = path.substr(begin, end - begin);
          EXPECT_TRUE(entry.rfind("$ORIGIN", 0) == 0 || entry.rfind('/', 0) == 0) << file << ": [" << path << "]";
          begin = end + 1;
        }
      }
  EXPECT_GE(checked, least) << tree;
}

TEST(RunPath, HasNoEntryForTheCurrentFolderInTheBuildTree) {
  check_run_paths(BUTEE_TEST_BUILD, 20);
}

TEST(RunPath, HasNoEntryForTheCurrentFolderInThePackage) {
  check_run_paths(package(), 15);
}

TEST(RunPath, TheProgramTakesNoLibraryFromTheCurrentFolder) {
  const TemporaryFolder folder;
  std::set<std::string> names;
  for (const auto& [file, libraries] : entries(BUTEE_TEST_BUILD "/lib", "(NEEDED)"))
    names.insert(libraries.begin(), libraries.end());
  EXPECT_TRUE(names.contains("libbutee.so.0"));
  EXPECT_GT(names.size(), 3U);
  for (const std::string& name : names) folder.write(name, "no library");
  const Outcome outcome = run_program({"plugins", "rk4"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
}

}  // namespace
}  // namespace butee::test::run_path_test
