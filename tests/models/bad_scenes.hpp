#pragma once

#include <string>
#include <vector>

namespace butee::test {

/// An edit of the good scene: `find` must occur once in it; an empty `find` replaces the whole scene.
struct Edit {
  std::string find, replace;
};

/// A scene with mistakes. Every `!` of a comment `#!` stands for one mistake that must be reported for its
/// line. In addition, one mistake is reported after these for each of the overrides, and nothing else.
struct BadScene {
  std::string name;
  std::vector<Edit> edits;
  std::vector<std::string> says;
  std::vector<std::string> overrides = {};
};

/// A scene that looks wrong but is valid.
struct GoodScene {
  std::string name;
  std::vector<Edit> edits;
  std::vector<std::string> overrides = {};
};

/// A beam, a mass on a spring, a support, a stop, a load, an initial value and a probe.
extern const std::string kGoodScene;

std::string edited(const std::vector<Edit>& edits);

std::vector<BadScene> bad_syntax_scenes();
std::vector<BadScene> bad_element_scenes();
std::vector<BadScene> bad_selector_scenes();
std::vector<BadScene> bad_contact_scenes();
std::vector<BadScene> bad_damping_scenes();
std::vector<BadScene> bad_load_scenes();
std::vector<BadScene> bad_integrator_scenes();
std::vector<BadScene> bad_output_scenes();
std::vector<GoodScene> good_scenes();

}  // namespace butee::test
