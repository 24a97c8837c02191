// The values of a study in the scenes of its runs.
#include <butee/config/override.hpp>
#include <butee/config/parameters.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/study/study.hpp>
#include <gtest/gtest.h>

namespace butee::test::study_values_test {
namespace {

study::Study study_of(const std::string& vary, const std::string& settings,
                      const std::vector<std::string>& overrides = {}) {
  const auto scene =
      config::parse_toml("schema = 1\n[[element]]\ntype = \"beam\"\nelements = 6\nlength = 4\n", "scene.toml");
  const auto text =
      "schema = 1\nscene = \"scene.toml\"\n[[vary]]\n" + vary + "\n[study]\ncollect = [\"impacts\"]\n" + settings;
  study::StudyOptions options;
  options.overrides = overrides;
  return study::read_study(config::parse_toml(text, "study.toml"), scene, options);
}

std::string refusal_of(const std::string& settings, const std::vector<std::string>& overrides) {
  try {
    (void)study_of("key = \"element[0].length\"\nvalues = [4.0, 5.0]", settings, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// A range over a key that is an integer gives integers where its values are whole; the length, also written as an
/// integer, takes any.
TEST(StudyValues, OfARangeAreIntegersWhereTheKeyIsOne) {
  const study::Study elements = study_of("key = \"element[0].elements\"\nfrom = 4\nto = 8\ncount = 3", "");
  for (std::int64_t point = 0; point < 3; ++point) {
    const auto scene = study::scene_at(elements, elements.plan.values(point));
    const auto* value = std::get_if<std::int64_t>(&config::find_value(scene, "element[0].elements")->data);
    ASSERT_NE(value, nullptr) << point;
    EXPECT_EQ(*value, 4 + 2 * point);
  }
  const study::Study lengths = study_of("key = \"element[0].length\"\nfrom = 4\nto = 5\ncount = 3", "");
  const auto scene = study::scene_at(lengths, lengths.plan.values(1));
  EXPECT_EQ(config::as_number(*config::find_value(scene, "element[0].length")), 4.5);
}

/// A value that no run would use is refused, wherever it is set.
TEST(StudyValues, AreNotSetBesides) {
  EXPECT_NE(refusal_of("", {"element[0].length=3"}).find("--set \"element[0].length=3\": the study varies"),
            std::string::npos);
  EXPECT_NE(refusal_of("set = [\"element[0].length=3\"]\n", {}).find("\"element[0].length=3\": the study varies"),
            std::string::npos);
  const auto has_line = refusal_of("set = [\"element[9].length=3\"]\n", {});
  EXPECT_NE(has_line.find(": study.set = "), std::string::npos) << has_line;
  EXPECT_EQ(has_line.find("--set"), std::string::npos) << has_line;
  EXPECT_NE(refusal_of("period = 1.0\nperiods = 3\nset = [\"integrator.end_time=3\"]\n", {})
                .find("settle and periods determine the end"),
            std::string::npos);
  EXPECT_EQ(refusal_of("", {"element[0].elements=3"}), "");
}

}  // namespace
}  // namespace butee::test::study_values_test
