// The practical examples in apps/models: the results stated on their pages.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test::practice_test {
namespace {

/// The pages state two to three digits.
constexpr double kPrinted = 0.01;

struct Claim {
  std::string peak;
  double value;
};

struct Job {
  std::string name;
  std::vector<Claim> claims;
};

class Practice : public testing::TestWithParam<Job> {};

TEST_P(Practice, GivesWhatItsPageSays) {
  const TemporaryFolder folder;
  const Job& job = GetParam();
  const Outcome run = run_program({"run", model_path(job.name), "-o", "results", "-q"}, folder.path());
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(run.errors, "");
  const auto summary = nlohmann::json::parse(read_file(folder.file("results/summary.json")));
  for (const Claim& claim : job.claims)
    EXPECT_NEAR(summary["peak"][claim.peak].get<double>(), claim.value, kPrinted * claim.value) << claim.peak;
  const std::string page = std::filesystem::path(model_path(job.name)).replace_extension(".md");
  EXPECT_NE(read_file(page).find("butee run apps/models/" + job.name + ".toml"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    jobs, Practice,
    testing::Values(Job{"rotor",
                        {{"impeller.uy", 4.46e-4},
                         {"impeller.uz", 3.95e-4},
                         {"impeller.contact_force", 91.2},
                         {"drive.spring_uy", 189.0}}},
                    Job{"drill-string", {{"hook.N", 75.9e3}, {"collar.u", 11.8e-3}, {"collar.contact_force", 18.2e3}}},
                    Job{"tower",
                        {{"roof.u", 0.144},
                         {"roof.uz", 0.0956},
                         {"roof.a_abs", 10.4},
                         {"foot.V", 3.68e6},
                         {"foot.M", 9.16e7},
                         {"annex.contact_force", 1.25e6}}},
                    Job{"pipe-frame",
                        {{"anchor.reaction_ux", 48.3e3},
                         {"bend.N", 25.7e3},
                         {"anchor.von_mises", 16.0e6},
                         {"bend.contact_force", 1.95e3}}}),
    [](const auto& one) {
      std::string name = one.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

/// The stored record equals its formula to the printed digits.
TEST(Record, IsMadeByItsScript) {
  const std::string folder = std::filesystem::path(model_path("tower")).parent_path();
  std::FILE* pipe = popen(("awk -f '" + folder + "/make-quake'").c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  std::string made;
  std::array<char, 4096> block{};
  for (std::size_t n = 0; (n = std::fread(block.data(), 1, block.size(), pipe)) > 0;) made.append(block.data(), n);
  ASSERT_EQ(pclose(pipe), 0);
  const TemporaryFolder own;
  own.write("made.csv", made);
  const CsvTable expected(own.file("made.csv")), kept(folder + "/quake.csv");
  ASSERT_EQ(kept.rows(), 1001U);
  ASSERT_EQ(expected.rows(), kept.rows());
  for (const char* name : {"t", "a_y", "a_z"}) {
    const auto a = kept.column(name), b = expected.column(name);
    for (std::size_t i = 0; i < kept.rows(); ++i) EXPECT_NEAR(a[i], b[i], 1.5e-5) << name << " " << i;
  }
}

/// The scenes of apps/studies/rings.toml, at their beginning: `exponential` has the peaks of `exact`.
TEST(StudyOfRings, HasScenesOnWhichMethodsAgree) {
  const TemporaryFolder folder;
  for (const std::string name : {"pipe", "pipe-friction", "pipe-fast", "mass", "rotor"}) {
    const std::string scene = BUTEE_TEST_SOURCE "/apps/studies/rings/" + name + ".toml",
                      end = "integrator.end_time=" + std::string(name == "mass" ? "0.02" : "0.2");
    const auto peak_of = [&](const std::vector<std::string>& more) {
      std::vector<std::string> arguments = {"run", scene, "-q", "-o", "results", "--set", end};
      arguments.insert(arguments.end(), more.begin(), more.end());
      const Outcome run = run_program(arguments, folder.path());
      EXPECT_EQ(run.status, 0) << run.errors;
      const auto summary = nlohmann::json::parse(read_file(folder.file("results/summary.json")));
      return summary["peak"]["mid.uy"].get<double>();
    };
    const double wanted = peak_of({"--set", "integrator.type=exact", "--set", "integrator.tolerance="});
    EXPECT_GT(wanted, 1e-4) << name;
    EXPECT_NEAR(peak_of({}), wanted, 1e-3 * wanted) << name;
  }
}

}  // namespace
}  // namespace butee::test::practice_test
