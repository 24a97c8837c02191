// Preload, gravity, static starts and accelerated bases, compared with closed forms.
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/SparseCholesky>
#include <butee/record/probes.hpp>
#include <gtest/gtest.h>

#include "support/cantilever.hpp"
#include "support/scene_run.hpp"

namespace butee::test::tied_bar_test {
namespace {

using std::numbers::pi;

std::string tied_bar(double preload, int elements, const std::string& more = "") {
  return R"(
schema = 1
[material.steel]
young_modulus = 2e11
density       = 7800.0
[section.round]
shape  = "circle"
radius = 0.005
[integrator]
type = "newmark"
time_step = 1e-4
end_time = 1e-3
[[element]]
type = "beam"
name = "bar"
material = "steel"
section = "round"
length = 2.0
preload = )" +
         std::to_string(preload) + "\nelements = " + std::to_string(elements) +
         "\n[[support]]\nnodes = [\"bar:first\", \"bar:last\"]\nfix = [\"u\"]\n" + more;
}

/// code_aster's SDLL101: f_n = n^2 pi/(2 L^2) sqrt(E I/m) sqrt(1 + P L^2/(n^2 pi^2 E I)).
TEST(TiedBar, StiffensWithTension) {
  expect_all(frequencies(tied_bar(1000.0, 20), 5), {11.2577073, 28.3462835, 54.0382821, 89.2209917, 134.1811141}, 5e-9);
  expect_all(frequencies(tied_bar(-100.0, 80), 3), {3.809372, 18.831035, 43.703291}, 5e-7);
}

TEST(TiedBar, SagsUnderGravity) {
  const auto sag = [](double preload) {
    SceneRun run(tied_bar(preload, 40, "[gravity]\nacceleration = [0.0, -9.81, 0.0]\n"));
    Vector force(run.system().size());
    run.dynamics().external_force(0.0, force);
    const Eigen::SimplicialLDLT<SparseMatrix> factor(run.system().stiffness);
    return -Vector(factor.solve(force))[run.dof("bar:middle")];
  };
  EXPECT_NEAR(sag(0.0), .0127530000, 1e-10);
  EXPECT_NEAR(sag(100.0), .0090145068, 5e-8 * .009);
  EXPECT_NEAR(sag(1000.0), .0024632794, 5e-8 * .0025);
  EXPECT_NEAR(sag(-30.0), .0145618950, 5e-8 * .0146);
}

/// Started in its static position on a stop, a bar stays there; the stop carries the force due to the sag
/// beyond it.
TEST(TiedBar, RestsWhereGravityAndAStopHoldIt) {
  const std::string stop =
      "[[contact]]\ntype = \"stop\"\nnodes = \"bar:middle\"\ngap = 0.005\nlaw = \"linear\"\nstiffness = 1e4\n";
  SceneRun run(tied_bar(0.0, 20, "[gravity]\nacceleration = [0.0, -9.81, 0.0]\nstatic = true\n" + stop));
  // u = sag - F L^3/(48 E I) with F = k (u - gap); elements with cubic shape functions are exact at nodes.
  constexpr double kBar = 48.0 * 2e11 * (pi / 4 * 0.005 * 0.005 * 0.005 * 0.005) / 8.0;
  const double wanted = (.0127530000 + 1e4 * 0.005 / kBar) / (1.0 + 1e4 / kBar);
  const Index middle = run.dof("bar:middle");
  const double start = run.system().initial_displacement[middle];
  EXPECT_NEAR(-start, wanted, 1e-9 * wanted);
  ASSERT_TRUE(run.run().completed);
  EXPECT_NEAR(run.simulation().state().x[middle], start, 1e-9 * wanted);
}

/// Fine meshes, whose residual never falls below rounding, and stiff stops, on which Newton's full steps
/// only change which stops are closed.
TEST(StaticPosition, IsFoundOnFineMeshesAndStiffStops) {
  const std::string gravity = "[gravity]\nacceleration = [0.0, -9.81, 0.0]\nstatic = true\n";
  for (const int elements : {120, 300, 1000}) {
    SceneRun run(tied_bar(0.0, elements, gravity));
    const double sag = run.system().initial_displacement[run.dof("bar:middle")];
    EXPECT_NEAR(-sag, .0127530000, elements < 1000 ? 1e-8 : 1e-6) << elements;
  }
  for (const char* stiffness : {"1e6", "1e9"})
    for (const char* gap : {"0.0", "1e-3", "0.01"}) {
      SceneRun run(tied_bar(0.0, 34,
                            gravity + "[[contact]]\ntype = \"stop\"\nnodes = \"bar:all\"\nlaw = \"linear\"\ngap = " +
                                gap + "\nstiffness = " + stiffness + "\n"));
      Vector residual(run.system().size());
      const Vector& x = run.system().initial_displacement;
      run.dynamics().external_force(0.0, residual);
      const double size = residual.norm();
      run.dynamics().add_contact_force(x, residual);
      residual -= run.system().stiffness * x;
      EXPECT_LT(residual.norm(), 1e-9 * size) << stiffness << " " << gap;
    }
}

/// A rod in space, held at its first node; `keys` continues its beam.
std::string rod(const std::string& keys) {
  return R"(
schema = 1
[material.steel]
young_modulus = 2e11
density       = 7800.0
poisson_ratio = 0.3
[section.round]
shape  = "circle"
radius = 0.02
[integrator]
type = "newmark"
time_step = 1e-4
end_time = 1e-3
[[support]]
nodes = ["rod:first"]
fix = ["ux", "uy", "uz", "rx", "ry", "rz"]
[[element]]
type = "beam"
name = "rod"
motion = "spatial"
material = "steel"
section = "round"
up = [0, 0, 1]
)" + keys;
}

