#include <filesystem>

#include <butee/core/error.hpp>
#include <butee/core/target.hpp>
#include <butee/record/checkpoint.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::checkpoint_test {
namespace {

namespace fs = std::filesystem;
using record::Checkpoint;

class Checkpoints : public testing::Test {
 protected:
  Checkpoints() {
    temporary_.write("model.toml", "the model");
    temporary_.write("history.csv", "t,u\n0,0\n1,1\n");
  }

  Checkpoint at(double t, std::uint64_t history = 8) const {
    Checkpoint checkpoint;
    checkpoint.method = "rk4";
    checkpoint.model = folder_.checksum_of("model.toml");
    checkpoint.history = history;
    checkpoint.counters.solves = 11;
    checkpoint.snapshot.state.t = t;
    checkpoint.snapshot.state.x = Vector::LinSpaced(3, 0.1, t);
    checkpoint.snapshot.report.message = "on its way";
    return checkpoint;
  }

  void damage(const std::string& name) const {
    std::string text = read_file(temporary_.file(name));
    text[text.size() / 2] = static_cast<char>(text[text.size() / 2] ^ 1);
    temporary_.write(name, text);
  }

  TemporaryFolder temporary_;
  record::ResultFolder folder_{temporary_.path()};
  record::CheckpointFolder checkpoints_{folder_};
};

TEST_F(Checkpoints, ComeBackAsTheyWent) {
  EXPECT_FALSE(checkpoints_.newest());
  checkpoints_.write(at(1.0));
  checkpoints_.write(at(2.0));
  const auto newest = checkpoints_.newest();
  ASSERT_TRUE(newest);
  EXPECT_EQ(newest->method, "rk4");
  EXPECT_EQ(newest->counters.solves, 11);
  EXPECT_EQ(newest->snapshot.state.t, 2.0);
  EXPECT_TRUE(newest->snapshot.state.x == at(2.0).snapshot.state.x);
  EXPECT_EQ(newest->snapshot.report.message, "on its way");
  checkpoints_.clear();
  EXPECT_EQ(temporary_.entries(), (std::vector<std::string>{"history.csv", "model.toml"}));
}

TEST_F(Checkpoints, ADamagedOneIsTakenAwayAndTheOneBeforeItIsUsed) {
  checkpoints_.write(at(1.0));
  checkpoints_.write(at(2.0));
  damage("checkpoint.bin");
  EXPECT_EQ(checkpoints_.newest()->snapshot.state.t, 1.0);
  EXPECT_FALSE(fs::exists(temporary_.file("checkpoint.bin")));
  checkpoints_.write(at(3.0));
  damage("checkpoint.bin");
  EXPECT_EQ(checkpoints_.newest()->snapshot.state.t, 1.0);
  damage("checkpoint-before.bin");
  EXPECT_FALSE(checkpoints_.newest());
}

/// A kill between the two renames, or while the draft is being written.
TEST_F(Checkpoints, AHalfWrittenOneIsNoHindrance) {
  checkpoints_.write(at(1.0));
  fs::rename(temporary_.file("checkpoint.bin"), temporary_.file("checkpoint-before.bin"));
  temporary_.write("checkpoint-next.bin", "half");
  EXPECT_EQ(checkpoints_.newest()->snapshot.state.t, 1.0);
  checkpoints_.write(at(2.0));
  EXPECT_EQ(checkpoints_.newest()->snapshot.state.t, 2.0);
}

TEST_F(Checkpoints, OneBeyondTheHistoryIsNotUsed) {
  checkpoints_.write(at(1.0, 8));
  checkpoints_.write(at(2.0, 1000));
  EXPECT_EQ(checkpoints_.newest()->snapshot.state.t, 1.0);
}

TEST_F(Checkpoints, AnotherModelIsBadInput) {
  checkpoints_.write(at(1.0));
  temporary_.write("model.toml", "another model");
  EXPECT_THROW(checkpoints_.newest(), InputError);
}

TEST_F(Checkpoints, AnotherInstructionSetIsBadInput) {
  Checkpoint other = at(1.0);
  EXPECT_EQ(other.target, target());
  const auto refused = [&] {
    checkpoints_.write(other);
    try {
      (void)checkpoints_.newest();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  other.target = "mmx";
  EXPECT_NE(refused().find("this processor has no mmx"), std::string::npos) << refused();
  if (targets().size() > 1) {
    other.target = targets().back() == target() ? targets().front() : targets().back();
    EXPECT_NE(refused().find("set BUTEE_TARGET=" + other.target), std::string::npos) << refused();
  }
  other = at(1.0);
  other.compiled_for = "i386";
  EXPECT_NE(refused().find("compiled for i386"), std::string::npos) << refused();
}

/// A change of any single byte, and any truncation, is detected.
TEST_F(Checkpoints, NoDamagePasses) {
  const std::vector<std::byte> whole = to_bytes(at(1.0));
  EXPECT_NO_THROW(record::to_checkpoint(whole));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::vector<std::byte> damaged = whole;
    damaged[i] ^= std::byte{0x10};
    EXPECT_ANY_THROW(record::to_checkpoint(damaged)) << i;  // InputError if it looks like another version
    EXPECT_THROW(record::to_checkpoint(std::span(whole).first(i)), RunError) << i;
  }
}

}  // namespace
}  // namespace butee::test::checkpoint_test
