#include <cmath>
#include <map>

#include <butee/record/probes.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::element_forces_test {
namespace {

/// A beam on three supports and a spring, with a mass, dashpots, a line load, nodal loads, stops to ground
/// and a stop between the beam's fixed end and a mass; `damping` and `integrator` are tables.
std::string scene(const std::string& integrator, const std::string& damping, bool has_dashpots) {
  const std::string foot = has_dashpots ? "40.0" : "0", link = has_dashpots ? "10.0" : "0";
  return R"(
schema = 1
[material.steel]
young_modulus = 2.0e11
density       = 8000.0
[section.tube]
shape        = "tube"
outer_radius = 0.03
inner_radius = 0.02
[[element]]
type = "beam"
name = "bar"
material = "steel"
section  = "tube"
coordinates = [0.0, 0.3, 0.7, 1.2, 1.5, 2.0, 2.2]
[[element]]
type = "mass"
name = "disc"
node = "bar:5"
mass = 4.0
rotary_inertia = 0.02
[[element]]
type = "mass"
name = "body"
mass = 2.0
[[element]]
type = "spring"
name = "foot"
node = "bar:2"
stiffness = 3.0e4
damping = )" +
         foot + R"(
[[element]]
type = "spring"
name = "link"
nodes = ["body", "bar:last"]
stiffness = 2.0e5
damping = )" +
         link + R"(
[[support]]
nodes = "bar:first"
fix = ["u", "theta"]
[[support]]
nodes = ["bar:4", "bar:last"]
fix = ["u"]
[[contact]]
type = "stop"
nodes = ["bar:2", "bar:3"]
gap = 1.0e-4
stiffness = 1.0e6
[[contact]]
type = "stop"
between = ["body", "bar:last"]
gap = 2.0e-4
stiffness = 2.0e6
[[load]]
type = "distributed"
beam = "bar"
value = 700.0
in_time = { type = "harmonic", amplitude = 1.0, angular_frequency = 90.0 }
[[load]]
type = "harmonic"
node = "bar:3"
amplitude = 900.0
angular_frequency = 130.0
[[load]]
type = "ramp"
node = "bar:1"
dof = "theta"
to = 60.0
end = 0.01
[[load]]
type = "harmonic"
node = "body"
amplitude = 400.0
angular_frequency = 250.0
phase = 1.0
)" + damping +
         "\n[integrator]\nend_time = 0.05\n" + integrator + R"(
[output]
interval = 3.7e-4
[[output.probe]]
label = "a"
node = "bar:first"
quantities = ["reaction", "reaction_moment", "V", "M"]
[[output.probe]]
label = "b"
node = "bar:4"
quantities = ["reaction"]
[[output.probe]]
label = "c"
node = "bar:last"
quantities = ["reaction"]
[[output.probe]]
label = "before"
node = "bar:3"
quantities = ["V", "M", "contact_force"]
[[output.probe]]
label = "after"
node = "bar:3"
element = "bar:3"
quantities = ["V", "M"]
[[output.probe]]
label = "left"
node = "bar:1"
quantities = ["V", "M"]
[[output.probe]]
label = "right"
node = "bar:1"
element = "bar:1"
quantities = ["V", "M"]
[[output.probe]]
label = "foot"
node = "bar:2"
quantities = ["spring_force"]
)";
}

const std::string kRayleigh = "[damping]\nmass_proportional = 4.0\nstiffness_proportional = 2.0e-5\n";
const std::string kModal = "[damping]\nmodal = 0.03\n";

/// Sums the forces of all elements of the structure, including supports, from their own matrices: M a + C v
/// and K x along rigid translation.
class WholeSum final : public model::MatrixSink {
 public:
  WholeSum(const model::System& system, const time::State& state) : system_(system), state_(state) {}

  void add(std::span<const model::NodalDof> dofs, const model::ElementMatrices& matrices) override {
    const auto n = std::ssize(dofs);
    Vector x = Vector::Zero(n), v = x, a = x, along = x;
    for (Index i = 0; i < n; ++i) {
      const model::NodalDof dof = dofs[static_cast<std::size_t>(i)];
      along[i] = dof.kind == DofKind::u ? 1.0 : 0.0;
      const Index place = system_.dofs.index(dof);
      if (place < 0) continue;
      x[i] = state_.x[place];
      v[i] = state_.v[place];
      a[i] = state_.a[place];
    }
    const model::Damping& damping = system_.damping;
    const Eigen::MatrixXd c = matrices.damping + damping.mass_proportional * matrices.mass +
                              damping.stiffness_proportional * matrices.stiffness;
    sum += along.dot(matrices.mass * a + c * v + matrices.stiffness * x);
  }

  double sum = 0.0;

