#include <butee/study/worker.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"

namespace butee::test::study_bench_test {
namespace {

constexpr const char* kBeam = R"(
schema = 1
[material.s]
young_modulus = 2e11
density = 7900
[section.c]
shape = "circle"
radius = 0.02
[[element]]
type = "beam"
name = "b"
material = "s"
section = "c"
length = 4.0
elements = 6
[[support]]
nodes = ["b:first", "b:last"]
fix = ["u"]
[[contact]]
type = "stop"
nodes = "b:all"
gap = 1e-3
stiffness = 1e6
law = "linear"
[[load]]
type = "harmonic"
node = "b:middle"
amplitude = 500.0
angular_frequency = 60.0
[damping]
mass_proportional = 0.5
[integrator]
end_time = 0.05
time_step = 1e-5
)";

struct Case {
  const char* method;
  const char* key;
  const char* values;
  bool shares;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.method << " " << c.key;
}

class SharedSystem : public testing::TestWithParam<Case> {};

/// The contents of rows except their cost.
std::string results_of(const study::Layout& layout, study::Row row) {
  for (std::size_t i = 0; i < layout.columns().size(); ++i) {
    const study::Column& column = layout.columns()[i];
    if (column.is_cost && column.type == study::Column::Type::integer) row.set_integer(i, 0);
    if (column.is_cost && column.type == study::Column::Type::number) row.set(i, 0.0);
  }
  return csv_line(layout, row);
}

/// Runs in ascending and in descending order, and each by a separate worker: the rows are equal, and shared
/// parts are made once.
TEST_P(SharedSystem, GivesTheSameRowsAsOneMadeAnew) {
  const Case& c = GetParam();
  const TemporaryFolder folder;
  folder.write("beam.toml", kBeam);
  folder.write("study.toml",
               "schema = 1\nscene = \"beam.toml\"\n[[vary]]\nkey = \"" + std::string(c.key) +
                   "\"\nvalues = " + c.values + "\n[study]\nset = [\"integrator.type=" + c.method +
                   "\"]\ncollect = [\"peak b:middle.u\", \"rms b:2.v\", \"impacts\", \"end b:middle.theta\"]\n");
  const study::Study study = study::load_study(folder.file("study.toml"));
  const study::Layout layout = layout_of(study);
  const auto perform = [&](study::Worker& worker, std::int64_t run) {
    study::Motion motion;
    return *worker.perform(run, motion, [] { return true; });
  };
  study::Worker forwards(study, layout), backwards(study, layout);
  const std::size_t assemblies = layout.find(study::kAssembliesColumn), status = layout.find(study::kStatusColumn),
                    factorizations = layout.find(study::kFactorizationsColumn);
  const std::int64_t count = study.plan.run_count();
  std::vector<std::string> there, back(static_cast<std::size_t>(count));
  for (std::int64_t run = 0; run < count; ++run) {
    const study::Row row = perform(forwards, run);
    EXPECT_EQ(row.text(status), "completed") << csv_line(layout, row);
    EXPECT_EQ(row.integer(assemblies), run == 0 || !c.shares ? 1 : 0) << run;
    if (run > 0 && c.shares && std::string(c.method) != "rodas4") {
      EXPECT_EQ(row.integer(factorizations), 0) << run;
    }
    there.push_back(results_of(layout, row));
  }
  for (std::int64_t run = count - 1; run >= 0; --run)
    back[static_cast<std::size_t>(run)] = results_of(layout, perform(backwards, run));
  for (std::int64_t run = 0; run < count; ++run) {
    study::Worker alone(study, layout);
    const std::string expected = results_of(layout, perform(alone, run));
    EXPECT_EQ(there[static_cast<std::size_t>(run)], expected);
    EXPECT_EQ(back[static_cast<std::size_t>(run)], expected);
  }
  EXPECT_NE(there[0].substr(there[0].find("completed")), there[1].substr(there[1].find("completed")));
}

INSTANTIATE_TEST_SUITE_P(, SharedSystem,
                         testing::Values(Case{"exponential", "load[0].amplitude", "[300.0, 600.0, 900.0]", true},
                                         Case{"exponential", "load[0].angular_frequency", "[50.0, 60.0, 80.0]", true},
                                         Case{"exponential", "contact[0].gap", "[5e-4, 1e-3, 2e-3]", true},
                                         Case{"exponential", "contact[0].stiffness", "[1e5, 1e6, 1e7]", true},
                                         Case{"exponential", "contact[0].sides", "[\"both\", \"positive\"]", true},
                                         Case{"newmark_modified", "contact[0].stiffness", "[1e5, 1e6, 1e7]", true},
                                         Case{"newmark_modified", "load[0].amplitude", "[300.0, 600.0, 900.0]", true},
                                         Case{"rodas4", "contact[0].gap", "[5e-4, 1e-3, 2e-3]", true},
                                         Case{"exact", "load[0].amplitude", "[300.0, 600.0]", true},
                                         Case{"auto", "contact[0].gap", "[5e-4, 1e-3]", true},
                                         Case{"exponential", "section.c.radius", "[0.02, 0.021]", false},
                                         Case{"exponential", "contact[0].nodes", "[\"b:all\", \"b:middle\"]", false},
                                         Case{"exponential", "load[0].node", "[\"b:middle\", \"b:2\"]", false},
                                         Case{"newmark_modified", "integrator.time_step", "[1e-5, 2e-5]", false}));

TEST(Study, FollowsWithTheMotionAtTheEndOfTheRunBefore) {
  const TemporaryFolder folder;
  folder.write("beam.toml", kBeam);
  folder.write("study.toml", R"(
schema = 1
scene = "beam.toml"
[[vary]]
key = "load[0].amplitude"
values = [300.0, 600.0]
[study]
follow = "up"
settle = 1
periods = 2
collect = ["end b:middle.u"]
)");
  const study::Study study = study::load_study(folder.file("study.toml"));
  const study::Layout layout = layout_of(study);
  study::Worker worker(study, layout);
  study::Motion motion;
  (void)worker.perform(0, motion, [] { return true; });
  ASSERT_FALSE(motion.is_empty());
  const study::Motion first = motion;
  const study::Row followed = *worker.perform(1, motion, [] { return true; });
  EXPECT_NE(motion.x, first.x);
  study::Motion rest, again = first;
  const study::Row from_rest = *worker.perform(1, rest, [] { return true; });
  study::Worker other(study, layout);
  const study::Row repeated = *other.perform(1, again, [] { return true; });
  EXPECT_NE(results_of(layout, followed), results_of(layout, from_rest));
  EXPECT_EQ(results_of(layout, followed), results_of(layout, repeated));
  EXPECT_EQ(again.x, motion.x);
}

}  // namespace
}  // namespace butee::test::study_bench_test
