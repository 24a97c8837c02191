#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include <butee/study/dealer.hpp>
#include <butee/study/worker.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"

namespace butee::test::study_follow_test {
namespace {

/// A mass between a weak spring and a support that holds it by a stick spring, under a constant and a
/// harmonic force below the friction limit of 5 N.
constexpr const char* kHeld = R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 100.0
damping = 2.0
[[contact]]
type = "friction"
nodes = "m"
dof = "u"
normal_force = 10.0
friction = { coefficient = 0.5, stick_stiffness = 1e4, stick_damping = 20.0 }
[[load]]
type = "constant"
node = "m"
value = 3.0
[[load]]
type = "harmonic"
node = "m"
amplitude = 0.5
angular_frequency = 6.0
[integrator]
type = "dopri5"
tolerance = 1e-9
)";

struct Bound {
  explicit Bound(const TemporaryFolder& folder) : study(study::load_study(folder.file("study.toml"))) {}
  study::Study study;
  study::Layout layout = layout_of(study);
};

std::vector<double> entries(const study::Layout& layout, const study::Row& row, const std::string& name) {
  const std::size_t column = layout.find(name);
  EXPECT_EQ(row.text(layout.find(study::kStatusColumn)), "completed") << row.text(layout.find(study::kReasonColumn));
  std::vector<double> values;
  for (std::size_t k = 0; k < layout.columns()[column].length; ++k) values.push_back(row.number(column, k));
  return values;
}

TEST(StudyFollow, CarriesTheMemoryOfStickSprings) {
  const TemporaryFolder folder;
  folder.write("scene.toml", kHeld);
  // The same value three times: such a sweep is equivalent to one long run.
  folder.write("study.toml",
               "schema = 1\nscene = \"scene.toml\"\n[[vary]]\nkey = \"load[0].value\"\nvalues = [3.0, 3.0, 3.0]\n"
               "[study]\nfollow = \"up\"\nsettle = 0\nperiods = 4\ncollect = [\"section m.u\", \"wear\"]\n");
  const Bound sweep(folder);
  study::Worker worker(sweep.study, sweep.layout);
  study::Motion motion;
  std::vector<double> all;
  for (int run = 0; run < 3; ++run) {
    const auto row = worker.perform(run, motion, [] { return true; });
    for (const double u : entries(sweep.layout, *row, "section m.u")) all.push_back(u);
  }
  EXPECT_EQ(motion.contact.size(), 3);
  folder.write("study.toml",
               "schema = 1\nscene = \"scene.toml\"\n[study]\nperiods = 12\ncollect = [\"section m.u\"]\n");
  const Bound whole(folder);
  study::Worker alone(whole.study, whole.layout);
  study::Motion none;
  const auto expected = entries(whole.layout, *alone.perform(0, none, [] { return true; }), "section m.u");
  ASSERT_EQ(all.size(), expected.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(all[i], expected[i], 1e-8) << i;
  // Without the stick spring's memory the mass moves on by some 3 N / 1e4 N/m.
  motion.contact.resize(0);
  const auto forgetful = entries(sweep.layout, *worker.perform(2, motion, [] { return true; }), "section m.u");
  EXPECT_GT(forgetful.back() - expected.back(), 1e-4);
}

/// A belt at 0.1 m/s under a mass held by a spring and a dashpot: the sliding speed is that of the belt, the
/// work F_n w T = 10 N 0.1 m/s 2 s.
TEST(StudyResults, WearIsTheWorkOfRubbing) {
  const TemporaryFolder folder;
  std::string scene = kHeld;
  scene.replace(scene.find("stick_stiffness = 1e4, stick_damping = 20.0"), 43,
                "slip_speed = 1e-4, surface_speed = 0.1");
  scene.replace(scene.find("amplitude = 0.5"), 15, "amplitude = 0.0");
  folder.write("scene.toml", scene);
  folder.write("study.toml",
               "schema = 1\nscene = \"scene.toml\"\n[study]\nperiod = 2.0\nsettle = 10\nperiods = 1\n"
               "collect = [\"wear\", \"impacts\"]\n");
  const Bound bound(folder);
  study::Worker worker(bound.study, bound.layout);
  study::Motion motion;
  const auto row = worker.perform(0, motion, [] { return true; });
  EXPECT_NEAR(entries(bound.layout, *row, "wear")[0], 2.0, 1e-6);
  EXPECT_EQ(entries(bound.layout, *row, "impacts")[0], 0.0);
}

/// A team of threads in one process.
class Together final : public study::Team {
 public:
  explicit Together(std::atomic<std::int64_t>& shared) : shared_(shared) {}
  int rank() const override { return 0; }
  int size() const override { return 3; }
  int agree(int status) override { return status; }
  std::int64_t add(std::int64_t count) override {
    ++calls;
    return shared_.fetch_add(count);
  }
  void serve() override {}

  std::atomic<int> calls{0};

 private:
  std::atomic<std::int64_t>& shared_;
};

TEST(StudyDealer, HandsOutEachChainOnceAndToWhoeverIsFree) {
  constexpr std::int64_t kCount = 2000;
  std::atomic<std::int64_t> shared{0};
  std::vector<int> taken(kCount, 0);
  std::vector<std::int64_t> by_process(3, 0);
  std::mutex mutex;
  std::atomic<bool> first_is_held{false}, others_are_done{false};
  int calls = 0;
  std::vector<std::thread> processes;
  for (std::size_t p = 0; p < 3; ++p)
    processes.emplace_back([&, p] {
      Together team(shared);
      study::Dealer dealer(team, kCount, 1);
      while (p > 0 && !first_is_held) std::this_thread::yield();
      for (std::int64_t chain = dealer.next(); chain < kCount; chain = dealer.next()) {
        {
          const std::lock_guard guard(mutex);
          ++taken[static_cast<std::size_t>(chain)];
          ++by_process[p];
        }
        // The first process waits in its first chain until the others have done all the rest.
        if (p == 0) first_is_held = true;
        while (p == 0 && !others_are_done) std::this_thread::yield();
      }
      const std::lock_guard guard(mutex);
      calls += team.calls;
      if (p > 0 && by_process[1] + by_process[2] == kCount - 1) others_are_done = true;
    });
  for (std::thread& process : processes) process.join();
  for (const int count : taken) EXPECT_EQ(count, 1);
  EXPECT_EQ(by_process[0], 1);
  // Short chains are assigned in portions.
  EXPECT_LT(calls, 300);
}

}  // namespace
}  // namespace butee::test::study_follow_test