/// The values of probes at the start.
std::vector<double> at_start(const std::string& toml, const std::string& node,
                             const std::vector<model::Quantity>& quantities) {
  SceneRun run(toml);
  record::Probes probes({{"p", run.model().nodes.select(node).nodes.front(), quantities, ""}}, run.dynamics());
  run.simulation().start();
  std::vector<double> values(quantities.size());
  probes.evaluate(run.simulation().state(), values);
  return values;
}

/// A hanging rod whose bending is stiffened by its own weight: N is the weight below, once.
TEST(PreloadOfGravity, IsNotCountedTwiceInSectionForces) {
  using model::Quantity;
  const auto top = at_start(rod(R"(points = [[0, 0, 0], [0, -10, 0]]
elements = 20
preload = "gravity"
[[element]]
type = "mass"
node = "rod:last"
mass = 50.0
[gravity]
acceleration = [0.0, -9.81, 0.0]
static = true
)"),
                            "rod:first", {Quantity::normal_force, Quantity::von_mises, Quantity::reaction_uy});
  const double area = pi * 0.02 * 0.02, weight = 9.81 * (50.0 + 7800.0 * area * 10.0);
  EXPECT_NEAR(top[0], weight, 1e-8 * weight);
  EXPECT_NEAR(top[1], weight / area, 1e-8 * weight / area);
  EXPECT_NEAR(top[2], weight, 1e-8 * weight);
}

/// A tie that is stretched before the start: its supports carry the preload.
TEST(Preload, IsPartOfReactions) {
  using model::Quantity;
  const std::string tie = rod(R"(points = [[0, 0, 0], [3, 4, 0]]
elements = 4
preload = 5000.0
[[support]]
nodes = ["rod:last"]
fix = ["ux", "uy", "uz", "rx", "ry", "rz"]
)");
  for (const auto& [node, sign] : {std::pair("rod:first", -1.0), {"rod:last", 1.0}}) {
    const auto end = at_start(tie, node, {Quantity::normal_force, Quantity::reaction_ux, Quantity::reaction_uy});
    EXPECT_NEAR(end[0], 5000.0, 1e-9);
    EXPECT_NEAR(end[1], sign * 3000.0, 1e-9);
    EXPECT_NEAR(end[2], sign * 4000.0, 1e-9);
  }
}

/// An accelerating base is a force -M r a: closed form for one mass.
TEST(Base, AcceleratesEveryMass) {
  SceneRun run(R"(
schema = 1
[[element]]
type = "mass"
name = "m"
mass = 2.5
[[element]]
type = "spring"
node = "m"
stiffness = 1000.0
[base]
acceleration = { direction = [0, 2, 0], type = "constant", value = 3.0 }
[integrator]
type = "exact"
end_time = 1.0
)");
  ASSERT_TRUE(run.run().completed);
  const double omega = 20.0, wanted = -3.0 / (omega * omega) * (1.0 - std::cos(omega));
  EXPECT_NEAR(run.simulation().state().x[0], wanted, 1e-13);
}

}  // namespace
}  // namespace butee::test::tied_bar_test
