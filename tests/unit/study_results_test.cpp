#include <cmath>
#include <numbers>

#include <butee/core/text.hpp>
#include <butee/study/worker.hpp>
#include <gtest/gtest.h>

#include "support/program.hpp"

namespace butee::test::study_results_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// x'' + 0.4 x' + 9 x = 2 cos(2 t), with a known steady-state motion.
constexpr const char* kOscillator = R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
stiffness = 9.0
damping = 0.4
[[load]]
type = "harmonic"
node = "m"
amplitude = 2.0
angular_frequency = 2.0
[integrator]
type = "exponential"
tolerance = 1e-9
)";

/// The entries of every item of the first run of a study.
std::vector<std::vector<double>> results_of(const std::string& scene, const std::string& settings,
                                            const std::vector<std::string>& items) {
  const TemporaryFolder folder;
  folder.write("scene.toml", scene);
  std::string collect;
  for (const std::string& item : items)
    if (item != "settled") collect += (collect.empty() ? "\"" : ", \"") + item + "\"";
  folder.write("study.toml",
               "schema = 1\nscene = \"scene.toml\"\n[study]\n" + settings + "\ncollect = [" + collect + "]\n");
  const study::Study study = study::load_study(folder.file("study.toml"));
  const study::Layout layout = layout_of(study);
  study::Worker worker(study, layout);
  study::Motion motion;
  const study::Row row = *worker.perform(0, motion, [] { return true; });
  EXPECT_EQ(row.text(layout.find(study::kStatusColumn)), "completed") << row.text(layout.find(study::kReasonColumn));
  std::vector<std::vector<double>> all;
  for (const std::string& item : items) {
    const std::size_t column = layout.find(item);
    all.emplace_back();
    const bool is_integer = layout.columns()[column].type == study::Column::Type::integer;
    for (std::size_t k = 0; k < layout.columns()[column].length; ++k)
      all.back().push_back(is_integer ? static_cast<double>(row.integer(column)) : row.number(column, k));
  }
  return all;
}

TEST(StudyResults, MeetTheSteadyMotionOfAnOscillator) {
  constexpr double kOmega = 2.0, kStiff = 9.0 - kOmega * kOmega, kDamp = 0.4 * kOmega;
  const double amplitude = 2.0 / std::hypot(kStiff, kDamp), phase = -std::atan2(kDamp, kStiff);
  const auto r = results_of(kOscillator, "settle = 50\nperiods = 8",
                            {"peak m.u", "max m.v", "min m.a", "rms m.u", "mean m.u", "end m.u", "section m.u",
                             "section m.v", "frequency m.u", "impacts", "lyapunov"});
  // After 50 periods e^(-0.2 t) has reduced the transient to 2e-14; the remaining error is the tolerance.
  constexpr double kGood = 1e-7;
  EXPECT_NEAR(r[0][0], amplitude, kGood);
  EXPECT_NEAR(r[1][0], amplitude * kOmega, kGood);
  EXPECT_NEAR(r[2][0], -amplitude * kOmega * kOmega, kGood * 10);
  EXPECT_NEAR(r[3][0], amplitude / std::numbers::sqrt2, kGood);
  EXPECT_NEAR(r[4][0], 0.0, kGood);
  EXPECT_NEAR(r[5][0], amplitude * std::cos(phase), kGood);
  ASSERT_EQ(r[6].size(), 8U);
  for (const double u : r[6]) EXPECT_NEAR(u, amplitude * std::cos(phase), kGood);
  for (const double v : r[7]) EXPECT_NEAR(v, -amplitude * kOmega * std::sin(phase), kGood);
  // With 8 periods the line lies on a frequency of the transform; the parabola's error is 1e-3 of the
  // distance of two lines.
  EXPECT_NEAR(r[8][0], kOmega / (2.0 * kPi), 1e-3 * kOmega / (2.0 * kPi));
  EXPECT_EQ(r[9][0], 0.0);
  // The free motion decays like e^(-0.2 t) in every direction.
  EXPECT_NEAR(r[10][0], -0.2, 0.05);
}

