#include <butee/config/override.hpp>
#include <butee/config/scene_error.hpp>
#include <butee/config/toml.hpp>
#include <butee/scene/read_scene.hpp>
#include <gtest/gtest.h>

namespace butee::test::scene_error_test {
namespace {

constexpr const char* kScene = R"(schema = 1
[[element]]
type = "mass"
name = "rotor"
mass = -5.0
[[contact]]
nodes = "rotor"
gapp = 1.0
law = "linear"
stiffness = 1.0
type = "stop"
gap = 0.1
[integrator]
end_time = 1.0
)";

TEST(SceneError, HasTheMistakesInParts) {
  config::Document document = config::parse_toml(kScene, "a: b.toml");
  apply_override(document, "integrator.end_time", config::Value(-1.0));
  try {
    scene::read_scene(document, plugin::Catalogue::with_plugins());
    FAIL() << "nothing was thrown";
  } catch (const config::SceneError& error) {
    ASSERT_EQ(error.mistakes().size(), 3u) << error.what();
    const auto& mass = error.mistakes()[0];
    EXPECT_EQ(mass.file, "a: b.toml");
    EXPECT_EQ(mass.line, 5);
    EXPECT_EQ(mass.key, "element[0].mass");
    EXPECT_EQ(mass.message.rfind("-5.0: must be", 0), 0u) << mass.message;
    EXPECT_EQ(error.mistakes()[1].line, 8);
    EXPECT_EQ(error.mistakes()[1].key, "contact[0].gapp");
    const auto& end = error.mistakes()[2];
    EXPECT_EQ(end.file, "--set integrator.end_time=-1.0");
    EXPECT_EQ(end.line, 0);
    EXPECT_EQ(end.key, "integrator.end_time");
  }
}

TEST(OverrideByValue, DoesWhatItsTextDoes) {
  config::Document by_value = config::parse_toml(kScene, "scene"), by_text = by_value;
  apply_override(by_value, "contact[0].gap", config::Value(0.25));
  apply_override(by_text, "contact[0].gap=0.25");
  EXPECT_EQ(config::write_toml(*by_value.root.table()), config::write_toml(*by_text.root.table()));
  EXPECT_EQ(by_value.sources, by_text.sources);
  EXPECT_THROW(apply_override(by_value, "contact[1].gap", config::Value(0.25)), InputError);
}

TEST(OverrideByValue, NamesLongValuesBriefly) {
  config::Document document = config::parse_toml(kScene, "scene");
  apply_override(document, "load", config::Value(config::Array(10000, config::Value(1.0))));
  EXPECT_LT(document.sources.back().size(), 100u);
}

TEST(FindValue, FollowsKeysAndFindsNothingBeside) {
  const config::Document document = config::parse_toml(kScene, "scene");
  ASSERT_NE(find_value(document, "contact[0].gap"), nullptr);
  EXPECT_EQ(std::get<double>(find_value(document, "contact[0].gap")->data), 0.1);
  for (const char* key : {"contact[1].gap", "contact[0].x", "contact.gap", "x.y", "schema.x", "schema[0]"})
    EXPECT_EQ(find_value(document, key), nullptr) << key;
  for (const char* key : {"", ".", "contact[", "contact[x]", "contact[0]gap", "contact[-1]"})
    EXPECT_THROW(find_value(document, key), InputError) << key;
}

}  // namespace
}  // namespace butee::test::scene_error_test
