#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::assembly_test {
namespace {

/// Rounding of a few operations on numbers of similar size.
constexpr double kRounding = 1e-13;

std::string spring(const std::string& keys) {
  return "\n[[element]]\ntype = \"spring\"\n" + keys + "\n";
}

Vector some_vector(Index size, double seed) {
  Vector v(size);
  for (Index i = 0; i < size; ++i) v[i] = std::sin(seed * static_cast<double>(i + 1));
  return v;
}

TEST(Assembly, NodesGetOnlyTheDofsThatAreUsed) {
  const SceneRun scene(kHeader + kSteelBar + mass("ball", "2.0") + beam("arm", "length = 1.0\nelements = 1") +
                       "\n[[element]]\ntype = \"mass\"\nname = \"wheel\"\nmass = 0\nrotary_inertia = 3.0\n");
  EXPECT_EQ(scene.system().size(), 1 + 4 + 1);
  EXPECT_GE(scene.dof("ball"), 0);
  EXPECT_EQ(scene.dof("ball", DofKind::theta), model::DofTable::kAbsent);
  EXPECT_EQ(scene.dof("wheel"), model::DofTable::kAbsent);
  EXPECT_GE(scene.dof("wheel", DofKind::theta), 0);
  EXPECT_EQ(scene.system().mass.coeff(scene.dof("wheel", DofKind::theta), scene.dof("wheel", DofKind::theta)), 3.0);
}

TEST(Assembly, SupportsTakeDofsAway) {
  const SceneRun scene(kHeader + kSteelBar + beam("arm", "length = 1.0\nelements = 2") +
                       support("\"arm:first\"", R"(["u", "theta"])") + support("\"arm:last\"", R"(["u"])"));
  EXPECT_EQ(scene.system().size(), 3);
  EXPECT_EQ(scene.system().dofs.fixed_count(), 3);
  EXPECT_EQ(scene.dof("arm:first"), model::DofTable::kFixed);
  EXPECT_EQ(scene.dof("arm:last", DofKind::theta), 2);
}

TEST(Assembly, MassSpringAndDashpot) {
  const SceneRun scene(kHeader + mass("ball", "2.0") + spring("node = \"ball\"\nstiffness = 50.0\ndamping = 0.7"));
  ASSERT_EQ(scene.system().size(), 1);
  EXPECT_EQ(scene.system().mass.coeff(0, 0), 2.0);
  EXPECT_EQ(scene.system().stiffness.coeff(0, 0), 50.0);
  EXPECT_EQ(scene.system().dashpots.coeff(0, 0), 0.7);
}

TEST(Assembly, WithoutDashpotsThereIsNoMatrixForThem) {
  const SceneRun scene(kHeader + mass("ball", "2.0") + spring("node = \"ball\"\nstiffness = 50.0"));
  EXPECT_EQ(scene.system().dashpots.size(), 0);
}

TEST(Assembly, MassOnABeamAddsToItsNode) {
  const std::string arm = kHeader + kSteelBar + beam("arm", "length = 1.0\nelements = 2");
  const SceneRun bare(arm);
  const SceneRun loaded(arm + "\n[[element]]\ntype = \"mass\"\nnode = \"arm:1\"\nmass = 5.0\nrotary_inertia = 0.25\n");
  const Eigen::MatrixXd added = Eigen::MatrixXd(loaded.system().mass) - Eigen::MatrixXd(bare.system().mass);
  const Index u = bare.dof("arm:1"), theta = bare.dof("arm:1", DofKind::theta);
  EXPECT_NEAR(added(u, u), 5.0, kRounding);
  EXPECT_NEAR(added(theta, theta), 0.25, kRounding);
  EXPECT_NEAR(added.lpNorm<1>(), 5.25, kRounding);
}

TEST(Assembly, SpringBetweenNodesCouplesThem) {
  SceneRun scene(kHeader + mass("a", "1.0") + mass("b", "2.0") +
                 spring("nodes = [\"a\", \"b\"]\nstiffness = 30.0\ndamping = 4.0"));
  const Eigen::MatrixXd pattern = (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  EXPECT_EQ(Eigen::MatrixXd(scene.system().stiffness), 30.0 * pattern);
  EXPECT_EQ(Eigen::MatrixXd(scene.system().dashpots), 4.0 * pattern);
}

TEST(Assembly, SpringBetweenRangesJoinsThemPairByPair) {
  SceneRun scene(kHeader + kSteelBar + beam("a", "length = 2.0\nelements = 2") +
                 beam("b", "length = 2.0\nelements = 2") +
                 spring("nodes = [\"a:1..2\", \"b:0..1\"]\nstiffness = 30.0\ndof = \"theta\""));
  const auto turn = [&](const char* node) { return scene.dof(node, DofKind::theta); };
  const SparseMatrix& stiffness = scene.system().stiffness;
  EXPECT_EQ(stiffness.coeff(turn("a:1"), turn("b:0")), -30.0);
  EXPECT_EQ(stiffness.coeff(turn("a:2"), turn("b:1")), -30.0);
  EXPECT_EQ(stiffness.coeff(turn("a:1"), turn("b:1")), 0.0);
  EXPECT_EQ(stiffness.coeff(scene.dof("a:1"), scene.dof("b:0")), 0.0);
}

TEST(Assembly, MatricesShareOnePatternWithPlacesForStopsBetweenNodes) {
  const SceneRun scene(
      kHeader + kSteelBar + beam("a", "length = 2.0\nelements = 2") + beam("b", "length = 2.0\nelements = 2") +
      spring("node = \"a:first\"\nstiffness = 1.0\ndamping = 2.0") +
      "\n[[contact]]\ntype = \"stop\"\nbetween = [\"a:all\", \"b:all\"]\ngap = 0.1\nstiffness = 1e3\n");
  const model::System& system = scene.system();
  EXPECT_EQ(system.mass.nonZeros(), system.stiffness.nonZeros());
  EXPECT_EQ(system.mass.nonZeros(), system.dashpots.nonZeros());
  for (const SparseMatrix* other : {&system.stiffness, &system.dashpots})
    EXPECT_TRUE(std::equal(system.mass.innerIndexPtr(), system.mass.innerIndexPtr() + system.mass.nonZeros(),
                           other->innerIndexPtr()));
  // Three nodes of two DOFs in a chain: 3 * 4 + 2 * 2 * 4 entries, twice; and two entries for each of three
  // stops.
  EXPECT_EQ(system.mass.nonZeros(), 2 * 28 + 2 * 3);
}

TEST(Assembly, RayleighDampingAndDashpotsMakeTheDampingForce) {
  SceneRun scene(kHeader + kSteelBar + beam("arm", "length = 2.0\nelements = 3") +
                 spring("node = \"arm:1\"\nstiffness = 100.0\ndamping = 33.0") +
                 "\n[damping]\nmass_proportional = 0.7\nstiffness_proportional = 2.0e-4\n");
  const model::System& system = scene.system();
  const Vector v = some_vector(system.size(), 0.7);
  Vector force(v.size());
  scene.dynamics().damping_force(v, force);
  const Vector expected = 0.7 * (system.mass * v) + 2.0e-4 * (system.stiffness * v) + system.dashpots * v;
  EXPECT_LE((force - expected).norm(), kRounding * expected.norm());
  EXPECT_TRUE(scene.dynamics().has_damping());
}

TEST(Assembly, AccelerationSolvesTheEquationOfMotion) {
  SceneRun scene(kHeader + kSteelBar + beam("arm", "length = 2.0\nelements = 3") +
                 support("\"arm:first\"", R"(["u"])") + spring("node = \"arm:1\"\nstiffness = 1e5\ndamping = 33.0") +
                 "\n[[load]]\ntype = \"constant\"\nnode = \"arm:last\"\nvalue = 700.0\n" +
                 "\n[[contact]]\ntype = \"stop\"\nnodes = \"arm:all\"\ngap = 0.1\nstiffness = 1e5\n" +
                 "\n[damping]\nmass_proportional = 0.7\nstiffness_proportional = 2.0e-4\n");
  const Index n = scene.system().size();
  const Vector x = some_vector(n, 0.9), v = some_vector(n, 1.3);
  Vector a(n), sum(n), part(n);
  scene.dynamics().acceleration(0.0, x, v, a);
  scene.dynamics().external_force(0.0, sum);
  scene.dynamics().add_contact_force(x, sum);
  scene.dynamics().damping_force(v, part);
  sum -= part;
  scene.dynamics().elastic_force(x, part);
  sum -= part;
  const double size = sum.norm();
  scene.dynamics().inertia_force(a, part);
  EXPECT_LE((sum - part).norm(), kRounding * size);
  EXPECT_EQ(scene.dynamics().counters().force_evaluations, 1);
}

TEST(Assembly, InitialValuesComeBySelector) {
  const SceneRun scene(kHeader + kSteelBar + beam("arm", "length = 2.0\nelements = 2") +
                       "\n[initial]\ndisplacement = [{ nodes = \"arm:1..2\", value = 0.5 }]\n"
                       "velocity = [{ nodes = \"arm:first\", dof = \"theta\", value = -2 }]\n");
  EXPECT_EQ(scene.system().initial_displacement[scene.dof("arm:1")], 0.5);
  EXPECT_EQ(scene.system().initial_displacement[scene.dof("arm:2")], 0.5);
  EXPECT_EQ(scene.system().initial_displacement.lpNorm<1>(), 1.0);
  EXPECT_EQ(scene.system().initial_velocity[scene.dof("arm:first", DofKind::theta)], -2.0);
}

TEST(Assembly, AFreeDofWithoutMassIsAnErrorThatNamesIt) {
  const std::string message =
      refusal(kHeader + mass("ball", "1.0") + spring("node = \"ball\"\ndof = \"theta\"\nstiffness = 2"));
  EXPECT_TRUE(holds(message, "theta of ball has no mass")) << message;
}

/// A rotor in a flexible casing: two beams, bearing springs and stops between them. They are not connected to
/// ground, so a common translation causes no force.
TEST(Assembly, RotorInAFlexibleCasing) {
  SceneRun scene(
      kHeader + kSteelBar + beam("rotor", "length = 2.0\nelements = 8") + beam("casing", "length = 2.0\nelements = 8") +
      spring("nodes = [\"rotor:first\", \"casing:first\"]\nstiffness = 1e6\ndamping = 10.0") +
      spring("nodes = [\"rotor:last\", \"casing:last\"]\nstiffness = 1e6\ndamping = 10.0") +
      "\n[[contact]]\ntype = \"stop\"\nbetween = [\"rotor:2..6\", \"casing:2..6\"]\ngap = 0.001\nstiffness = "
      "1e7\n");
  EXPECT_EQ(scene.system().size(), 2 * 18);
  EXPECT_EQ(scene.dynamics().stop_count(), 5);
  Vector shift = Vector::Zero(36), force(36);
  for (int i = 0; i < 9; ++i)
    for (const char* part : {"rotor:", "casing:"}) shift[scene.dof(part + std::to_string(i))] = 1.0;
  scene.dynamics().elastic_force(shift, force);
  EXPECT_LE(force.norm(), kRounding * Eigen::MatrixXd(scene.system().stiffness).norm());
  scene.dynamics().damping_force(shift, force);
  EXPECT_LE(force.norm(), kRounding * 10.0);
  force.setZero();
  scene.dynamics().add_contact_force(shift, force);
  EXPECT_TRUE(force.isZero(0.0));
}

}  // namespace
}  // namespace butee::test::assembly_test