 private:
  const model::System& system_;
  const time::State& state_;
};

/// Checks the force balances at the end of every step, and the jumps of section forces also within steps.
class Balances final : public time::Observer {
 public:
  Balances(SceneRun& run, const model::OutputRequest& output)
      : run_(run), probes_(output.probes, run.dynamics()), values_(probes_.columns().size()) {}

  void step(const time::AcceptedStep& step) override {
    probes_.evaluate(step, step.to.t, values_);
    if (!run_.system().damping.is_modal()) look_at_the_whole(step.to);
    look_at_jumps(step.to.t);
    const double within = step.from.t + 0.37 * (step.to.t - step.from.t);
    probes_.evaluate(step, within, values_);
    look_at_jumps(within);
    ++steps;
  }

  double worst_whole = 0.0, worst_jump = 0.0, largest = 0.0;
  int steps = 0;

 private:
  double at(const std::string& column) const {
    const auto& all = probes_.columns();
    return values_[static_cast<std::size_t>(std::find(all.begin(), all.end(), column) - all.begin())];
  }
  void look_at_the_whole(const time::State& state) {
    WholeSum whole(run_.system(), state);
    for (const auto& element : run_.model().elements) element->assemble(whole);
    const double t = state.t;
    const double loads =
        700.0 * 2.2 * std::cos(90.0 * t) + 900.0 * std::cos(130.0 * t) + 400.0 * std::cos(250.0 * t + 1.0);
    Vector contact = Vector::Zero(run_.dynamics().size());
    run_.dynamics().add_contact_force(state.x, contact);
    // The stop between the body and the fixed end is an internal force; `contact` contains only its part on
    // the body.
    const double to_ground = contact[run_.dof("bar:2")] + contact[run_.dof("bar:3")];
    const double reactions = at("a.reaction") + at("b.reaction") + at("c.reaction");
    largest = std::max({largest, std::abs(reactions), std::abs(loads)});
    worst_whole = std::max(worst_whole, std::abs(reactions + loads + to_ground - whole.sum));
  }
  void look_at_jumps(double t) {
    const double v = at("before.V") - at("after.V") - 900.0 * std::cos(130.0 * t) - at("before.contact_force");
    const double m = at("left.M") - at("right.M") - 60.0 * std::min(t / 0.01, 1.0);
    // At the start of the first element only the support acts.
    const double root = at("a.V") + at("a.reaction"), root_m = at("a.M") + at("a.reaction_moment");
    largest = std::max(largest, std::abs(at("before.V")));
    for (const double miss : {v, m, root, root_m, at("before.M") - at("after.M"), at("left.V") - at("right.V")})
      worst_jump = std::max(worst_jump, std::abs(miss));
  }

  SceneRun& run_;
  record::Probes probes_;
  std::vector<double> values_;
};

struct Method {
  std::string name, table;
  double whole;  ///< allowed residual of the equation of motion, as a fraction of the largest force
};

TEST(ElementForces, ReactionsAndLoadsAreInertiaAndDampingWithEveryMethod) {
  constexpr double kRounding = 1e-9;
  const std::vector<Method> methods = {
      {"exact", "type = \"exact\"\ntime_step = 1e-3", kRounding},
      {"rk4", "type = \"rk4\"\ntime_step = 2e-5", kRounding},
      {"exponential", "type = \"exponential\"\ntolerance = 1e-5", 1e-6},
      {"rodas4", "type = \"rodas4\"\ntolerance = 1e-5", kRounding},
      // Newton's iteration stops at 1e-10 of the forces.
      {"newmark",
       "type = \"newmark\"\ntime_step = 1e-4\nresidual_tolerance = 1e-10\nincrement_tolerance = 1e-10\n"
       "max_iterations = 30",
       1e-8}};
  for (const Method& method : methods)
    for (const std::string& damping : {kRayleigh, kModal}) {
      // exponential works with uncoupled modes, which dashpots would couple.
      const bool has_dashpots = method.name != "exponential";
      const std::string text = scene(method.table, damping, has_dashpots);
      SceneRun run(text);
      const auto session = read_scene(text);
      Balances balances(run, session.output);
      run.simulation().add(balances);
      ASSERT_TRUE(run.run().completed) << method.name << ": " << run.simulation().report().message;
      EXPECT_GT(balances.steps, 5) << method.name;
      EXPECT_GT(balances.largest, 500.0) << method.name;
      EXPECT_LT(balances.worst_whole, method.whole * balances.largest) << method.name;
      if (damping == kRayleigh) {
        EXPECT_LT(balances.worst_jump, kRounding * balances.largest) << method.name;
      }
    }
}

}  // namespace
}  // namespace butee::test::element_forces_test
