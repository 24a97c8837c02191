// A part of a system, compared with the same scene with all other DOFs supported.
#include <algorithm>

#include <butee/model/part.hpp>
#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::part_test {
namespace {

std::string stop(const std::string& keys) {
  return "\n[[contact]]\ntype = \"stop\"\ngap = 1.0e-3\nlaw = \"linear\"\nstiffness = 1.0e6\n" + keys + "\n";
}

std::string load(const std::string& node) {
  return "\n[[load]]\ntype = \"harmonic\"\nnode = \"" + node + "\"\namplitude = 2.0\nangular_frequency = 3.0\n";
}

/// Two beams side by side, connected in their middles by a dashpot, with a stop between two other nodes and
/// stops to ground.
std::string two_beams(const std::string& more = "") {
  const std::string mesh = "length = 8.0\nelements = 8";
  return kHeader + kSteelBar + "\n[damping]\nmass_proportional = 0.1\n" + beam("a", mesh) + beam("b", mesh) +
         "\n[[element]]\ntype = \"spring\"\nnodes = [\"a:5\", \"b:5\"]\nstiffness = 10.0\ndamping = 2.0\n" +
         stop("nodes = \"a:all\"") + stop(R"(between = ["b:4", "a:4"])") + load("a:4") + more +
         "\n[initial]\ndisplacement = [{ nodes = \"a:5\", dof = \"u\", value = 0.25 }]\n";
}

std::vector<Index> dofs_of(const SceneRun& scene, const std::vector<std::string>& nodes) {
  std::vector<Index> dofs;
  for (const std::string& node : nodes)
    for (const DofKind kind : {DofKind::u, DofKind::theta}) dofs.push_back(scene.dof(node, kind));
  std::sort(dofs.begin(), dofs.end());
  return dofs;
}

double difference(const SparseMatrix& a, const SparseMatrix& b) {
  return Eigen::MatrixXd(a - b).cwiseAbs().maxCoeff();
}

TEST(Part, IsTheSceneWithAllElseSupported) {
  const SceneRun whole(two_beams(load("b:8")));
  const SceneRun held(two_beams() + support(R"(["a:0..3", "a:7..8", "b:all"])", R"(["u", "theta"])"));
  const std::vector<Index> dofs = dofs_of(whole, {"a:4", "a:5", "a:6"});
  const model::System part = model::part_of(whole.system(), dofs);
  const model::System& expected = held.system();
  ASSERT_EQ(part.size(), expected.size());
  EXPECT_EQ(difference(part.mass, expected.mass), 0.0);
  EXPECT_EQ(difference(part.stiffness, expected.stiffness), 0.0);
  EXPECT_EQ(difference(part.dashpots, expected.dashpots), 0.0);
  EXPECT_EQ(part.damping.mass_proportional, expected.damping.mass_proportional);
  EXPECT_EQ(part.initial_displacement, expected.initial_displacement);
  EXPECT_EQ(part.initial_displacement.maxCoeff(), 0.25);
  ASSERT_EQ(part.stops.size(), 2u);
  ASSERT_EQ(expected.stops.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(part.stops[i].a, expected.stops[i].a);
    EXPECT_EQ(part.stops[i].b, expected.stops[i].b);
    EXPECT_EQ(part.stops[i].play.gap, expected.stops[i].play.gap);
  }
  ASSERT_EQ(part.loads.size(), 1u);
  EXPECT_EQ(part.loads[0].dofs, expected.loads.at(0).dofs);
  EXPECT_EQ(part.loads[0].weights, expected.loads.at(0).weights);
  for (std::size_t i = 0; i < dofs.size(); ++i)
    EXPECT_EQ(part.dofs.name(part.dofs.free()[i]), expected.dofs.name(expected.dofs.free()[i]));
}

TEST(Part, CountsPlacesFromWhereMotionBegins) {
  const SceneRun scene(two_beams());
  const std::vector<Index> from = {scene.dof("a:4")};
  const std::vector<Index> distance = model::distances(scene.system(), from);
  const auto of = [&](const std::string& node) { return distance[static_cast<std::size_t>(scene.dof(node))]; };
  EXPECT_EQ(of("a:4"), 0);
  EXPECT_EQ(of("a:0"), 4);
  EXPECT_EQ(of("a:7"), 3);
  EXPECT_EQ(of("b:4"), 1) << "by the stop between the two";
  EXPECT_EQ(of("b:5"), 2);
  EXPECT_EQ(of("b:0"), 5);
}

TEST(Part, KnowsWhatNothingLeadsTo) {
  const SceneRun scene(kHeader + kSteelBar + beam("a", "length = 1.0\nelements = 2") +
                       beam("b", "length = 1.0\nelements = 2"));
  const std::vector<Index> from = {scene.dof("a:1")};
  EXPECT_EQ(model::distances(scene.system(), from)[static_cast<std::size_t>(scene.dof("b:1"))], -1);
}

}  // namespace
}  // namespace butee::test::part_test
