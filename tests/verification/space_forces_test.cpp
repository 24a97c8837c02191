#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include <Eigen/Dense>
#include <butee/core/error.hpp>
#include <butee/model/element_choice.hpp>
#include <butee/record/element_forces.hpp>
#include <butee/record/probes.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"

namespace butee::test::space_forces_test {
namespace {

using std::numbers::pi;

/// Statics of cubic elements are exact; only the rounding of the solution remains.
constexpr double kStatics = 1e-9;

constexpr const char* kHead = R"(
schema = 1
[material.steel]
young_modulus = 2.1e11
density       = 7850.0
poisson_ratio = 0.3
[section.pipe]
shape        = "tube"
outer_radius = 0.03
inner_radius = 0.02
[integrator]
type = "newmark"
time_step = 1e-4
end_time = 1e-3
)";

std::string load(const std::string& node, const std::string& dof, double value) {
  return "[[load]]\ntype = \"constant\"\nnode = \"" + node + "\"\ndof = \"" + dof +
         "\"\nvalue = " + std::to_string(value) + "\n";
}

/// Element forces in the static position of a scene, by names of quantities.
class Static {
 public:
  explicit Static(const std::string& toml) : run_(toml), x_(run_.system().size()) {
    run_.dynamics().external_force(0.0, x_);
    x_ = Eigen::MatrixXd(run_.system().stiffness).partialPivLu().solve(x_).eval();
  }
  double operator()(const std::string& node, const std::string& quantity, const std::string& element = "") {
    const model::NodeId id = run_.model().nodes.select(node).nodes.front();
    EXPECT_EQ(why_not(model::quantity_of(quantity), run_.model(), run_.system().dofs, id, element), "");
    record::ElementForces forces(run_.dynamics());
    forces.add(model::quantity_of(quantity), id, element);
    double value = 0.0;
    forces.evaluate(0.0, x_, Vector::Zero(x_.size()), {&value, 1});
    return value;
  }

 private:
  SceneRun run_;
  Vector x_;
};

/// A cantilever in any direction under three forces and a moment at its tip: N, V, T and M from statics in
/// its own axes, reactions in the axes of space.
TEST(Cantilever, HasTheSectionForcesOfStatics) {
  const Eigen::Vector3d x = Eigen::Vector3d(1.0, 2.0, -2.0) / 3.0, z = x.cross(Eigen::Vector3d(0, 1, 0)).normalized();
  const Eigen::Vector3d y = z.cross(x), force(300.0, -500.0, 700.0), moment(40.0, 50.0, -60.0);
  Static scene(kHead +
               std::string("[[element]]\ntype = \"beam\"\nname = \"arm\"\nmotion = \"spatial\"\nmaterial = "
                           "\"steel\"\nsection = \"pipe\"\nelements = 3\npoints = [[0, 0, 0], [1, 2, -2]]\n"
                           "[[support]]\nnodes = \"arm:first\"\nfix = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\", "
                           "\"rz\"]\n") +
               load("arm:last", "ux", force[0]) + load("arm:last", "uy", force[1]) + load("arm:last", "uz", force[2]) +
               load("arm:last", "rx", moment[0]) + load("arm:last", "ry", moment[1]) +
               load("arm:last", "rz", moment[2]));
  for (const int node : {0, 1, 3}) {
    // Force and moment exerted at the node by the part at larger x.
    const Eigen::Vector3d arm = (3.0 - node) * x, bending = moment + arm.cross(force);
    const std::string at = "arm:" + std::to_string(node);
    const double size = bending.norm();
    EXPECT_NEAR(scene(at, "N"), force.dot(x), kStatics * size) << at;
    EXPECT_NEAR(scene(at, "Vy"), force.dot(y), kStatics * size) << at;
    EXPECT_NEAR(scene(at, "Vz"), force.dot(z), kStatics * size) << at;
    EXPECT_NEAR(scene(at, "T"), bending.dot(x), kStatics * size) << at;
    EXPECT_NEAR(scene(at, "My"), bending.dot(y), kStatics * size) << at;
    EXPECT_NEAR(scene(at, "Mz"), bending.dot(z), kStatics * size) << at;
    const double r = 0.03, area = pi * (9e-4 - 4e-4), inertia = pi / 4 * (81e-8 - 16e-8);
    const double sigma = std::abs(force.dot(x)) / area + std::hypot(bending.dot(y), bending.dot(z)) * r / inertia;
    const double tau = bending.dot(x) * r / (2 * inertia);
    const double mises = std::sqrt(sigma * sigma + 3 * tau * tau);
    EXPECT_NEAR(scene(at, "von_mises"), mises, kStatics * mises) << at;
    EXPECT_NEAR(scene(at, "bending_stress"), bending.dot(z) * r / inertia, kStatics * mises) << at;
  }
  const Eigen::Vector3d held = -(moment + (3.0 * x).cross(force));
  const char* names[] = {"ux", "uy", "uz"};
  const char* turns[] = {"rx", "ry", "rz"};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(scene("arm:first", std::string("reaction_") + names[k]), -force[k], kStatics * held.norm());
    EXPECT_NEAR(scene("arm:first", std::string("reaction_") + turns[k]), held[k], kStatics * held.norm());
  }
}