TEST(StudyResults, CountImpactsOfABouncingMass) {
  // Free flight between two stops at 2 mm on each side, at 1 m/s: a cycle takes 8e-3 s plus the contact
  // times.
  const double omega = std::sqrt(1e8), round = 8e-3 + 2.0 * kPi / omega;
  const auto r = results_of(R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[contact]]
type = "stop"
nodes = "m"
gap = 2e-3
law = "linear"
stiffness = 1e8
[initial]
velocity = [{nodes = "m", value = 1.0}]
[integrator]
end_time = 1.0
tolerance = 1e-8
[output]
interval = 1e-3
)",
                            "", {"impacts", "peak m.contact_force", "frequency m.u"});
  EXPECT_EQ(r[0][0], std::floor((1.0 - 2e-3) / round * 2.0) + 1.0);
  EXPECT_NEAR(r[1][0], omega, 1e-5 * omega);  // m v omega
  EXPECT_NEAR(r[2][0], 1.0 / round, 0.02 / round);
}

TEST(StudyResults, LyapunovExponentIsZeroWhereADisturbanceStays) {
  std::string scene = kOscillator;
  scene.replace(scene.find("stiffness = 9.0"), 15, "stiffness = 1e-6");
  // With almost no spring a displacement decays only like e^(-2.5e-6 t).
  const auto r = results_of(scene, "settle = 20\nperiods = 40", {"lyapunov"});
  EXPECT_NEAR(r[0][0], 0.0, 1e-3);
}

/// Peaks of sampled quantities: the spring force in steady-state motion.
TEST(StudyResults, PeaksOfForcesOfElementsAreThoseOfTheMotion) {
  const auto r = results_of(kOscillator, "settle = 50\nperiods = 8", {"peak m.spring_force", "rms m.spring_force"});
  // k x + c v of the steady-state motion; 64 samples in a period miss a peak by at most (pi/64)^2/2 of it.
  const double amplitude = 2.0 / std::hypot(9.0 - 4.0, 0.8) * std::hypot(9.0, 0.8);
  EXPECT_NEAR(r[0][0], amplitude, 1.3e-3 * amplitude);
  EXPECT_NEAR(r[1][0], amplitude / std::numbers::sqrt2, 1e-6 * amplitude);
}

/// For a motion that repeats after two periods, settling ends early, and the section takes the same one of
/// its two points as after all periods. For a motion that never repeats, settling runs to its end.
TEST(StudyResults, SettlingEndsEarlierWhereTheMotionIsSteady) {
  const std::string scene = R"(
schema = 1
[[element]]
type = "mass"
name = "rotor"
mass = 100.0
[[element]]
type = "spring"
node = "rotor"
stiffness = 1.0e6
damping = 1.0e3
[[contact]]
type = "stop"
nodes = "rotor"
gap = 1.0e-3
sides = "positive"
law = "linear"
stiffness = 2.0e8
[[load]]
type = "harmonic"
node = "rotor"
amplitude = AMPLITUDE
angular_frequency = 280.0
[integrator]
tolerance = 1.0e-7
)";
  const auto perform = [&](const std::string& amplitude, const std::string& settings) {
    std::string text = scene;
    return results_of(text.replace(text.find("AMPLITUDE"), 9, amplitude), "settle = 601\nperiods = 6\n" + settings,
                      settings.empty() ? std::vector<std::string>{"section rotor.u"}
                                       : std::vector<std::string>{"section rotor.u", "settled"});
  };
  const auto whole = perform("20000.0", ""), early = perform("20000.0", "steady = 1e-5");
  EXPECT_LT(early[1][0], 400.0);
  EXPECT_EQ(std::fmod(601.0 - early[1][0], 2.0), 0.0);
  EXPECT_GT(std::abs(whole[0][0] - whole[0][1]), 1e-3);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(early[0][k], whole[0][k], 1e-5 * 0.02) << k;  // of 20 mm
  EXPECT_EQ(perform("12000.0", "steady = 1e-5")[1][0], 601.0);
}

