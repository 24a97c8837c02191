#include "package.hpp"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test {

bool shell(const std::string& folder, const std::string& line) {
  const std::string log = folder + "/shell.log";
  const std::string whole = "cd '" + folder + "' && { " + line + "; } > '" + log + "' 2>&1 < /dev/null";
  if (std::system(whole.c_str()) == 0) return true;
  ADD_FAILURE() << line << "\n" << read_file(log);
  return false;
}

const std::string& package() {
  static const TemporaryFolder folder;
  static const std::string moved = [] {
    const std::string first = folder.file("first"), second = folder.file("second place");
    EXPECT_TRUE(shell(folder.path(), "cmake --install '" BUTEE_TEST_BUILD "' --prefix '" + first + "'"));
    std::filesystem::rename(first, second);
    return second;
  }();
  return moved;
}

}  // namespace butee::test
