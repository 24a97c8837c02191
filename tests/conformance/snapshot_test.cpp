#include <butee/core/error.hpp>
#include <butee/record/history.hpp>
#include <butee/time/snapshot.hpp>
#include <gtest/gtest.h>

#include "conformance/methods.hpp"
#include "support/scene_run.hpp"

namespace butee::test::snapshot_test {
namespace {

/// A short pinned beam that strikes its stops early, driven off its natural periods.
std::string scene_of(const MethodCase& method) {
  return "schema = 1\n[material.s]\nyoung_modulus = 2e11\ndensity = 7900\n[section.c]\nshape = \"circle\"\n"
         "radius = 0.02\n"
         "[[element]]\ntype = \"beam\"\nname = \"b\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 4.0\nelements = 6\n"
         "[[support]]\nnodes = [\"b:first\", \"b:last\"]\nfix = [\"u\"]\n"
         "[[contact]]\ntype = \"stop\"\nnodes = \"b:all\"\ngap = 1e-3\nstiffness = 1e6\nlaw = \"linear\"\n"
         "[[load]]\ntype = \"harmonic\"\nnode = \"b:middle\"\namplitude = 500.0\nangular_frequency = 60.0\n"
         "[damping]\nmass_proportional = 0.5\n"
         "[initial]\nvelocity = [{nodes = \"b:1..5\", value = 0.8}]\n"
         "[integrator]\ntype = \"" +
         method.name + "\"\ntime_step = 2e-5\nend_time = 1e-2\n" + method.keys +
         "[output]\ninterval = 1e-4\nenergy = true\nimpacts = true\n";
}

/// A run with all observers.
struct Watched {
  explicit Watched(const MethodCase& method)
      : run(scene_of(method)),
        request(read_scene(scene_of(method)).output),
        history(request, 1e-2, run.dynamics(), nullptr),
        energy(run.dynamics()),
        impacts(run.dynamics()) {
    for (time::Observer* observer : std::initializer_list<time::Observer*>{&history, &energy, &impacts})
      run.simulation().add(*observer);
  }

  SceneRun run;
  model::OutputRequest request;
  record::HistoryRecorder history;
  record::EnergyRecorder energy;
  record::ImpactRecorder impacts;
};

void expect_same_end(Watched& a, Watched& b) {
  const time::State &x = a.run.simulation().state(), &y = b.run.simulation().state();
  EXPECT_TRUE(a.run.simulation().report().completed);
  EXPECT_TRUE(b.run.simulation().report().completed);
  EXPECT_EQ(x.t, y.t);
  EXPECT_TRUE(x.x == y.x && x.v == y.v && x.a == y.a && x.memory == y.memory);
  EXPECT_EQ(a.run.simulation().report().steps, b.run.simulation().report().steps);
  EXPECT_EQ(a.run.simulation().report().rejected, b.run.simulation().report().rejected);
  EXPECT_EQ(a.history.peaks(), b.history.peaks());
  EXPECT_EQ(a.energy.work(), b.energy.work());
  EXPECT_EQ(a.energy.dissipated(), b.energy.dissipated());
  EXPECT_EQ(a.energy.balance_error(), b.energy.balance_error());
  const auto first = a.impacts.impacts(), second = b.impacts.impacts();
  ASSERT_EQ(first.size(), second.size());
  EXPECT_GT(first.size(), 0U);
  for (std::size_t i = 0; i < first.size(); ++i)
    EXPECT_EQ(record::ImpactRecorder::csv_line(first[i]), record::ImpactRecorder::csv_line(second[i]));
}

class Snapshots : public testing::TestWithParam<MethodCase> {};

TEST_P(Snapshots, ANewSimulationGoesOnBitForBit) {
  Watched unbroken(GetParam());
  unbroken.run.run();
  const std::int64_t steps = unbroken.run.simulation().snapshot().accepted;
  for (const std::int64_t after : {std::int64_t{0}, std::int64_t{1}, steps / 3, steps - 1}) {
    SCOPED_TRACE(after);
    std::vector<std::byte> bytes;
    {
      Watched first(GetParam());
      for (std::int64_t i = 0; i < after; ++i) first.run.simulation().advance();
      ByteWriter writer(bytes);
      write_snapshot(first.run.simulation().snapshot(), writer);
    }
    Watched second(GetParam());
    ByteReader reader(bytes);
    second.run.simulation().restore(time::read_snapshot(reader));
    second.run.run();
    expect_same_end(unbroken, second);
  }
}

TEST_P(Snapshots, ASimulationGoesBackAndRepeatsItself) {
  Watched straight(GetParam()), wavering(GetParam());
  straight.run.run();
  time::Snapshot snapshot;
  bool goes_on = true;
  while (goes_on) {
    wavering.run.simulation().take_snapshot(snapshot);
    for (int i = 0; i < 3 && wavering.run.simulation().advance(); ++i) continue;
    wavering.run.simulation().restore(snapshot);
    goes_on = wavering.run.simulation().advance();
  }
  expect_same_end(straight, wavering);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Snapshots, testing::ValuesIn(method_cases()),
                         [](const auto& one) { return one.param.name; });

TEST(Snapshots, OfAnotherSystemOrOtherObserversAreRefused) {
  const MethodCase method{"rk4", "", 4.0};
  Watched watched(method);
  const time::Snapshot snapshot = watched.run.simulation().snapshot();
  SceneRun unwatched(scene_of(method));
  EXPECT_THROW(unwatched.simulation().restore(snapshot), LogicError);
  time::Snapshot other = snapshot;
  other.state.x.conservativeResize(3);
  EXPECT_THROW(watched.run.simulation().restore(other), LogicError);
  std::vector<std::byte> bytes;
  ByteWriter writer(bytes);
  write_snapshot(snapshot, writer);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ByteReader reader(std::span<const std::byte>(bytes).first(size));
    EXPECT_THROW(time::read_snapshot(reader), RunError);
  }
}

}  // namespace
}  // namespace butee::test::snapshot_test