/// The motion is steady within 1e-6 after about 56 periods: 10 are too few, the 80 after them are not.
TEST(StudyResults, CountAllPeriodsOfAMotionThatBecomesSteadyAmongThem) {
  const std::vector<std::string> items = {"rms m.u", "mean m.u", "end m.u", "section m.u", "frequency m.u"};
  // Steps shorter than a period: the watch could end the run between them.
  std::string scene = kOscillator;
  scene.replace(scene.find("exponential"), 11, "dopri5");
  const auto plain = results_of(scene, "settle = 10\nperiods = 80", items);
  const auto watched = results_of(scene, "settle = 10\nperiods = 80\nsteady = 1e-6", items);
  EXPECT_EQ(watched, plain);
  EXPECT_NEAR(watched[0][0], 2.0 / std::hypot(5.0, 0.8) / std::numbers::sqrt2, 1e-3);
}

/// A load that begins after the motion has repeated itself: (10 N)/(9 N/m) beside the oscillation.
TEST(StudyResults, DoNotCallAMotionSteadyBeforeALaterLoad) {
  const std::string ramp = "[[load]]\ntype = \"ramp\"\nnode = \"m\"\nto = 10.0\nstart = 250.0\nend = 260.0\n";
  const auto results =
      results_of(kOscillator + ramp, "settle = 120\nperiods = 2\nsteady = 1e-6", {"mean m.u", "settled"});
  EXPECT_NEAR(results[0][0], 10.0 / 9.0, 1e-5);
  EXPECT_LE(results[1][0], 120.0);
}

/// A constant load of 5 N keeps a damped stop closed: 9 u + 1000 (u - 0.1) = 5 + 2 cos 2t with both dashpots.
TEST(StudyResults, HavePeaksOfForcesWithDissipation) {
  const std::string stop =
      "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ngap = 0.1\nsides = \"positive\"\nstiffness = 1000.0\ndamping = { "
      "type = "
      "\"kelvin_voigt\", coefficient = 10.0 }\n[[load]]\ntype = \"constant\"\nnode = \"m\"\nvalue = 5.0\n";
  const auto results =
      results_of(kOscillator + stop, "settle = 40\nperiods = 4", {"peak m.contact_force", "mean m.contact_force"});
  const double mean = 1000.0 * (105.0 / 1009.0 - 0.1),
               swing = 2.0 * std::hypot(1000.0, 20.0) / std::hypot(1009.0 - 4.0, 20.8);
  EXPECT_NEAR(std::abs(results[1][0]), mean, 1e-6);
  EXPECT_NEAR(results[0][0], mean + swing, 1e-6);
}

TEST(StudyResults, AreRefusedWithTheirReason) {
  const auto reason = [](const std::string& item) {
    try {
      (void)study::read_item(item);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(reason("peek m.u").find("did you mean \"peak\""), std::string::npos);
  EXPECT_NE(reason("peak").find("peak LABEL.QUANTITY"), std::string::npos);
  EXPECT_NE(reason("peak m.x").find("there is no quantity \"x\""), std::string::npos);
  EXPECT_NE(reason("impacts m.u").find("stands alone"), std::string::npos);
  EXPECT_NE(reason("max m.contact_force").find("use peak"), std::string::npos);
  EXPECT_EQ(reason("section string:3.theta"), "");
}

TEST(StudyRows, GoToCsvAndBack) {
  const study::Layout layout({{"run", "1", study::Column::Type::integer},
                              {"x", "m", study::Column::Type::number, 3},
                              {"text", "", study::Column::Type::text, 12}});
  study::Row row(layout);
  row.set_integer(0, -7);
  row.set(1, 0.1, 0);
  row.set(1, std::nan(""), 1);
  row.set(1, -1e-300, 2);
  row.set_text(2, "a,\"b\" is too long");
  const std::string line = csv_line(layout, row);
  const study::Row back = study::from_csv(layout, line);
  EXPECT_TRUE(std::equal(row.bytes().begin(), row.bytes().end(), back.bytes().begin(), back.bytes().end())) << line;
  EXPECT_EQ(back.text(2), "a,\"b\" is too");
  row.set_text(2, "gapin \xC2\xB5m: \xC2\xB5");  // 12 bytes end within the second sign for micro
  EXPECT_EQ(row.text(2), "gapin \xC2\xB5m: ");
  EXPECT_THROW((void)study::from_csv(layout, "1,2,3"), std::exception);
  EXPECT_THROW((void)study::from_csv(layout, "1,2,x,4,t"), std::exception);
}

}  // namespace
}  // namespace butee::test::study_results_test
