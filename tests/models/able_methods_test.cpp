// A method that refuses a scene names those that accept it, and no others.
#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>

#include "butee/core/error.hpp"
#include "support/scene_run.hpp"

namespace butee::test::able_methods_test {
namespace {

const std::string kMass = R"(schema = 1
[[element]]
type = "mass"
name = "m"
mass = 1.0
[[element]]
type = "spring"
node = "m"
dof = "uy"
stiffness = 100.0
[[element]]
type = "spring"
node = "m"
dof = "uz"
stiffness = 90.0
damping = 1.0
[integrator]
end_time = 0.1
)";

struct Case {
  std::string name, contact, method;
};

class Refusals : public testing::TestWithParam<Case> {};

std::string complaint(const std::string& scene, const std::string& method) {
  try {
    SceneRun run(scene, {"integrator.type=" + method});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// "a, b, c" behind "these can: "
std::vector<std::string> named(const std::string& message) {
  const std::string mark = "these can: ";
  std::vector<std::string> names;
  const std::size_t place = message.find(mark);
  if (place == std::string::npos) return names;
  std::istringstream list(message.substr(place + mark.size()));
  for (std::string name; list >> name; names.push_back(name))
    if (name.back() == ',') name.pop_back();
  return names;
}

TEST_P(Refusals, NameTheMethodsThatAcceptTheScene) {
  const std::string scene = kMass + GetParam().contact;
  const std::vector<std::string> able = named(complaint(scene, GetParam().method));
  ASSERT_FALSE(able.empty()) << complaint(scene, GetParam().method);
  for (const std::string method :
       {"auto", "exact", "exponential", "piecewise", "dopri5", "extrapolation8", "rodas4", "bathe_adaptive"})
    if (method != GetParam().method) {
      const bool is_named = std::find(able.begin(), able.end(), method) != able.end();
      EXPECT_EQ(complaint(scene, method).empty(), is_named) << method;
    }
  // Each once, not by its other names as well.
  EXPECT_EQ(std::count(able.begin(), able.end(), "DOPRI5") + std::count(able.begin(), able.end(), "AUTO"), 0);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Refusals,
    testing::Values(
        Case{"ring", "[[contact]]\ntype = \"ring\"\nnodes = \"m\"\ngap = 0.01\nstiffness = 1e4\n", "bathe_adaptive"},
        Case{"hertz", "[[contact]]\ntype = \"ring\"\nnodes = \"m\"\ngap = 0.01\nlaw = \"hertz\"\nstiffness = 1e7\n",
             "piecewise"},
        Case{"stick_spring",
             "[[contact]]\ntype = \"plane\"\nnodes = \"m\"\nnormal = [1.0, 0.0]\ngap = 0.01\nstiffness = 1e4\nfriction "
             "= { "
             "coefficient = 0.1, stick_stiffness = 1e3 }\n",
             "bathe_adaptive"},
        Case{"rigid_stick",
             "[[contact]]\ntype = \"friction\"\nnodes = \"m\"\ndof = \"uy\"\nnormal_force = 5.0\nfriction = { "
             "coefficient = 0.1, stick = \"rigid\" }\n",
             "rodas4"},
        Case{"infinite_slope",
             "[[contact]]\ntype = \"stop\"\nnodes = \"m\"\ndof = \"uy\"\ngap = 0.01\nlaw = \"hertz\"\nstiffness = "
             "1e7\ndamping = { type = \"jankowski\", restitution = 0.6, mass = 1.0 }\n",
             "rodas4"}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace butee::test::able_methods_test
