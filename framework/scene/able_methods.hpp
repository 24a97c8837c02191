#pragma once

#include <string>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/scene/read_scene.hpp"

namespace butee::scene {

/// The support that the contacts of a model require of a method.
struct ContactNeeds {
  time::ContactSupport support;
  const char* words;  ///< for messages: "friction with rigid stick"
};
ContactNeeds contact_needs(const model::Model& model);

/// The names of the methods that accept a scene, found by trying them: with its end time and, where they have these,
/// its step and its tolerance; other required parameters have the values with which comparisons begin. All modules are
/// loaded. Of systems with more than 2000 DOFs only `auto` is tried.
std::vector<std::string> able_methods(Scene& scene, dynamics::Dynamics& dynamics);

}  // namespace butee::scene
