#include "package.hpp"

#include <cstdlib>
#include <filesystem>
#include <regex>

#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::package_test {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& program) {
  return std::system(("command -v " + program + " > /dev/null").c_str()) == 0;
}

std::string configure_and_build() {
  return "cmake -B build -D CMAKE_PREFIX_PATH='" + package() + "' && cmake --build build";
}

class Package : public testing::Test {
 protected:
  void SetUp() override {
    if (!has("cmake")) GTEST_SKIP() << "cmake is not there";
  }
};

TEST_F(Package, RunsASceneFromWhereItWasMovedTo) {
  const TemporaryFolder folder;
  EXPECT_TRUE(shell(folder.path(), "'" + package() + "/bin/butee' run '" + package() +
                                       "/share/butee/models/beam1.toml' --set integrator.end_time=0.01 -o results"));
  EXPECT_TRUE(fs::exists(folder.file("results/history.csv")));
  // The installed package does not need the folder in which it was built.
  EXPECT_FALSE(fs::exists(package() + "/../first"));
}

class NewPlugin : public Package, public testing::WithParamInterface<const char*> {};

TEST_P(NewPlugin, BuildsPassesTheSuiteAndRunsAtOnce) {
  const TemporaryFolder folder;
  const std::string kind = GetParam();
  ASSERT_TRUE(shell(folder.path(), "'" + package() + "/bin/butee' new-plugin mine --kind " + kind));
  ASSERT_TRUE(shell(folder.file("mine"), configure_and_build()));
  EXPECT_TRUE(shell(folder.file("mine"), "ctest --test-dir build --output-on-failure"));
  EXPECT_TRUE(shell(folder.file("mine"), "'" + package() + "/bin/butee' plugins mine --plugin build/mine.so"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, NewPlugin, testing::Values("integrator", "law", "contact", "load", "element"),
                         [](const auto& one) { return one.param; });

TEST_F(Package, RefusesAModuleThatWasBuiltOtherwise) {
  const TemporaryFolder folder;
  ASSERT_TRUE(shell(folder.path(), "'" + package() + "/bin/butee' new-plugin mine --kind load"));
  // The build fails when the manifest is written, because the program refuses the module.
  const auto refused = [&](const std::string& flags, const std::string& reason) {
    const std::string line =
        "rm -rf build && cmake -B build -D CMAKE_PREFIX_PATH='" + package() + "' -D CMAKE_CXX_FLAGS='" + flags +
        "' && ! cmake --build build 2> errors && cat errors >> shell.out; cmake --build build 2>&1 | grep -F '" +
        reason + "'";
    EXPECT_TRUE(shell(folder.file("mine"), line)) << flags;
  };
  refused("-D_GLIBCXX_DEBUG", "checked standard library (_GLIBCXX_DEBUG) 1 instead of 0");
  refused("-DEIGEN_DEFAULT_TO_ROW_MAJOR", "Eigen layout");
}

TEST_F(Package, RefusesAModuleOfAnotherInterfaceVersion) {
  const TemporaryFolder folder;
  ASSERT_TRUE(shell(folder.path(), "'" + package() + "/bin/butee' new-plugin mine --kind load"));
  // Simulates headers of another version.
  const std::string copy = folder.file("other");
  fs::copy(package(), copy, fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  ASSERT_TRUE(shell(folder.path(),
                    "sed -i 's/define BUTEE_INTERFACE_VERSION .*/define BUTEE_INTERFACE_VERSION 99/' "
                    "other/include/butee/version.hpp"));
  EXPECT_TRUE(
      shell(folder.file("mine"), "cmake -B build -D CMAKE_PREFIX_PATH='" + copy +
                                     "' && cmake --build build 2>&1 | grep -F 'interface version 99 instead of'"));
}

TEST_F(Package, HasExamplesThatRun) {
  const TemporaryFolder folder;
  fs::copy(package() + "/share/butee/examples", folder.file("examples"), fs::copy_options::recursive);
  ASSERT_TRUE(shell(folder.file("examples"), configure_and_build()));
  EXPECT_TRUE(shell(folder.file("examples"), "ctest --test-dir build --output-on-failure"));
  EXPECT_EQ(has("gfortran"), fs::exists(folder.file("examples/build/coupled_beam")));
}

/// The documents keep their folders, so that links between them, and to pictures, lead somewhere.
TEST_F(Package, HasDocumentsWhoseLinksLeadSomewhere) {
  const fs::path documents = package() + "/share/doc/butee";
  for (const char* name : {"README.md", "CHANGELOG.md", "apps/tutorial.md", "plugins/tutorial.md",
                           "framework/embed/README.md", "plugins/exponential/THEORY.md"})
    EXPECT_TRUE(fs::is_regular_file(documents / name)) << name;
  const std::regex link(R"(\]\(([^)#:]+)(#[^)]*)?\))");
  int links = 0;
  for (const auto& entry : fs::recursive_directory_iterator(documents)) {
    if (entry.path().extension() != ".md") continue;
    const std::string text = read_file(entry.path().string());
    for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at, ++links)
      EXPECT_TRUE(fs::exists(entry.path().parent_path() / (*at)[1].str())) << entry.path() << ": " << (*at)[1];
  }
  EXPECT_GT(links, 100);
}

TEST_F(Package, IsFoundByPkgConfig) {
  if (!has("pkg-config") || !has("cc")) GTEST_SKIP() << "pkg-config is not there";
  const TemporaryFolder folder;
  folder.write("version.c",
               "#include <butee.h>\n#include <stdio.h>\nint main(void) { return puts(butee_version()) < 0; }\n");
  // A path without blanks, because pkg-config's output does not support them.
  fs::create_directory_symlink(package(), folder.file("package"));
  EXPECT_TRUE(shell(folder.path(),
                    "export PKG_CONFIG_PATH=$(dirname $(find -L package -name butee.pc)) && "
                    "cc version.c $(pkg-config --cflags --libs butee) -Wl,-rpath,$(pkg-config --variable=libdir butee) "
                    "-o version && ./version | grep -x \"$(pkg-config --modversion butee)\""));
}

}  // namespace
}  // namespace butee::test::package_test