/// Two spans of 2 m under their weight along z: reactions 3/8, 10/8 and 3/8 of q L, and -q L^2/8 over the
/// middle support.
TEST(TwoSpans, CarryTheirWeight) {
  Static scene(kHead + std::string("[[element]]\ntype = \"beam\"\nname = \"bar\"\nmotion = \"lateral\"\nmaterial = "
                                   "\"steel\"\nsection = \"pipe\"\nlength = 4.0\nelements = 8\n[[support]]\nnodes = "
                                   "[\"bar:first\", \"bar:middle\", \"bar:last\"]\nfix = [\"u\", \"w\"]\n[gravity]\n"
                                   "acceleration = [0.0, 0.0, -9.81]\n"));
  const double q = 7850.0 * pi * (9e-4 - 4e-4) * 9.81, span = 2.0;
  EXPECT_NEAR(scene("bar:first", "reaction_uz"), 3.0 / 8 * q * span, kStatics * q);
  EXPECT_NEAR(scene("bar:middle", "reaction_uz"), 10.0 / 8 * q * span, kStatics * q);
  EXPECT_NEAR(scene("bar:last", "reaction_uz"), 3.0 / 8 * q * span, kStatics * q);
  EXPECT_NEAR(scene("bar:first", "reaction_uy"), 0.0, kStatics * q);
  // At the end of the first span the part at larger x pulls up with 5/8 q L; My = -E I w'' is positive over
  // the support.
  EXPECT_NEAR(scene("bar:4", "Vz", "bar:3"), 5.0 / 8 * q * span, kStatics * q);
  EXPECT_NEAR(scene("bar:4", "Vz", "bar:4"), -5.0 / 8 * q * span, kStatics * q);
  EXPECT_NEAR(scene("bar:4", "My"), q * span * span / 8, kStatics * q);
  EXPECT_NEAR(scene("bar:2", "My"), -q * span * span / 16, kStatics * q);
  EXPECT_NEAR(scene("bar:2", "von_mises"), q * span * span / 16 * 0.03 / (pi / 4 * (81e-8 - 16e-8)), 1e-3);
}

/// code_aster's bar under its weight: reactions q L/2 for any tension.
TEST(TiedBar, HangsOnItsSupports) {
  for (const char* preload : {"0.0", "1000.0"}) {
    Static scene(std::string("schema = 1\n[material.steel]\nyoung_modulus = 2e11\ndensity = 7800.0\n[section.round]\n"
                             "shape = \"circle\"\nradius = 0.005\n[integrator]\ntype = \"newmark\"\ntime_step = "
                             "1e-4\nend_time = 1e-3\n[[element]]\ntype = \"beam\"\nname = \"bar\"\nmaterial = "
                             "\"steel\"\nsection = \"round\"\nlength = 2.0\nelements = 20\npreload = ") +
                 preload +
                 "\n[[support]]\nnodes = [\"bar:first\", \"bar:last\"]\nfix = [\"u\"]\n[gravity]\n"
                 "acceleration = [0.0, -9.81, 0.0]\n");
    EXPECT_NEAR(scene("bar:first", "reaction"), 6.0097096667, 1e-8);
    EXPECT_NEAR(scene("bar:last", "reaction"), 6.0097096667, 1e-8);
    if (preload[0] == '1') {
      EXPECT_EQ(scene("bar:first", "N"), 1000.0);
    }
  }
}

