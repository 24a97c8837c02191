#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include <Eigen/SparseCholesky>
#include <butee/record/probes.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"
#include "unit/scenes.hpp"

namespace butee::test::element_forces_test {
namespace {

/// Relative to the largest value: the static solution of 40 DOFs has some eleven correct digits.
constexpr double kStatic = 1e-9;

std::string probe(const std::string& label, const std::string& node, const std::string& quantities,
                  const std::string& more = "") {
  return "\n[[output.probe]]\nlabel = \"" + label + "\"\nnode = \"" + node + "\"\nquantities = " + quantities + "\n" +
         more + "\n";
}

std::string force(const std::string& node, const std::string& value, const std::string& dof = "u") {
  return "\n[[load]]\ntype = \"constant\"\nnode = \"" + node + "\"\ndof = \"" + dof + "\"\nvalue = " + value + "\n";
}

const std::string kLineLoad = "\n[[load]]\ntype = \"distributed\"\nbeam = \"bar\"\nvalue = 50.0\n";

using Values = std::map<std::string, double>;

/// The probe values of a scene for a given motion.
class Shown {
 public:
  explicit Shown(const std::string& toml) : session_(std::make_unique<scene::Scene>(read_scene(toml))) {
    system_ = std::make_unique<model::System>(assemble(session_->model));
    dynamics_ = std::make_unique<dynamics::Dynamics>(*system_);
    probes_ = std::make_unique<record::Probes>(session_->output.probes, *dynamics_);
  }

  /// x = K^-1 F(0)
  Values at_static_rest() {
    time::State state;
    Vector f(system_->size());
    dynamics_->external_force(0.0, f);
    const Eigen::SimplicialLDLT<SparseMatrix> factor(system_->stiffness);
    state.x = factor.solve(f);
    state.x += factor.solve(Vector(f - system_->stiffness * state.x));
    state.v = state.a = Vector::Zero(system_->size());
    return of(state);
  }

  Values of(const time::State& state) {
    std::vector<double> values(probes_->columns().size());
    probes_->evaluate(state, values);
    Values named;
    for (std::size_t i = 0; i < values.size(); ++i) named[probes_->columns()[i]] = values[i];
    return named;
  }

