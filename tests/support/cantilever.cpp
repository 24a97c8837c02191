#include "support/cantilever.hpp"

#include <cmath>
#include <numbers>

#include <butee/dynamics/modes.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test {

std::string steel_bar() {
  return R"(
schema = 1
[material.steel]
young_modulus = 2.1e11
density       = 7850.0
poisson_ratio = 0.3
[section.bar]
shape  = "rectangle"
width  = 0.03
height = 0.06
[integrator]
type = "newmark"
time_step = 1e-4
end_time = 1e-3
)";
}

std::string cantilever(const std::string& points, const std::string& up, const std::string& theory) {
  return steel_bar() + "[[element]]\ntype = \"beam\"\nname = \"arm\"\nmotion = \"spatial\"\nmaterial = \"steel\"\n" +
         "section = \"bar\"\nelements = 20\npoints = " + points + "\n" + (up.empty() ? "" : "up = " + up + "\n") +
         "theory = \"" + theory +
         "\"\n[[support]]\nnodes = \"arm:first\"\nfix = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n";
}

std::vector<double> frequencies(const std::string& toml, Index count) {
  SceneRun run(toml);
  const dynamics::Structure structure(run.model(), run.system().dofs);
  const auto modes = dynamics::find_modes(structure, count);
  EXPECT_EQ(modes.problem, "");
  std::vector<double> list;
  for (Index i = 0; i < count; ++i) list.push_back(modes.frequencies[i] / (2.0 * std::numbers::pi));
  return list;
}

void expect_all(const std::vector<double>& found, const std::vector<double>& wanted, double tolerance) {
  ASSERT_GE(found.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found[i], wanted[i], tolerance * wanted[i]) << i;
}

}  // namespace butee::test
