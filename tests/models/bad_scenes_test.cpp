#include "bad_scenes.hpp"

#include <algorithm>
#include <sstream>

#include <butee/config/override.hpp>
#include <butee/config/toml.hpp>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <gtest/gtest.h>

#include "apps/butee/session.hpp"
#include "support/program.hpp"
#include "support/scene_run.hpp"

namespace butee::test {

const std::string kGoodScene = R"(schema = 1
title = "Scene"

[material.steel]
young_modulus = 2.0e11
density = 7900.0

[section.pipe]
shape = "tube"
outer_radius = 0.06
inner_radius = 0.04

[[element]]
type = "beam"
name = "string"
material = "steel"
section = "pipe"
length = 4.0
elements = 4

[[element]]
type = "mass"
name = "rotor"
mass = 100.0

[[element]]
type = "spring"
name = "bearing"
node = "rotor"
stiffness = 1.0e9

[[support]]
nodes = ["string:first", "string:last"]
fix = ["u"]

[[contact]]
type = "stop"
nodes = "rotor"
gap = 0.01
sides = "both"
law = "arctan"
stiffness = 1.0e6
regularization = 7.0e7

[[load]]
type = "harmonic"
node = "string:2"
dof = "u"
amplitude = 300.0
angular_frequency = 6.0

[damping]
mass_proportional = 0.03

[initial]
displacement = [{ nodes = "rotor", dof = "u", value = 0.001 }]

[integrator]
type = "newmark_modified"
time_step = 1.0e-5
end_time = 1.0

[output]
interval = 1.0e-3

[[output.probe]]
label = "mid"
node = "string:middle"
quantities = ["u", "v"]
)";

std::string edited(const std::vector<Edit>& edits) {
  std::string text = kGoodScene;
  for (const Edit& edit : edits) {
    if (edit.find.empty()) {
      text = edit.replace;
      continue;
    }
    const auto at = text.find(edit.find);
    EXPECT_NE(at, std::string::npos) << edit.find;
    EXPECT_EQ(text.find(edit.find, at + 1), std::string::npos) << edit.find << " occurs twice";
    if (at != std::string::npos) text.replace(at, edit.find.size(), edit.replace);
  }
  return text;
}

namespace {

constexpr const char* kFile = "scene.toml";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The messages of `butee run` for the scene: one line for each mistake.
std::vector<std::string> messages_of(const std::string& toml, const std::vector<std::string>& overrides) {
  static const plugin::Catalogue catalogue = plugin::Catalogue::with_plugins({BUTEE_TEST_PLUGINS});
  try {
    config::Document document = config::parse_toml(toml, kFile);
    for (const std::string& assignment : overrides) config::apply_override(document, assignment);
    scene::read_scene(std::move(document), catalogue);
  } catch (const InputError& error) {
    return lines_of(error.what());
  }
  return {};
}

/// The expected beginnings of the messages for a scene.
std::vector<std::string> expected_places(const BadScene& scene, const std::string& toml) {
  std::vector<std::string> places;
  const auto lines = lines_of(toml);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto mark = lines[i].rfind('#');
    if (mark == std::string::npos) continue;
    const auto count =
        static_cast<std::size_t>(std::count(lines[i].begin() + std::ptrdiff_t(mark), lines[i].end(), '!'));
    places.insert(places.end(), count, std::string(kFile) + ":" + std::to_string(i + 1) + ": ");
  }
  for (const std::string& assignment : scene.overrides) places.push_back("--set " + assignment + ": ");
  return places;
}

std::vector<BadScene> all_bad_scenes() {
  std::vector<BadScene> all;
  for (const auto& list : {bad_syntax_scenes(), bad_element_scenes(), bad_selector_scenes(), bad_contact_scenes(),
                           bad_damping_scenes(), bad_load_scenes(), bad_integrator_scenes(), bad_output_scenes()})
    all.insert(all.end(), list.begin(), list.end());
  return all;
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(BadScenes, SayWhereWhatAndWhatIsAllowed) {
  std::size_t scenes = 0;
  for (const BadScene& scene : all_bad_scenes()) {
    SCOPED_TRACE(scene.name);
    const std::string toml = edited(scene.edits);
    const auto messages = messages_of(toml, scene.overrides);
    const std::string all = join(messages, "\n");
    const auto places = expected_places(scene, toml);
    EXPECT_EQ(messages.size(), places.size()) << all;
    for (std::size_t i = 0; i < std::min(messages.size(), places.size()); ++i)
      EXPECT_TRUE(messages[i].starts_with(places[i])) << "wanted " << places[i] << "\n" << all;
    for (const std::string& part : scene.says) EXPECT_TRUE(holds(all, part)) << "wanted " << part << "\n" << all;
    ++scenes;
  }
  EXPECT_EQ(scenes, 250U);
}

TEST(BadScenes, EndTheProgramWith2AndNothingWritten) {
  constexpr std::size_t kStride = 9;
  const auto all = all_bad_scenes();
  std::size_t runs = 0;
  for (std::size_t i = 0; i < all.size(); i += kStride) {
    SCOPED_TRACE(all[i].name);
    const std::string toml = edited(all[i].edits);
    const TemporaryFolder folder;
    folder.write(kFile, toml);
    std::vector<std::string> arguments = {"run", kFile};
    for (const std::string& assignment : all[i].overrides) arguments.insert(arguments.end(), {"--set", assignment});
    const Outcome outcome = run_program(arguments, folder.path());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.output, "");
    EXPECT_EQ(outcome.errors, join(messages_of(toml, all[i].overrides), "\n") + "\n");
    EXPECT_EQ(folder.entries(), std::vector<std::string>{kFile});
    ++runs;
  }
  EXPECT_EQ(runs, 28U);
}

TEST(GoodScenes, NearTheBorderAreAccepted) {
  std::size_t scenes = 0;
  for (const GoodScene& scene : good_scenes()) {
    SCOPED_TRACE(scene.name);
    EXPECT_EQ(join(messages_of(edited(scene.edits), scene.overrides), "\n"), "");
    ++scenes;
  }
  EXPECT_EQ(scenes, 35U);
}

}  // namespace
}  // namespace butee::test
