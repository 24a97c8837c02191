// The command `butee stability`, run as a program.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::stability_test {
namespace {

using Json = nlohmann::json;

TEST(StabilityCommand, WritesCurvesAndLimits) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"stability", "RK4-1", "--damping", "0,0.1", "--stops", "8", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("2.82843"), std::string::npos) << outcome.output;
  const CsvTable curves(folder.file("out/stability.csv")), stops(folder.file("out/stops.csv"));
  EXPECT_EQ(curves.header(), (std::vector<std::string>{"method", "damping_ratio", "h_omega", "spectral_radius",
                                                       "numerical_damping", "period_error"}));
  constexpr std::size_t kPoints = 4 * 60 + 1;  // 60 per decade, from 0.01 to 100
  EXPECT_EQ(curves.rows(), 2U * kPoints);
  EXPECT_EQ(stops.rows(), kPoints);
  // RK4 without damping: |R|^2 = 1 - y^6/72 + y^8/576 with y = h omega; a stop of 8 k triples y.
  const auto square = [](double y) { return 1.0 - std::pow(y, 6) / 72.0 + std::pow(y, 8) / 576.0; };
  int checked = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double y = curves.column("h_omega")[i];
    if (y > 4.0) continue;
    EXPECT_NEAR(std::pow(curves.column("spectral_radius")[i], 2), square(y), 1e-9 * (1.0 + square(y))) << y;
    EXPECT_NEAR(std::pow(stops.column("spectral_radius")[i], 2), square(3.0 * y), 1e-8 * (1.0 + square(3.0 * y))) << y;
    ++checked;
  }
  EXPECT_EQ(checked, 157);  // up to 60 log10(400)
}

TEST(StabilityCommand, GivesEveryMethodAsJson) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_program({"stability", "--json", "--damping", "0", "--stops", "1", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const Json all = Json::parse(outcome.output);
  EXPECT_GE(all.size(), 23U);
  bool has_newmark = false;
  for (const Json& one : all) {
    if (one["method"] != "newmark") continue;
    has_newmark = true;
    EXPECT_EQ(one["undamped"]["kind"], "unbounded");
    EXPECT_TRUE(one["declared"]["stability_limit"].is_null());
  }
  EXPECT_TRUE(has_newmark);
}

TEST(StabilityCommand, SaysWhereThereIsNoMap) {
  const TemporaryFolder folder;
  const Outcome outcome = run_program({"stability", "exact", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("there is no map of one step beyond"), std::string::npos) << outcome.output;
}

TEST(StabilityCommand, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  for (const auto& [arguments, part] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"stability", "newmrk"}, "did you mean \"newmark\""},
           {{"stability", "newmark", "--set", "beta=7"}, "beta"},
           {{"stability", "newmark", "--set", "rho_inf=0.5"}, "rho_inf"},
           {{"stability", "newmark", "--set", "time_step=1"}, "stability is found at every step"},
           {{"stability", "newmark", "--stops", "0"}, "must be a number from 1e-12 to 1e+12"},
           {{"stability", "--set", "beta=0.3"}, "METHOD"},
           {{"stability", "newmark", "--damping", "-1"}, "damping"}}) {
    const Outcome outcome = run_program(arguments, folder.path());
    EXPECT_EQ(outcome.status, 2) << part;
    EXPECT_NE((outcome.errors + outcome.output).find(part), std::string::npos) << outcome.errors;
  }
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace butee::test::stability_test
