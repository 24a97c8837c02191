#include "butee/record/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::progress_test {
namespace {

using namespace std::chrono_literals;

const std::string kScene = kHeader + mass("ball", "2.0") +
                           "\n[[element]]\ntype = \"spring\"\nnode = \"ball\"\nstiffness = 200.0\n"
                           "[[contact]]\ntype = \"stop\"\nnodes = \"ball\"\ngap = 0.01\nstiffness = 1e4\n"
                           "[initial]\ndisplacement = [{ nodes = \"ball\", dof = \"u\", value = 0.009 }]\n";

/// The output of a run of 1000 steps.
std::string written(bool bar, std::chrono::steady_clock::duration silence, int width = 80,
                    const std::vector<std::string>& overrides = {}) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  SceneRun run(kScene, overrides);
  record::Progress progress(run.dynamics(), 1.0, {bar, file.get(), silence, 0ms, width});
  run.simulation().add(progress);
  run.run();
  std::string text(static_cast<std::size_t>(std::ftell(file.get())), '\0');
  std::rewind(file.get());
  EXPECT_EQ(std::fread(text.data(), 1, text.size(), file.get()), text.size());
  return text;
}

TEST(Progress, ABarSaysWhereTheRunIsAndTakesItselfAway) {
  const std::string text = written(true, 0ms);
  for (const char* part : {"\r[", " %  t = ", " of 1 s", "h = 1.0e-03 s", " left"})
    EXPECT_TRUE(holds(text, part)) << part << " in " << text;
  EXPECT_FALSE(holds(text, "\n"));
  const std::string wiped = "\r\033[K";
  ASSERT_GE(text.size(), wiped.size());
  EXPECT_EQ(text.substr(text.size() - wiped.size()), wiped);
}

TEST(Progress, ABarFitsTheTerminal) {
  for (const int width : {40, 60, 80, 200}) {
    const std::string text = written(true, 0ms, width);
    for (std::size_t begin = text.find("\r["); begin != std::string::npos; begin = text.find("\r[", begin + 1))
      EXPECT_LT(text.find("\033[K", begin) - begin - 1, static_cast<std::size_t>(width)) << text;  // \r has no width
  }
  EXPECT_TRUE(holds(written(true, 0ms, 200), "0 of 1 stops closed"));
}

TEST(Progress, SaysNothingOfAShortRun) {
  EXPECT_EQ(written(true, 1h), "");
}

TEST(Progress, ALogGetsWholeLinesAndTheEnd) {
  const std::string text = written(false, 1h);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_TRUE(holds(text, "100 %  t = 1 of 1 s")) << text;
  EXPECT_TRUE(holds(text, "steps/s")) << text;
  EXPECT_FALSE(holds(text, "\r"));
  const std::string often = written(false, 0ms);
  EXPECT_GT(std::count(often.begin(), often.end(), '\n'), 1);
}

/// The step is far beyond the stability limit, so the run fails midway.
TEST(Progress, AFailedRunLeavesNoBar) {
  const std::string text = written(true, 0ms, 80, {"integrator.type=rk4", "element[1].stiffness=1e9"});
  const std::string wiped = "\r\033[K";
  ASSERT_GE(text.size(), wiped.size());
  EXPECT_EQ(text.substr(text.size() - wiped.size()), wiped);
}

}  // namespace
}  // namespace butee::test::progress_test
