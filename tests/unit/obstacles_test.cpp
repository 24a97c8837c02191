#include <cmath>

#include <Eigen/Dense>
#include <butee/dynamics/tangent_solver.hpp>
#include <butee/scene/contact_tables.hpp>
#include <gtest/gtest.h>

#include "support/scene_run.hpp"
#include "support/small_scenes.hpp"

namespace butee::test::obstacles_test {
namespace {

/// Two masses on springs in both directions, with the given contacts.
std::string bodies(const std::string& contacts) {
  std::string toml = "schema = 1\n";
  if (contacts.find("radius") != std::string::npos) toml += "[rotation]\nspeed = 3.0\n";
  for (const char* name : {"a", "b"}) {
    toml += std::string("[[element]]\ntype = \"mass\"\nname = \"") + name + "\"\nmass = 2.0\n";
    for (const char* dof : {"uy", "uz"})
      toml += std::string("[[element]]\ntype = \"spring\"\nnode = \"") + name + "\"\ndof = \"" + dof +
              "\"\nstiffness = 50.0\n";
  }
  return toml + contacts + "[integrator]\ntype = \"dopri5\"\nend_time = 1.0\n";
}

const std::string kRing = "[[contact]]\ntype = \"ring\"\nbetween = [\"a\", \"b\"]\ngap = 0.1\nradius = 0.3\n";

/// Contacts of all kinds and laws, closed in the motion below.
const std::vector<std::string>& all_contacts() {
  static const std::vector<std::string> all = {
      kRing + "stiffness = 100.0\n",
      kRing + "stiffness = 100.0\nfriction = { coefficient = 0.3, slip_speed = 0.2 }\n",
      kRing + "stiffness = 100.0\nfriction = { coefficient = 0.3, slip_speed = 0.9, smoothing = \"tanh\" }\n",
      kRing + "stiffness = 100.0\nfriction = { coefficient = 0.3, slip_speed = 5.0, smoothing = \"clip\" }\n",
      kRing +
          "stiffness = 100.0\ndamping = { type = \"kelvin_voigt\", coefficient = 7.0 }\n"
          "friction = { coefficient = 0.3, slip_speed = 0.2 }\n",
      kRing +
          "law = \"hertz\"\nstiffness = 300.0\ndamping = { type = \"hunt_crossley\", factor = 0.4 }\n"
          "friction = { coefficient = 0.3, slip_speed = 0.2 }\n",
      kRing + "law = \"hertz\"\nstiffness = 300.0\ndamping = { type = \"jankowski\", restitution = 0.7, mass = 1.0 }\n",
      kRing + "law = \"arctan\"\nstiffness = 300.0\nregularization = 5.0\ncentre = [0.01, -0.02]\n",
      "[[contact]]\ntype = \"ring\"\nnodes = \"a\"\nside = \"outside\"\ngap = 0.9\nstiffness = 100.0\n",
      "[[contact]]\ntype = \"plane\"\nnodes = \"a\"\nnormal = [1, 2]\ngap = 0.1\nstiffness = 100.0\nradius = 0.3\n"
      "friction = { coefficient = 0.3, slip_speed = 0.2 }\n",
      "[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ndof = \"uz\"\ngap = 0.1\nstiffness = 100.0\n"
      "damping = { type = \"kelvin_voigt\", coefficient = 7.0 }\n",
      "[[contact]]\ntype = \"friction\"\nnodes = \"a\"\ndof = \"uz\"\nnormal_force = 5.0\n"
      "friction = { coefficient = 0.3, slip_speed = 0.2, surface_speed = 0.1 }\n"};
  return all;
}

Vector motion_x() {
  return (Vector(4) << 0.31, 0.22, -0.05, 0.04).finished();
}
Vector motion_v() {
  return (Vector(4) << 0.5, -0.3, 0.2, -0.6).finished();
}

Vector force(dynamics::Dynamics& dynamics, const Vector& x, const Vector& v) {
  Vector f = Vector::Zero(x.size());
  dynamics.add_obstacle_force(0.0, x, v, f);
  return f;
}

/// -dF/dx and -dF/dv from the tangents, or by central differences.
struct Jacobians {
  Eigen::MatrixXd by_x, by_v;
};

Jacobians from_tangents(dynamics::Dynamics& dynamics) {
  Jacobians sum{Eigen::MatrixXd::Zero(4, 4), Eigen::MatrixXd::Zero(4, 4)};
  for (const auto& tangent : dynamics.obstacles()->tangents(0.0, motion_x(), motion_v())) {
    const auto add = [&](const dynamics::Obstacles::Block& block, Eigen::MatrixXd& to) {
      dynamics.obstacles()->visit(tangent.contact, block, [&](Index i, Index j, double value) { to(i, j) += value; });
    };
    add(tangent.stiffness, sum.by_x);
    add(tangent.damping, sum.by_v);
  }
  return sum;
}

TEST(Obstacles, HaveTheTangentsThatDifferencesGive) {
  for (const std::string& contacts : all_contacts()) {
    SceneRun run(bodies(contacts));
    dynamics::Dynamics& dynamics = run.dynamics();
    ASSERT_NE(dynamics.obstacles(), nullptr);
    dynamics.obstacles()->follow_live();
    const Jacobians exact = from_tangents(dynamics);
    const double step = 1e-6;
    for (Index j = 0; j < 4; ++j) {
      const Vector shift = step * Vector::Unit(4, j);
      const Vector by_x =
          (force(dynamics, motion_x() - shift, motion_v()) - force(dynamics, motion_x() + shift, motion_v())) /
          (2 * step);
      const Vector by_v =
          (force(dynamics, motion_x(), motion_v() - shift) - force(dynamics, motion_x(), motion_v() + shift)) /
          (2 * step);
      EXPECT_LT((by_x - exact.by_x.col(j)).norm(), 1e-6 * (1.0 + exact.by_x.norm())) << contacts << j;
      EXPECT_LT((by_v - exact.by_v.col(j)).norm(), 1e-6 * (1.0 + exact.by_v.norm())) << contacts << j;
    }
    EXPECT_GT(exact.by_x.norm() + exact.by_v.norm(), 1e-3) << "exerts nothing: " << contacts;
  }
}

/// Friction at a radius twists a node with rx: the tangents contain the torque, and the contribution of rx to
/// the slip.
TEST(Obstacles, TwistANodeThatTurns) {
  const std::string body =
      "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"a\"\nmass = 2.0\ndiametral_inertia = 0.1\npolar_inertia = "
      "0.2\n[[support]]\nnodes = \"a\"\nfix = [\"ry\", \"rz\"]\n";
  std::string springs;
  for (const char* dof : {"uy", "uz", "rx"})
    springs += "[[element]]\ntype = \"spring\"\nnode = \"a\"\ndof = \"" + std::string(dof) + "\"\nstiffness = 50.0\n";
  const std::string ring = "[[contact]]\ntype = \"ring\"\nnodes = \"a\"\ngap = 0.1\nradius = 0.3\nstiffness = 100.0\n";
  const Vector x = (Vector(3) << 0.31, 0.22, -0.4).finished(), v = (Vector(3) << 0.5, -0.3, 1.7).finished();
  for (const std::string& contact :
       {ring + "friction = { coefficient = 0.3, slip_speed = 0.9 }\n",
        ring + "dofs = [\"uz\", \"uy\"]\nfriction = { coefficient = 0.3, slip_speed = 0.9 }\n",
        ring +
            "damping = { type = \"kelvin_voigt\", coefficient = 7.0 }\nfriction = { coefficient = 0.3, stick_stiffness "
            "= 20.0, stick_damping = 2.0 }\n",
        std::string("[[contact]]\ntype = \"friction\"\nnodes = \"a\"\ndof = \"uz\"\nnormal_force = 5.0\nradius = 0.3\n"
                    "friction = { coefficient = 0.3, slip_speed = 0.9 }\n")}) {
    SceneRun run(body + springs + contact + "[integrator]\ntype = \"dopri5\"\nend_time = 1.0\n");
    dynamics::Obstacles& obstacles = *run.dynamics().obstacles();
    ASSERT_EQ(run.system().size(), 3);
    ASSERT_EQ(run.dof("a", DofKind::rx), 2);
    dynamics::ContactPhase phase = obstacles.phase_at(0, 0.0, x, v);
    Vector phases(dynamics::Obstacles::kStateSize);
    if (contact.find("stick_stiffness") != std::string::npos) {
      phase.slip = dynamics::ContactPhase::Slip::stick;
      phase.anchor -= 0.02;
    }
    obstacles.follow(phases.setZero());
    obstacles.set_phase(0, phase);
    const auto force = [&](const Vector& at, const Vector& speed) {
      Vector f = Vector::Zero(3);
      run.dynamics().add_obstacle_force(0.0, at, speed, f);
      return f;
    };
    const dynamics::ContactForces now = obstacles.forces(0, 0.0, x, v);
    EXPECT_GT(std::abs(now.friction), 0.1);
    const double sense = contact.find("dofs") != std::string::npos ? -1.0 : 1.0;
    EXPECT_NEAR(force(x, v)[2], -0.3 * sense * now.friction, 1e-14);
    Eigen::Matrix3d by_x = Eigen::Matrix3d::Zero(), by_v = by_x;
    for (const auto& tangent : obstacles.tangents(0.0, x, v)) {
      obstacles.visit(0, tangent.stiffness, [&](Index i, Index j, double value) { by_x(i, j) += value; });
      obstacles.visit(0, tangent.damping, [&](Index i, Index j, double value) { by_v(i, j) += value; });
    }
    const double step = 1e-6;
    for (Index j = 0; j < 3; ++j) {
      const Vector shift = step * Vector::Unit(3, j);
      EXPECT_LT(((force(x - shift, v) - force(x + shift, v)) / (2 * step) - by_x.col(j)).norm(), 1e-7) << contact << j;
      EXPECT_LT(((force(x, v - shift) - force(x, v + shift)) / (2 * step) - by_v.col(j)).norm(), 1e-7) << contact << j;
    }
    EXPECT_GT(std::abs(by_v(2, 2)), 1e-3) << contact;
  }
}

/// A brake on a body that only turns.
TEST(Obstacles, TwistABodyThatIsHeldAcross) {
  SceneRun run(
      "schema = 1\n[[element]]\ntype = \"disc\"\nname = \"a\"\nmass = 2.0\ndiametral_inertia = 0.1\npolar_inertia = "
      "0.2\n"
      "[[element]]\ntype = \"spring\"\nnode = \"a\"\ndof = \"rx\"\nstiffness = 50.0\n[[support]]\nnodes = \"a\"\nfix = "
      "[\"uy\", \"uz\", \"ry\", \"rz\"]\n[[contact]]\ntype = \"friction\"\nnodes = "
      "\"a\"\ndof = "
      "\"uy\"\nnormal_force = 10.0\nradius = 0.3\nfriction = { coefficient = 0.5, slip_speed = 1e-6 "
      "}\n[integrator]\ntype = "
      "\"dopri5\"\nend_time = 1.0\n");
  ASSERT_EQ(run.system().size(), 1);
  dynamics::Obstacles* const obstacles = run.dynamics().obstacles();
  ASSERT_NE(obstacles, nullptr);
  obstacles->follow_live();
  Vector force = Vector::Zero(1);
  obstacles->add_force(0.0, Vector::Zero(1), Vector::Constant(1, 2.0), force);
  EXPECT_NEAR(force[0], -0.3 * 5.0, 1e-9);
}

/// Two bodies of which one turns get opposite torques about the point where they touch, in either order and inside as
/// well as outside of each other.
TEST(Obstacles, TwistBothBodiesOfAPair) {
  std::string bodies = "schema = 1\n";
  for (const char* name : {"a", "b"})
    bodies +=
        "[[element]]\ntype = \"disc\"\nname = \"" + std::string(name) +
        "\"\nmass = 2.0\ndiametral_inertia = 0.1\npolar_inertia = 0.2\n[[element]]\ntype = \"spring\"\nnode = \"" +
        name + "\"\ndof = \"rx\"\nstiffness = 50.0\n";
  for (const bool is_first : {true, false})
    for (const bool is_inside : {true, false}) {
      const double gap = is_inside ? 0.1 : 0.7;
      SceneRun run(bodies + "[rotation]\nspeed = 5.0\nparts = [\"" + (is_first ? "a" : "b") +
                   "\"]\n[[contact]]\ntype = \"ring\"\nbetween = [\"a\", \"b\"]\ngap = " + std::to_string(gap) +
                   (is_inside ? "" : "\nside = \"outside\"") +
                   "\nradius = 0.3\nstiffness = 1e9\nfriction = { coefficient = 0.3, slip_speed = 0.9 }\n"
                   "[integrator]\ntype = \"dopri5\"\nend_time = 1.0\n");
      dynamics::Obstacles& obstacles = *run.dynamics().obstacles();
      obstacles.follow_live();
      Vector x = Vector::Zero(run.system().size()), v = x;
      const double distance = gap * (is_inside ? 1.0 + 1e-9 : 1.0 - 1e-9), angle = 0.7;
      x[run.dof("a", DofKind::uy)] = distance * std::cos(angle);
      x[run.dof("a", DofKind::uz)] = distance * std::sin(angle);
      v[run.dof("a", DofKind::rx)] = 1.7;
      v[run.dof("b", DofKind::rx)] = -0.4;
      v[run.dof("b", DofKind::uz)] = 0.3;
      const dynamics::ContactForces now = obstacles.forces(0, 0.0, x, v);
      Vector force = Vector::Zero(x.size());
      obstacles.scatter(0, now.along_all(), force);
      const auto of = [&](const char* node, DofKind kind) { return force[run.dof(node, kind)]; };
      // The point of contact, seen from b's centre, and the velocities of both bodies there.
      const double inner = 0.3,
                   from_b = is_first ? (is_inside ? distance + inner : distance - inner) : (is_inside ? -inner : inner);
      const Eigen::Vector2d n(std::cos(angle), std::sin(angle)), t(-n[1], n[0]);
      const double spin_a = 1.7 + (is_first ? 5.0 : 0.0), spin_b = -0.4 + (is_first ? 0.0 : 5.0);
      const double slip = (from_b - distance) * spin_a - (0.3 * t[1] + from_b * spin_b), sense = is_inside ? 1.0 : -1.0;
      EXPECT_NEAR(now.slip_speed, sense * slip, 1e-8) << is_first << is_inside;
      EXPECT_GT(std::abs(now.friction), 0.01);
      const double of_a = -sense * now.friction;  // along t
      EXPECT_NEAR(of("a", DofKind::rx), (from_b - distance) * of_a, 1e-8) << is_first << is_inside;
      EXPECT_NEAR(of("b", DofKind::rx), -from_b * of_a, 1e-8) << is_first << is_inside;
      // About b's centre the moments of all forces cancel.
      EXPECT_NEAR(of("a", DofKind::rx) + of("b", DofKind::rx) + distance * of_a, 0.0, 1e-8);
    }
}

TEST(TangentSolver, SolvesAsAFullFactorizationDoes) {
  // With many contacts the whole matrix is factorized.
  std::vector<std::string> scenes = all_contacts();
  for (const std::string& contacts : all_contacts()) {
    scenes.emplace_back();
    for (int i = 0; i < 40; ++i) scenes.back() += contacts;
  }
  for (const std::string& contacts : scenes) {
    SceneRun run(bodies(contacts));
    dynamics::Dynamics& dynamics = run.dynamics();
    dynamics.obstacles()->follow_live();
    const Jacobians sum = from_tangents(dynamics);
    const double velocity_factor = 0.1, displacement_factor = 0.02;
    const Eigen::MatrixXd full = Eigen::MatrixXd(run.system().mass) +
                                 displacement_factor * Eigen::MatrixXd(run.system().stiffness) +
                                 displacement_factor * sum.by_x + velocity_factor * sum.by_v;
    dynamics::TangentSolver solver(dynamics.effective(), dynamics.obstacles());
    ASSERT_TRUE(solver.set(velocity_factor, displacement_factor, Vector(),
                           dynamics.obstacles()->tangents(0.0, motion_x(), motion_v())));
    Vector b = (Vector(4) << 1.0, -2.0, 0.5, 3.0).finished();
    const Vector wanted = full.partialPivLu().solve(b);
    ASSERT_TRUE(solver.solve(b));
    EXPECT_LT((b - wanted).norm(), 1e-13 * wanted.norm()) << contacts;
    Vector force = Vector::Ones(4), none;
    solver.add_stiffness(dynamics.stops(), wanted, none, force);
    EXPECT_LT((force - Vector::Ones(4) - sum.by_x * wanted).norm(), 1e-12 * force.norm()) << contacts;
  }
}

/// Two masses with stops to ground, of 100, 200 and 300 N/m.
TEST(TangentSolver, MultipliesByTheStiffnessOfStops) {
  SceneRun run(masses_in_stops("[[contact]]\ntype = \"stop\"\nnodes = \"a\"\ngap = 0.1\nstiffness = 5.0\n"));
  dynamics::Dynamics& dynamics = run.dynamics();
  ASSERT_EQ(dynamics.stop_count(), 3);
  dynamics::TangentSolver solver(dynamics.effective(), nullptr);
  ASSERT_TRUE(solver.set(0.1, 0.02, Vector::LinSpaced(3, 100.0, 300.0), {}));
  Vector y(2), work(3), force = Vector::Zero(2);
  y << 0.5, -2.0;
  solver.add_stiffness(dynamics.stops(), y, work, force);
  Vector wanted = Vector::Zero(2);
  for (Index i = 0; i < 3; ++i)
    wanted[dynamics.stops().dof_a(i)] += 100.0 * static_cast<double>(i + 1) * y[dynamics.stops().dof_a(i)];
  EXPECT_LT((force - wanted).norm(), 1e-12 * wanted.norm());
}

/// The closed forms C1, C2 and C4, which impact_damping_test checks by integration.
TEST(ContactTables, InvertTheRestitution) {
  EXPECT_NEAR(scene::kelvin_voigt_ratio(0.4, true), 0.2799979933, 1e-9);
  EXPECT_NEAR(scene::kelvin_voigt_ratio(0.7440793977, false), 0.1, 1e-9);
  // Beyond critical damping, by the roots of the characteristic equation in 30 digits.
  EXPECT_NEAR(scene::kelvin_voigt_ratio(0.0755883093649560692, false), 1.5, 1e-12);
  EXPECT_NEAR(scene::kelvin_voigt_ratio(0.00928452214732631707, false), 5.0, 1e-12);
  EXPECT_NEAR(scene::kelvin_voigt_ratio(0.135335283236612692, false), 1.0, 1e-9);
  EXPECT_NEAR(scene::hunt_crossley_product(0.5), 1.4327505333, 1e-9);
  EXPECT_NEAR(scene::hunt_crossley_product(0.95), 0.0789266053, 1e-9);
  EXPECT_NEAR(scene::jankowski_ratio(0.65), 0.3728356653, 1e-9);
  EXPECT_NEAR(scene::jankowski_restitution(0.1753730097), 0.7989438, 1e-6);
  EXPECT_NEAR(scene::jankowski_restitution(0.0), 1.0, 1e-9);
}

}  // namespace
}  // namespace butee::test::obstacles_test