/// A rotating shaft with discs, bearings with cross terms, internal damping, weight and a moving base, in a
/// run-up. At every instant forces and rates of momentum balance, for the whole and for each disc with its
/// gyroscopic moment.
TEST(TurningShaft, BalancesAtEveryInstant) {
  const std::string scene = kHead + std::string(R"(
[[element]]
type = "beam"
name = "shaft"
motion = "lateral"
theory = "timoshenko"
material = "steel"
section = "pipe"
length = 1.2
elements = 6
[[element]]
type = "disc"
node = "shaft:2"
mass = 12.0
diametral_inertia = 0.1
polar_inertia = 0.19
[[element]]
type = "bearing"
name = "left"
node = "shaft:first"
stiffness = [[2e6, 3e5], [-1e5, 3e6]]
damping = [[100.0, 10.0], [-20.0, 150.0]]
[[support]]
nodes = "shaft:last"
fix = ["u", "w"]
[rotation]
speed = { type = "ramp", from = 100.0, to = 400.0, end = 0.1 }
[[load]]
type = "unbalance"
node = "shaft:2"
moment = 0.02
phase = 0.4
[gravity]
acceleration = [0.0, -9.81, 0.0]
[base]
acceleration = { direction = [0, 1, 1], type = "harmonic", amplitude = 3.0, angular_frequency = 80.0 }
[damping]
mass_proportional = 2.0
stiffness_proportional = 1e-5
rotating_stiffness_proportional = 2e-5
)");
  SceneRun run(scene, {"integrator.type=rodas4", "integrator.end_time=0.06", "integrator.tolerance=1e-5"});
  ASSERT_TRUE(run.run().completed);
  const auto& state = run.simulation().state();
  const auto& nodes = run.model().nodes;
  Vector a(state.x.size());
  run.dynamics().acceleration(state.t, state.x, state.v, a);
  const auto force = [&](const std::string& node, const std::string& quantity, const std::string& element = "") {
    record::ElementForces forces(run.dynamics());
    forces.add(model::quantity_of(quantity), nodes.select(node).nodes.front(), element);
    double value = 0.0;
    forces.evaluate(state.t, state.x, state.v, {&value, 1});
    return value;
  };
  const double omega = run.model().rotation->speed(state.t), rate = run.model().rotation->acceleration(state.t);
  const double base = 3.0 * std::cos(80.0 * state.t) / std::sqrt(2.0);
  // Momentum of all masses in space; that of the supported node is contained only in the elements' mass
  // matrices.
  for (const auto& [kind, quantity, gravity] :
       {std::tuple(DofKind::uy, "uy", -9.81), std::tuple(DofKind::uz, "uz", 0.0)}) {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(state.x.size());
    double momentum_rate = 0.0, mass = 12.0 + 7850.0 * pi * (9e-4 - 4e-4) * 1.2, momentum = 0.0;
    for (const auto& element : run.model().elements) {
      class Sum final : public model::MatrixSink {
       public:
        void add(std::span<const model::NodalDof> dofs, const model::ElementMatrices& matrices) override {
          for (std::size_t i = 0; i < dofs.size(); ++i)
            for (std::size_t j = 0; j < dofs.size(); ++j) {
              const Index dof = table->index(dofs[j]);
              if (dofs[i].kind != wanted || dof < 0) continue;
              of_a += matrices.mass(static_cast<Index>(i), static_cast<Index>(j)) * (*a)[dof];
              of_v += matrices.mass(static_cast<Index>(i), static_cast<Index>(j)) * (*v)[dof];
            }
        }
        const model::DofTable* table;
        const Vector *a, *v;
        DofKind wanted;
        double of_a = 0.0, of_v = 0.0;
      } sum;
      sum.table = &run.system().dofs;
      sum.a = &a;
      sum.v = &state.v;
      sum.wanted = kind;
      element->assemble(sum);
      momentum_rate += sum.of_a;
      momentum += sum.of_v;
    }
    double unbalance = 0.0;
    for (const model::Load& load : run.model().loads)
      if (load.acceleration.isZero(0.0) && load.pattern.front().dof.kind == kind)
        unbalance += load.in_time->value(state.t);
    const double reaction = force("shaft:last", std::string("reaction_") + quantity);
    const double bearing = force("shaft:first", std::string("spring_") + quantity, "left");
    // Mass-proportional damping is an external force proportional to the relative momentum.
    const double sum = reaction + bearing + unbalance + mass * (gravity - base) - 2.0 * momentum;
    EXPECT_NEAR(sum, momentum_rate, 1e-9 * (std::abs(reaction) + std::abs(bearing) + 12.0 * 9.81)) << quantity;
  }
  const auto at = [&](const Vector& of, DofKind kind) { return of[run.dof("shaft:2", kind)]; };
  const double jump_z = force("shaft:2", "Mz", "shaft:1") - force("shaft:2", "Mz", "shaft:2");
  const double jump_y = force("shaft:2", "My", "shaft:1") - force("shaft:2", "My", "shaft:2");
  const double damped_z = 2.0 * 0.1 * at(state.v, DofKind::rz), damped_y = 2.0 * 0.1 * at(state.v, DofKind::ry);
  const double gyro_z = -0.19 * (omega * at(state.v, DofKind::ry) + rate * at(state.x, DofKind::ry));
  const double gyro_y = 0.19 * (omega * at(state.v, DofKind::rz) + rate * at(state.x, DofKind::rz));
  EXPECT_GT(std::abs(gyro_z), 1e-3);
  EXPECT_NEAR(jump_z, -(0.1 * at(a, DofKind::rz) + damped_z + gyro_z), 1e-9 * std::abs(force("shaft:2", "Mz")));
  EXPECT_NEAR(jump_y, -(0.1 * at(a, DofKind::ry) + damped_y + gyro_y), 1e-9 * std::abs(force("shaft:2", "My")));
}

