#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include <butee/core/error.hpp>
#include <butee/study/perform.hpp>
#include <butee/study/stream.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"

namespace butee::test::study_stream_test {
namespace {

constexpr const char* kScene = R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[initial]
velocity = [{ nodes = "m", dof = "u", value = 1.0 }]
[[contact]]
type = "stop"
nodes = "m"
gap = 0.1
stiffness = 100.0
law = "linear"
[integrator]
type = "newmark"
end_time = 0.1
time_step = 1e-3
)";

/// Rows that cannot be written end the answers while the sender of the points waits for them.
TEST(StreamedPoints, EndIfRowsCannotBeWrittenWhileTheSenderWaits) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kScene);
  folder.write("study.toml",
               "schema = 1\nscene = \"scene.toml\"\n[[vary]]\nkey = \"contact[0].gap\"\nvalues = [1.0]\n[study]\n"
               "collect = [\"peak m.u\"]\n");
  const study::Study study = study::load_study(folder.file("study.toml"));
  for (const int threads : {1, 3}) {
    using Clock = std::chrono::steady_clock;
    int given = 0;
    std::atomic<bool> is_waiting = false, was_told = false;
    const auto wait_for = [](const auto& condition) {
      for (const auto limit = Clock::now() + std::chrono::seconds(20); Clock::now() < limit && !condition();)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    const auto next = [&](std::string& line, const std::function<bool()>& is_wanted) {
      line = "0.5";
      if (given++ == 0) return true;
      is_waiting = true;
      wait_for([&] { return was_told = !is_wanted(); });
      return false;
    };
    std::atomic<int> written = 0;
    const auto respond = [&](const std::string& row) {
      if (written++ == 0) return;  // the header
      EXPECT_NE(row.find(",completed,"), std::string::npos) << row;
      wait_for([&] { return is_waiting.load(); });
      throw RunError("the results cannot be written");
    };
    EXPECT_THROW(study::answer(study, streamed_layout(study), threads, {next, respond, {}}), RunError);
    EXPECT_TRUE(was_told) << threads;
  }
}

}  // namespace
}  // namespace butee::test::study_stream_test
