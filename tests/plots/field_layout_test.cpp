// Coordinates of the nodes in fields.
#include <algorithm>
#include <array>

#include <butee/record/field_layout.hpp>
#include <gtest/gtest.h>

#include "plots/field_parts.hpp"
#include "support/scene_run.hpp"

namespace butee::test::field_layout_test {
namespace {

model::FieldLayout layout_of(const std::string& toml) {
  const scene::Scene session = read_scene(toml);
  const model::System system = assemble(session.model);
  model::FieldRequest request;
  for (model::NodeId i = 0; i < session.model.nodes.size(); ++i) request.nodes.push_back(i);
  return record::make_layout(session.model, system, request);
}

std::array<double, 3> place(const model::FieldLayout& layout, const std::string& node) {
  const auto found = std::find(layout.nodes.begin(), layout.nodes.end(), node);
  return layout.positions.at(static_cast<std::size_t>(found - layout.nodes.begin()));
}

std::string beam(const std::string& name, const std::string& keys) {
  return "[[element]]\ntype = \"beam\"\nname = \"" + name + "\"\nmaterial = \"steel\"\nsection = \"pipe\"\n" + keys +
         "\n";
}

TEST(FieldLayout, PutsBeamsSideBySideAndEndToEnd) {
  using Place = std::array<double, 3>;
  const std::string parts = std::string(kParts) + beam("casing", "length = 10.0\nelements = 5") +
                            beam("next", "length = 4.0\nelements = 2\nstart_node = \"string:last\"") +
                            beam("branch", "length = 2.0\nelements = 2\nstart_node = \"string:5\"") +
                            "[integrator]\ntype = \"rk4\"\ntime_step = 1e-3\nend_time = 1e-3\n";
  const model::FieldLayout layout = layout_of(parts);
  EXPECT_EQ(place(layout, "string:3"), (Place{3.0, 0.0, 0.0}));
  EXPECT_EQ(place(layout, "casing:1"), (Place{2.0, 0.0, 0.5}));  // offset by 5 % of 10 m
  EXPECT_EQ(place(layout, "next:1"), (Place{12.0, 0.0, 0.0}));   // continues after the string
  EXPECT_EQ(place(layout, "branch:1"), (Place{6.0, 0.0, 1.0}));  // starts at the middle of the string, offset from it
  EXPECT_EQ(place(layout, "rotor"), (Place{3.0, 0.0, 1.5}));     // at the node to which its spring connects it
  EXPECT_EQ(layout.lines.size(), 4U);
}

TEST(FieldLayout, PutsLoneNodesIntoARow) {
  const std::string masses =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
      "\"b\"\nmass = 1.0\n[integrator]\ntype = \"rk4\"\ntime_step = 1e-3\nend_time = 1e-3\n";
  const model::FieldLayout layout = layout_of(masses);
  EXPECT_EQ(place(layout, "b"), (std::array<double, 3>{1.0, 0.0, 0.0}));
  EXPECT_TRUE(layout.lines.empty());
}

}  // namespace
}  // namespace butee::test::field_layout_test