/// For moving supports, a reaction includes the stiffness and inertia of the parts fixed to them.
TEST(MovedSupport, PullsAtWhatItMoves) {
  SceneRun run(
      std::string("schema = 1\n[[element]]\ntype = \"mass\"\nname = \"m\"\nmass = 2.0\n[[element]]\ntype = "
                  "\"mass\"\nname = \"foot\"\nmass = 0.5\n[[element]]\ntype = \"spring\"\nnodes = [\"m\", "
                  "\"foot\"]\nstiffness = 800.0\ndamping = 3.0\n[[support]]\nnodes = \"foot\"\nfix = "
                  "[\"u\"]\n[[base]]\nnodes = \"foot\"\ndisplacement = { direction = [0, 1, 0], type = "
                  "\"harmonic\", amplitude = 0.1, angular_frequency = 7.0 }\n[integrator]\ntype = "
                  "\"exact\"\nend_time = 0.4\n"));
  ASSERT_TRUE(run.run().completed);
  const auto& state = run.simulation().state();
  record::ElementForces forces(run.dynamics());
  forces.add(model::Quantity::reaction, run.model().nodes.select("foot").nodes.front(), "");
  double reaction = 0.0;
  forces.evaluate(state.t, state.x, state.v, {&reaction, 1});
  const double d = 0.1 * std::cos(7.0 * 0.4), v = -0.7 * std::sin(7.0 * 0.4), a = -49.0 * d;
  const double expected = 800.0 * (d - state.x[0]) + 3.0 * (v - state.v[0]) + 0.5 * a;
  EXPECT_GT(std::abs(expected), 0.5);
  EXPECT_NEAR(reaction, expected, 1e-11 * std::abs(expected));
}

}  // namespace
}  // namespace butee::test::space_forces_test