 private:
  std::unique_ptr<scene::Scene> session_;
  std::unique_ptr<model::System> system_;
  std::unique_ptr<dynamics::Dynamics> dynamics_;
  std::unique_ptr<record::Probes> probes_;
};

void expect_all(const Values& values, const Values& expected, double tolerance) {
  double largest = 0.0;
  for (const auto& [name, value] : expected) largest = std::max(largest, std::abs(value));
  for (const auto& [name, value] : expected) {
    ASSERT_TRUE(values.contains(name)) << name;
    EXPECT_NEAR(values.at(name), value, tolerance * largest) << name;
  }
}

std::string cantilever(const std::string& loads) {
  return kHeader + kSteelBar + beam("bar", "length = 2.0\nelements = 8") +
         support("\"bar:first\"", "[\"u\", \"theta\"]") + loads +
         probe("root", "bar:first", R"(["V", "M", "reaction", "reaction_moment"])") +
         probe("half", "bar@1.0", R"(["V", "M"])") + probe("tip", "bar:last", R"(["V", "M"])");
}

TEST(ElementForces, ACantileverWithAForceAndAMomentAtItsTip) {
  // M = P (L - x) + M0 = E I u'', V = -dM/dx = P
  expect_all(Shown(cantilever(force("bar:last", "120.0") + force("bar:last", "30.0", "theta"))).at_static_rest(),
             {{"root.V", 120.0},
              {"root.M", 270.0},
              {"root.reaction", -120.0},
              {"root.reaction_moment", -270.0},
              {"half.V", 120.0},
              {"half.M", 150.0},
              {"tip.V", 120.0},
              {"tip.M", 30.0}},
             kStatic);
}

TEST(ElementForces, ACantileverUnderALineLoad) {
  // M = q (L - x)^2 / 2, V = q (L - x)
  expect_all(Shown(cantilever(kLineLoad)).at_static_rest(),
             {{"root.V", 100.0},
              {"root.M", 100.0},
              {"root.reaction", -100.0},
              {"root.reaction_moment", -100.0},
              {"half.V", 50.0},
              {"half.M", 25.0},
              {"tip.V", 0.0},
              {"tip.M", 0.0}},
             kStatic);
}

TEST(ElementForces, TwoSpansUnderALineLoad) {
  // Spans L = 1 m with q = 50 N/m upwards: reactions -3/8, -10/8, -3/8 q L, and the moment q L^2 / 8 over the
  // middle support.
  expect_all(Shown(kHeader + kSteelBar + beam("bar", "length = 2.0\nelements = 8") +
                   support(R"(["bar:first", "bar:middle", "bar:last"])", "[\"u\"]") + kLineLoad +
                   probe("left", "bar:first", R"(["reaction", "V", "M"])") +
                   probe("before", "bar:middle", R"(["reaction", "V", "M"])") +
                   probe("after", "bar:middle", R"(["V", "M"])", "element = \"bar:4\"") +
                   probe("right", "bar:last", R"(["reaction", "V", "M"])"))
                 .at_static_rest(),
             {{"left.reaction", -18.75},
              {"left.V", 18.75},
              {"left.M", 0.0},
              {"before.reaction", -62.5},
              {"before.V", -31.25},
              {"before.M", 6.25},
              {"after.V", 31.25},
              {"after.M", 6.25},
              {"right.reaction", -18.75},
              {"right.V", -18.75},
              {"right.M", 0.0}},
             kStatic);
}

/// The stresses at the root of a cantilever of 2 m with 120 N at its tip.
Values stresses(const std::string& section) {
  return Shown(kHeader + "\n[material.steel]\nyoung_modulus = 2e11\ndensity = 8000.0\n[section.bar]\n" + section +
               beam("bar", "length = 2.0\nelements = 4") + support("\"bar:first\"", "[\"u\", \"theta\"]") +
               force("bar:last", "-120.0") + probe("root", "bar:first", R"(["bending_stress", "von_mises"])"))
      .at_static_rest();
}

TEST(ElementForces, StressesOfTheOuterFibre) {
  const double pi = std::numbers::pi, m = -240.0;
  const double tube = m * 0.06 / (pi / 4.0 * (std::pow(0.06, 4) - std::pow(0.04, 4)));
  const double rectangle = m * 6.0 / (0.03 * 0.05 * 0.05);
  const auto check = [](const std::string& section, double stress) {
    expect_all(stresses(section), {{"root.bending_stress", stress}, {"root.von_mises", -stress}}, kStatic);
  };
  check("shape = \"tube\"\nouter_radius = 0.06\ninner_radius = 0.04\n", tube);
  check("shape = \"circle\"\nradius = 0.05\n", m * 4.0 / (pi * std::pow(0.05, 3)));
  check("shape = \"rectangle\"\nwidth = 0.03\nheight = 0.05\n", rectangle);
  check("shape = \"general\"\narea = 1e-3\nsecond_moment = 2e-6\nouter_fibre = 0.02\n", m * 0.02 / 2e-6);
}

TEST(ElementForces, SpringsToGroundBetweenNodesAndAgainstASupport) {
  const auto spring = [](const std::string& text) { return "\n[[element]]\ntype = \"spring\"\n" + text + "\n"; };
  Shown shown(kHeader + mass("rotor", "3.0\nrotary_inertia = 1.0") + mass("casing", "5.0") + mass("wall", "1.0") +
              spring("name = \"bearing\"\nnode = \"rotor\"\nstiffness = 100.0\ndamping = 7.0") +
              spring("name = \"link\"\nnodes = [\"rotor\", \"casing\"]\nstiffness = 20.0\ndamping = 3.0") +
              spring("name = \"anchor\"\nnodes = [\"casing\", \"wall\"]\nstiffness = 11.0") +
              spring("name = \"turn\"\nnode = \"rotor\"\ndof = \"theta\"\nstiffness = 13.0") +
              support("\"wall\"", "[\"u\"]") + "\n[damping]\nstiffness_proportional = 0.5\n" +
              probe("all", "rotor", R"(["spring_force", "spring_moment"])") +
              probe("bearing", "rotor", R"(["spring_force"])", "element = \"bearing\"") +
              probe("near", "rotor", R"(["spring_force"])", "element = \"link\"") +
              probe("far", "casing", R"(["spring_force"])", "element = \"link\"") +
              probe("wall", "wall", R"(["spring_force", "reaction"])"));
  time::State state;
  state.x = Vector{{0.1, 0.3, -0.4}};  // u and theta of the rotor, u of the casing
  state.v = Vector{{2.0, 1.0, 5.0}};
  state.a = Vector::Zero(3);
  const double bearing = -100.0 * 0.1 - (7.0 + 0.5 * 100.0) * 2.0;
  const double link = -20.0 * 0.5 - (3.0 + 0.5 * 20.0) * (2.0 - 5.0);
  const double on_wall = 11.0 * -0.4 + 0.5 * 11.0 * 5.0;
  expect_all(shown.of(state),
             {{"all.spring_force", bearing + link},
              {"all.spring_moment", -13.0 * 0.3 - 0.5 * 13.0 * 1.0},
              {"bearing.spring_force", bearing},
              {"near.spring_force", link},
              {"far.spring_force", -link},
              {"wall.spring_force", on_wall},
              {"wall.reaction", -on_wall}},
             1e-14);
}

TEST(ElementForces, BeamsThatShareANode) {
  // The stub transmits 40 N from its tip to the shaft's end; another 60 N act on the shaft there.
  expect_all(
      Shown(kHeader + kSteelBar + beam("shaft", "length = 1.0\nelements = 2") +
            beam("stub", "length = 0.5\nelements = 2\nstart_node = \"shaft:last\"") +
            support("\"shaft:first\"", "[\"u\", \"theta\"]") + force("shaft:last", "60.0") +
            force("stub:last", "40.0") + probe("shaft", "shaft:last", R"(["V", "M"])") +
            probe("stub", "stub:first", R"(["V", "M"])") +
            probe("named", "shaft:last", R"(["V", "M"])", "element = \"stub\""))
          .at_static_rest(),
      {{"shaft.V", 100.0}, {"shaft.M", 20.0}, {"stub.V", 40.0}, {"stub.M", 20.0}, {"named.V", 40.0}, {"named.M", 20.0}},
      kStatic);
}

/// Forces of contacts read the motion of their own nodes alone, others that of all nodes; the value does not
/// depend on which.
TEST(ElementForces, OfContactsReadTheirOwnNodesAlone) {
  SceneRun run(TurningPipe{"string", "lateral", "35.0", 10, "0.01", "0.01", "3.0"}.scene(
      "[integrator]\ntype = \"rodas4\"\nend_time = 0.1\n"));
  const model::NodeId node = run.model().nodes.select("string:4").nodes.front();
  const Index y = run.dof("string:4", DofKind::uy), z = run.dof("string:4", DofKind::uz);
  const Index n = run.dynamics().size();
  record::ElementForces own(run.dynamics()), all(run.dynamics());
  own.add(model::Quantity::contact_force, node, "");
  EXPECT_EQ(own.dofs(), (std::vector<Index>{std::min(y, z), std::max(y, z)}));
  all.add(model::Quantity::contact_force, node, "");
  all.add(model::quantity_of("M"), node, "");
  EXPECT_EQ(all.dofs().size(), static_cast<std::size_t>(n));

  Vector x = Vector::Zero(n), v = Vector::Zero(n), both(2), single(1);
  x[y] = 0.008, x[z] = -0.009, v[y] = 0.3, v[z] = 0.1;
  own.evaluate(0.0, x, v, {single.data(), 1});
  x.array() += 1e-3 * (Vector::LinSpaced(n, -1.0, 1.0).array());
  x[y] = 0.008, x[z] = -0.009;
  all.evaluate(0.0, x, v, {both.data(), 2});
  EXPECT_LT(single[0], -1.0);
  EXPECT_EQ(single[0], both[0]);
}

}  // namespace
}  // namespace butee::test::element_forces_test
