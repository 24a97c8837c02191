#include "elements/beam.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/SparseCholesky>
#include <gtest/gtest.h>

#include "elements/elements.hpp"
#include "unit/scenes.hpp"

namespace butee::test::beam_test {
namespace {

/// Rounding of some operations on numbers of similar size, relative to the largest.
constexpr double kRounding = 1e-13;
/// Error of a direct solution: rounding times the condition number of the few elements used here.
constexpr double kSolved = 1e-9;

const model::Material kMaterial{kYoung, kDensity};
const model::Section kSection{kArea, kSecondMoment};

elements::BendingMatrices bending(double l) {
  return elements::BendingMatrices({l, kYoung * kSecondMoment, kMassPerLength, 0.0, 0.0, 0.0});
}

Vector static_solution(SceneRun& scene) {
  Vector force(scene.system().size());
  scene.dynamics().external_force(0.0, force);
  const Eigen::SimplicialLDLT<SparseMatrix> factor(scene.system().stiffness);
  EXPECT_EQ(factor.info(), Eigen::Success);
  return factor.solve(force);
}

std::string constant_load(const std::string& node, double value) {
  return "\n[[load]]\ntype = \"constant\"\nnode = \"" + node + "\"\nvalue = " + std::to_string(value) + "\n";
}

std::string line_load(const std::string& name, double value) {
  return "\n[[load]]\ntype = \"distributed\"\nbeam = \"" + name + "\"\nvalue = " + std::to_string(value) + "\n";
}

class BeamElement : public testing::TestWithParam<double> {};

TEST_P(BeamElement, MatricesAreSymmetric) {
  const auto matrices = bending(GetParam());
  EXPECT_EQ(matrices.mass, matrices.mass.transpose());
  EXPECT_EQ(matrices.stiffness, matrices.stiffness.transpose());
}

TEST_P(BeamElement, RigidMotionHasNoElasticForce) {
  const double l = GetParam();
  const auto matrices = bending(l);
  for (const Eigen::Vector4d& motion : {Eigen::Vector4d(1, 0, 1, 0), Eigen::Vector4d(0, 1, l, 1)}) {
    const Eigen::Vector4d force = matrices.stiffness * motion;
    const Eigen::Vector4d size = matrices.stiffness.cwiseAbs() * motion.cwiseAbs();
    for (Index i = 0; i < 4; ++i) EXPECT_LE(std::abs(force[i]), kRounding * size[i]);
  }
}

TEST_P(BeamElement, RigidMotionHasTheInertiaOfAThinRod) {
  const double l = GetParam(), m = kMassPerLength * l;
  const auto matrices = bending(l);
  const auto twice_kinetic = [&](const Eigen::Vector4d& v) { return v.dot(matrices.mass * v); };
  EXPECT_NEAR(twice_kinetic({1, 0, 1, 0}), m, kRounding * m);
  EXPECT_NEAR(twice_kinetic({0, 1, l, 1}), m * l * l / 3, kRounding * m * l * l);
  EXPECT_NEAR(twice_kinetic({-l / 2, 1, l / 2, 1}), m * l * l / 12, kRounding * m * l * l);
}

INSTANTIATE_TEST_SUITE_P(lengths, BeamElement, testing::Values(1e-3, 0.37, 1.0, 25.0));

TEST(Beam, UnevenFreeBeamHasTheInertiaOfAThinRod) {
  SceneRun scene(kHeader + kSteelBar + beam("rod", "coordinates = [0.0, 0.1, 0.5, 1.7, 2.0]"));
  constexpr double kLength = 2.0, kMass = kMassPerLength * kLength;
  Vector shift = Vector::Zero(scene.system().size()), turn = shift;
  const double x[] = {0.0, 0.1, 0.5, 1.7, 2.0};
  for (int i = 0; i < 5; ++i) {
    const std::string node = "rod:" + std::to_string(i);
    shift[scene.dof(node)] = 1.0;
    turn[scene.dof(node)] = x[i] - 1.0;
    turn[scene.dof(node, DofKind::theta)] = 1.0;
  }
  const SparseMatrix& mass = scene.system().mass;
  EXPECT_NEAR(shift.dot(mass * shift), kMass, kRounding * kMass);
  EXPECT_NEAR(turn.dot(mass * turn), kMass * kLength * kLength / 12, kRounding * kMass);
  EXPECT_NEAR(shift.dot(mass * turn), 0.0, kRounding * kMass);
}

/// F L^3/(3 EI) and F L^2/(2 EI), from textbooks on strength of materials.
TEST(Beam, CantileverUnderATipLoadBendsByTheClosedForm) {
  constexpr double kForce = -1000.0, kLength = 3.0;
  SceneRun scene(kHeader + kSteelBar + beam("arm", "length = 3.0\nelements = 7") +
                 support("\"arm:first\"", R"(["u", "theta"])") + constant_load("arm:last", kForce));
  const Vector x = static_solution(scene);
  const double tip = kForce * std::pow(kLength, 3) / (3 * kBending),
               slope = kForce * kLength * kLength / (2 * kBending);
  EXPECT_NEAR(x[scene.dof("arm:last")], tip, kSolved * std::abs(tip));
  EXPECT_NEAR(x[scene.dof("arm:last", DofKind::theta)], slope, kSolved * std::abs(slope));
}

/// u = q x (L^3 - 2 L x^2 + x^3)/(24 EI), the middle at 5 q L^4/(384 EI). Hermite cubics with consistent loads are
/// exact at the nodes of any mesh.
TEST(Beam, PinnedBeamUnderALineLoadIsExactAtTheNodesOfAnyMesh) {
  constexpr double kLoad = 750.0, kLength = 4.0;
  const std::vector<double> uneven = {0.0, 0.2, 0.3, 1.1, 2.0, 3.7, 4.0}, even = {0.0, 1.0, 2.0, 3.0, 4.0};
  const std::string ends = support(R"(["string:first", "string:last"])", R"(["u"])") + line_load("string", kLoad);
  SceneRun on_uneven(kHeader + kSteelBar + beam("string", "coordinates = [0, 0.2, 0.3, 1.1, 2.0, 3.7, 4.0]") + ends);
  SceneRun on_even(kHeader + kSteelBar + beam("string", "length = 4.0\nelements = 4") + ends);
  const double middle = 5 * kLoad * std::pow(kLength, 4) / (384 * kBending);
  const double end_slope = kLoad * std::pow(kLength, 3) / (24 * kBending);
  for (const auto& [scene, nodes] : {std::pair(&on_uneven, &uneven), std::pair(&on_even, &even)}) {
    const Vector x = static_solution(*scene);
    EXPECT_NEAR(x[scene->dof("string@2.0")], middle, kSolved * middle);
    EXPECT_NEAR(x[scene->dof("string:first", DofKind::theta)], end_slope, kSolved * end_slope);
    for (std::size_t i = 1; i + 1 < nodes->size(); ++i) {
      const double s = (*nodes)[i];
      const double u = kLoad * s * (std::pow(kLength, 3) - 2 * kLength * s * s + s * s * s) / (24 * kBending);
      EXPECT_NEAR(x[scene->dof("string:" + std::to_string(i))], u, kSolved * middle);
    }
  }
}

TEST(Beam, SymmetricSceneMovesSymmetrically) {
  SceneRun scene(kHeader + kSteelBar + beam("string", "length = 4.0\nelements = 6") +
                     support(R"(["string:first", "string:last"])", R"(["u"])") + constant_load("string:middle", 500.0),
                 {"integrator.end_time=0.05"});
  ASSERT_TRUE(scene.run().completed);
  const Vector& x = scene.simulation().state().x;
  const double size = x.cwiseAbs().maxCoeff();
  ASSERT_GT(size, 0.0);
  for (int i = 0; i < 3; ++i) {
    const std::string left = "string:" + std::to_string(i), right = "string:" + std::to_string(6 - i);
    const Index turn_left = scene.dof(left, DofKind::theta), turn_right = scene.dof(right, DofKind::theta);
    EXPECT_NEAR(x[turn_left], -x[turn_right], kSolved * size);
    if (i > 0) {
      EXPECT_NEAR(x[scene.dof(left)], x[scene.dof(right)], kSolved * size);
    }
  }
}

TEST(Beam, TwoBeamsThatShareANodeAreOneBeam) {
  const std::string hold = support("\"left:first\"", R"(["u", "theta"])");
  const SceneRun one(kHeader + kSteelBar + beam("left", "coordinates = [0.0, 0.4, 1.0, 1.25, 2.0]") + hold);
  const SceneRun by_start(kHeader + kSteelBar + beam("left", "coordinates = [0.0, 0.4, 1.0]") +
                          beam("right", "coordinates = [1.0, 1.25, 2.0]\nstart_node = \"left:last\"") + hold);
  ASSERT_EQ(by_start.system().size(), one.system().size());
  const Eigen::MatrixXd mass(one.system().mass), stiffness(one.system().stiffness);
  EXPECT_LE((Eigen::MatrixXd(by_start.system().mass) - mass).norm(), kRounding * mass.norm());
  EXPECT_LE((Eigen::MatrixXd(by_start.system().stiffness) - stiffness).norm(), kRounding * stiffness.norm());
}

/// Tip deflection F/(3E) [(L^3 - b^3)/I_1 + b^3/I_2] with b the length of the thin part, by Castigliano's theorem.
TEST(Beam, SteppedCantileverBendsByTheClosedForm) {
  constexpr double kForce = 100.0, kLength = 3.0, kThin = 1.0, kThinMoment = 5.0e-7;
  const std::string thin_part = R"(
[section.thin]
shape         = "general"
area          = 1.0e-3
second_moment = 5.0e-7

[[element]]
type     = "beam"
name     = "thin"
material = "steel"
section  = "thin"
length   = 1.0
elements = 3
)";
  const std::string hold = support("\"thick:first\"", R"(["u", "theta"])") + constant_load("thin:last", kForce);
  const std::string thick = beam("thick", "length = 2.0\nelements = 2");
  SceneRun by_start(kHeader + kSteelBar + thick + thin_part + "start_node = \"thick:last\"\n" + hold);
  SceneRun by_end(kHeader + kSteelBar + beam("thick", "length = 2.0\nelements = 2\nend_node = \"thin:first\"") +
                  thin_part + hold);
  const double b3 = std::pow(kThin, 3);
  const double tip = kForce / (3 * kYoung) * ((std::pow(kLength, 3) - b3) / kSecondMoment + b3 / kThinMoment);
  EXPECT_NEAR(static_solution(by_start)[by_start.dof("thin:last")], tip, kSolved * tip);
  EXPECT_NEAR(static_solution(by_end)[by_end.dof("thin:last")], tip, kSolved * tip);
}

model::Section section(const std::string& shape, const std::vector<std::pair<std::string, double>>& values) {
  const auto types = elements::section_types();
  const auto* type = model::find_type(types, shape);
  config::Table table;
  for (const auto& [key, value] : values) table[key] = config::Value(value);
  const config::Document document{{"section"}, config::Value(table)};
  config::Diagnostics diagnostics(document);
  return type->make(config::make_parameters(type->parameters, table), diagnostics).value();
}

TEST(Section, ShapesHaveTheirAreaAndSecondMoment) {
  using std::numbers::pi;
  const auto expect = [](const model::Section& got, double area, double second_moment) {
    EXPECT_NEAR(got.area, area, kRounding * area);
    EXPECT_NEAR(got.second_moment, second_moment, kRounding * second_moment);
  };
  expect(section("tube", {{"outer_radius", 0.06}, {"inner_radius", 0.04}}), pi * 0.002, pi / 4 * 1.04e-5);
  expect(section("circle", {{"radius", 0.1}}), pi * 0.01, pi / 4 * 1e-4);
  expect(section("rectangle", {{"width", 0.2}, {"height", 0.3}}), 0.06, 4.5e-4);
  expect(section("general", {{"area", 0.5}, {"second_moment", 0.25}}), 0.5, 0.25);
  EXPECT_EQ(elements::section_types().size(), 4U);
}

TEST(Section, TubeWithoutAWallIsRefused) {
  const std::string tube = "\n[section.pipe]\nshape = \"tube\"\nouter_radius = 0.1\ninner_radius = 0.1\n";
  const std::string message = refusal(kHeader + kSteelBar + tube + beam("rod", "length = 1.0\nelements = 1"));
  EXPECT_TRUE(holds(message, "section.pipe.inner_radius")) << message;
}

}  // namespace
}  // namespace butee::test::beam_test
