#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::selector_test {
namespace {

using model::NodeId;

/// A beam of seven unevenly spaced nodes, one of six evenly spaced nodes, and a lone node.
model::NodeTable table() {
  model::NodeTable nodes;
  nodes.add("string", {0.0, 1.0, 2.5, 3.0, 4.0, 5.5, 6.0});
  nodes.add("even", {0.0, 0.1, 0.2, 0.3, 0.4, 0.5});
  nodes.add("rotor");
  return nodes;
}

TEST(Selector, NamesTheNodesOfABeam) {
  const model::NodeTable nodes = table();
  const auto expect = [&](const char* selector, const std::vector<NodeId>& wanted) {
    const model::Selection selection = nodes.select(selector);
    EXPECT_EQ(selection.problem, "") << selector;
    EXPECT_EQ(selection.nodes, wanted) << selector;
  };
  expect("string:first", {0});
  expect("string:last", {6});
  expect("string:middle", {3});
  expect("string:5", {5});
  expect("string:2..4", {2, 3, 4});
  expect("string:all", {0, 1, 2, 3, 4, 5, 6});
  expect("string@2.5", {2});
  expect("string@5.500000001", {5});  // 1e-9 of a length of 6 m is 6e-9 m
  expect("string@6", {6});
  expect("even:first", {7});
  expect("even:0..0", {7});
  expect("rotor", {13});
}

TEST(Selector, SaysWhyItNamesNone) {
  const model::NodeTable nodes = table();
  const auto expect = [&](const char* selector, const std::vector<std::string>& parts) {
    const model::Selection selection = nodes.select(selector);
    EXPECT_TRUE(selection.nodes.empty()) << selector;
    for (const std::string& part : parts)
      EXPECT_TRUE(holds(selection.problem, part)) << selector << ": \"" << part << "\" in " << selection.problem;
  };
  expect("string@2.2", {"string:1 at 1 m", "string:2 at 2.5 m"});
  expect("string@-3", {"string:0 at 0 m", "string:1 at 1 m"});
  expect("string@7", {"string:5 at 5.5 m", "string:6 at 6 m"});
  expect("string@2.50000002", {"string:2 at 2.5 m", "string:3 at 3 m"});
  expect("string@x", {"not a coordinate"});
  expect("string@nan", {"not a coordinate"});
  expect("even:middle", {"even number of nodes (6)"});
  expect("string:7", {"0 ... 6"});
  expect("string:-1", {"0 ... 6"});
  expect("string:4..2", {"0 ... 6"});
  expect("string:4..", {"not a part of a beam"});
  expect("string:midle", {"did you mean \"middle\"?", "string:0..6"});
  expect("string", {"a beam of 7 nodes", "string:first"});
  expect("rotor:first", {"single node"});
  expect("strign:first", {"did you mean \"string\"?", "rotor"});
  expect("", {"no node or beam"});
}

TEST(Selector, NodesHaveNames) {
  const model::NodeTable nodes = table();
  EXPECT_EQ(nodes.name(4), "string:4");
  EXPECT_EQ(nodes.name(7), "even:0");
  EXPECT_EQ(nodes.name(13), "rotor");
}

TEST(Selector, JoinedNodesAreOne) {
  model::NodeTable nodes = table();
  nodes.join(6, 7);
  nodes.join(13, 7);
  EXPECT_EQ(nodes.canonical(7), 6);
  EXPECT_EQ(nodes.canonical(13), 6);
  EXPECT_EQ(nodes.canonical(5), 5);
}

TEST(Selector, MistakesInASceneCarryTheirKey) {
  const std::string scene = kHeader + kSteelBar + beam("string", "length = 6.0\nelements = 5");
  const auto expect = [&](const std::string& more, const std::string& part) {
    const std::string message = refusal(scene + more);
    EXPECT_TRUE(holds(message, part)) << "\"" << part << "\" in \"" << message << "\"";
  };
  expect(support("\"string:middle\"", R"(["u"])"), "support[0].nodes = \"string:middle\"");
  expect(support(R"(["string:first", "string:0"])", R"(["u"])"), "names string:0 twice");
  expect("\n[[load]]\ntype = \"constant\"\nvalue = 1.0\nnode = \"string:all\"\n", "names 6 nodes");
  expect("\n[[load]]\ntype = \"constant\"\nvalue = 1.0\nnode = \"string@1.0\"\n",
         "string:0 at 0 m and string:1 at 1.2 m");
  expect("\n[[contact]]\ntype = \"stop\"\ngap = 0.0\nstiffness = 1.0\nbetween = [\"string:0..1\", \"string:3..5\"]\n",
         "pairs nodes one by one");
}

}  // namespace
}  // namespace butee::test::selector_test
