// The damped modes of coupled structures, and their motion under polynomial and harmonic forces, compared
// with the matrix exponential of the first-order system (Eigen's unsupported module).
#include <array>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include <Eigen/LU>
#include <butee/core/error.hpp>
#include <butee/core/text.hpp>
#include <butee/dynamics/damped_modes.hpp>
#include <gtest/gtest.h>

#include "integrators/exponential/fast_motion.hpp"
#include "support/scene_run.hpp"

namespace butee::test::damped_modes_test {
namespace {

using dynamics::DampedModes;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A rotating shaft with a dashpot, on bearings with cross terms, and two bodies without ground joined by a
/// dashpot.
const std::string kShaft = R"(
schema = 1
[material.steel]
young_modulus = 2e11
density = 7800.0
poisson_ratio = 0.3
[section.shaft]
shape = "tube"
outer_radius = 0.03
inner_radius = 0.0
[[element]]
type = "beam"
name = "s"
motion = "lateral"
theory = "timoshenko"
material = "steel"
section = "shaft"
length = 1.0
elements = 4
[[element]]
type = "disc"
node = "s:middle"
mass = 20.0
diametral_inertia = 0.2
polar_inertia = 0.4
[[element]]
type = "bearing"
node = "s:first"
stiffness = [[1e7, 2e5], [-3e5, 2e7]]
damping = [[500.0, 20.0], [10.0, 300.0]]
[[element]]
type = "bearing"
node = "s:last"
stiffness = [[1e7, 0.0], [0.0, 1e7]]
damping = [[50.0, 0.0], [0.0, 50.0]]
[rotation]
speed = 200.0
[integrator]
end_time = 1.0
)";

const std::string kBodies = R"(
schema = 1
[[element]]
type = "mass"
name = "a"
mass = 2.0
[[element]]
type = "mass"
name = "b"
mass = 5.0
[[element]]
type = "spring"
nodes = ["a", "b"]
stiffness = 40.0
damping = 3.0
[[element]]
type = "mass"
name = "critical"
mass = 1.0
[[element]]
type = "spring"
node = "critical"
stiffness = 9.0
damping = 6.0
[[element]]
type = "mass"
name = "over"
mass = 1.0
[[element]]
type = "spring"
node = "over"
stiffness = 4.0
damping = 50.0
[integrator]
end_time = 1.0
)";

/// A light part on a dashpot; its motion decays within a microsecond.
const std::string kLight = R"(
schema = 1
[[element]]
type = "mass"
name = "a"
mass = 2.0
[[element]]
type = "spring"
node = "a"
stiffness = 4e4
damping = 0.3
[[element]]
type = "mass"
name = "light"
mass = 5e-7
[[element]]
type = "spring"
nodes = ["a", "light"]
stiffness = 0.2
[[element]]
type = "mass"
name = "b"
mass = 1.5
[[element]]
type = "spring"
nodes = ["light", "b"]
stiffness = 3e3
damping = 20.0
[integrator]
end_time = 1.0
)";

/// A bearing with cross terms; the symmetric part of its stiffness has an eigenvalue of -500 N/m.
const std::string kIndefinite = R"(
schema = 1
[[element]]
type = "mass"
name = "journal"
mass = 2.0
[[element]]
type = "bearing"
node = "journal"
stiffness = [[1000.0, 4000.0], [-1000.0, 1000.0]]
damping = [[90.0, 5.0], [-5.0, 80.0]]
[integrator]
end_time = 1.0
)";

/// Scale of displacements, 1/s; it balances the matrix, so that its exponential loses few digits.
constexpr double kScale = 1e5;

/// The matrix of y' = A y + [0; M^-1 f] of the motion y = (kScale x, v).
MatrixXd first_order(SceneRun& run, MatrixXd& compliance) {
  const Index n = run.dynamics().size();
  MatrixXd stiffness(n, n), damping(n, n);
  VectorXd column(n);
  for (Index j = 0; j < n; ++j) {
    run.dynamics().elastic_force(VectorXd::Unit(n, j), column);
    stiffness.col(j) = column;
    run.dynamics().damping_force(VectorXd::Unit(n, j), column);
    damping.col(j) = column;
  }
  compliance = MatrixXd(run.system().mass).inverse();
  MatrixXd all = MatrixXd::Zero(2 * n, 2 * n);
  all.topRightCorner(n, n) = kScale * MatrixXd::Identity(n, n);
  all.bottomLeftCorner(n, n) = -compliance * stiffness / kScale;
  all.bottomRightCorner(n, n) = -compliance * damping;
  return all;
}

class DampedModesOf : public testing::TestWithParam<std::string> {};

TEST_P(DampedModesOf, GiveTheMotionOfTheMatrixExponential) {
  SceneRun run(GetParam());
  const Index n = run.dynamics().size();
  MatrixXd compliance;
  const MatrixXd matrix = first_order(run, compliance);
  const DampedModes modes(run.dynamics(), 1.0);
  const Index p = modes.count();
  VectorXd x = VectorXd::LinSpaced(n, -1.0, 2.0), v = VectorXd::LinSpaced(n, 3.0, 1.0), z(2 * p);
  modes.to_modal(x, v, z);
  const VectorXd back_x = modes.displacement().transpose() * z, back_v = modes.velocity().transpose() * z;
  EXPECT_LT((back_x - x).norm(), 1e-9 * x.norm());
  EXPECT_LT((back_v - v).norm(), 1e-9 * v.norm());

  // f on the first DOF: 3 - 2 s + 7 s^4 - s^6 over the step, and 5 cos(30 t + 0.4) from t = 0.2 on.
  const double coefficients[] = {3.0, -2.0, 0.0, 0.0, 7.0, 0.0, -1.0}, turn = 30.0, begin = 0.2;
  const VectorXd shape = modes.input().col(0);
  const integrators::HarmonicLoad load{turn, 5.0 * std::cos(0.4) * shape, -5.0 * std::sin(0.4) * shape};
  MatrixXd g(2 * p, 7);
  for (Index r = 0; r < 7; ++r) g.col(r) = coefficients[r] * shape;
  for (const double h : {1e-5, 1e-3, 0.02, 0.4})
    for (const double place : {0.3, 1.0}) {
      VectorXd out(2 * p);
      const std::vector<integrators::HarmonicLoad> loads = {load};
      integrators::PlaceResponse(modes, loads, place, h).move(begin, z.data(), g.data(), out);
      Index fast = 0;
      while (fast < p && modes.speed()[fast] * h < integrators::FastMotion::kLeast) ++fast;
      integrators::FastMotion motion(modes, loads);
      ASSERT_TRUE(motion.begin(begin, h, z.data(), g.data(), fast));
      VectorXd same = out;
      same.segment(fast, p - fast).setZero();
      same.tail(p - fast).setZero();
      motion.move(place, same);
      EXPECT_LT((same - out).norm(), 1e-11 * out.norm()) << h << " " << place << " " << p - fast;
      // The powers of s, and cosine and sine, as additional unknowns of one linear system.
      MatrixXd all = MatrixXd::Zero(2 * n + 9, 2 * n + 9);
      all.topLeftCorner(2 * n, 2 * n) = matrix;
      for (Index r = 0; r < 7; ++r) {
        all.block(n, 2 * n + r, n, 1) = coefficients[r] * compliance.col(0);
        if (r > 0) all(2 * n + r, 2 * n + r - 1) = static_cast<double>(r) / h;
      }
      all.block(n, 2 * n + 7, n, 1) = 5.0 * compliance.col(0);
      all(2 * n + 7, 2 * n + 8) = -turn;
      all(2 * n + 8, 2 * n + 7) = turn;
      VectorXd y = VectorXd::Zero(2 * n + 9);
      y << kScale * x, v, 1.0, VectorXd::Zero(6), std::cos(turn * begin + 0.4), std::sin(turn * begin + 0.4);
      const VectorXd wanted = (all * (place * h)).exp() * y;
      const VectorXd got_x = modes.displacement().transpose() * out, got_v = modes.velocity().transpose() * out;
      EXPECT_LT((got_x - wanted.head(n) / kScale).norm(), 2e-9 * got_x.norm()) << h << " " << place;
      EXPECT_LT((got_v - wanted.segment(n, n)).norm(), 2e-9 * wanted.segment(n, n).norm()) << h << " " << place;
    }
}

INSTANTIATE_TEST_SUITE_P(Structures, DampedModesOf, testing::Values(kShaft, kBodies, kLight, kIndefinite));

/// Dashpots between parts do not act on rigid motion. In coordinates of its own scale it conditions no basis, and a
/// block of all modes is not joined to it by rounding.
TEST(DampedModes, KeepRigidMotionApart) {
  std::string chain = "schema = 1\n";
  for (int i = 0; i < 4; ++i) {
    chain += "[[element]]\ntype = \"mass\"\nname = \"m" + std::to_string(i) +
             "\"\nmass = " + std::to_string(2.3 - 0.4 * i) + "\n";
    if (i > 0)
      chain += "[[element]]\ntype = \"spring\"\nnodes = [\"m" + std::to_string(i - 1) + "\", \"m" + std::to_string(i) +
               "\"]\nstiffness = " + std::to_string(1100.0 * i * i) + "\ndamping = " + std::to_string(60.0 - 17.0 * i) +
               "\n";
  }
  chain += "[initial]\nvelocity = [{ nodes = \"m0\", value = 1.0 }]\n[integrator]\nend_time = 1.0\n";
  SceneRun run(chain);
  EXPECT_LT(DampedModes(run.dynamics(), 1.0).condition(), 100.0);
  SceneRun by_modes(chain, {"integrator.type=exponential", "integrator.tolerance=1e-10"}),
      by_series(chain, {"integrator.type=exact"});
  for (SceneRun* one : {&by_modes, &by_series}) ASSERT_TRUE(one->run().completed);
  const time::State &got = by_modes.simulation().state(), &wanted = by_series.simulation().state();
  EXPECT_LT((got.x - wanted.x).norm(), 1e-10 * wanted.x.norm());
  EXPECT_LT((got.v - wanted.v).norm(), 1e-10 * wanted.v.norm());
  const Vector ones = Vector::Ones(run.dynamics().size());
  EXPECT_NEAR(ones.dot(run.dynamics().system().mass * got.v), 2.3, 1e-13);
}

/// A critically damped mass has one eigenvector; its eigenvalues, moved apart by kNudge, condition the basis.
TEST(DampedModes, RefuseTolerancesBelowTheRoundingOfCriticalDamping) {
  const std::string scene =
      "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = "
      "\"b\"\nmass = 1.0\n[[element]]\ntype = \"mass\"\nname = \"c\"\nmass = 1.0\n"
      "[[element]]\ntype = \"spring\"\nnode = \"a\"\nstiffness = 100.0\ndamping = 20.0\n"
      "[[element]]\ntype = \"spring\"\nnode = \"b\"\nstiffness = 300.0\ndamping = 2.0\n"
      "[[element]]\ntype = \"spring\"\nnodes = [\"b\", \"c\"]\nstiffness = 200.0\n"
      "[initial]\nvelocity = [{ nodes = \"a\", value = 1.0 }]\n[integrator]\nend_time = 1.0\n";
  SceneRun run(scene);
  const double condition = DampedModes(run.dynamics(), 1.0).condition();
  EXPECT_GT(condition, 0.5 / std::sqrt(DampedModes::kNudge));
  EXPECT_LT(condition, 4.0 / std::sqrt(DampedModes::kNudge));
  EXPECT_NO_THROW(SceneRun(scene, {"integrator.type=exponential", "integrator.tolerance=2e-8"}));
  try {
    SceneRun(scene, {"integrator.type=exponential", "integrator.tolerance=1e-10"});
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rounding exceeds the error bound"), std::string::npos) << error.what();
  }
  SceneRun chosen(scene, {"integrator.tolerance=1e-10"});
  EXPECT_NE(chosen.integrator().choice().find("exact"), std::string::npos) << chosen.integrator().choice();
}

/// Free bodies joined by a weak dashpot: their common motion stays apart from the decay of the relative one, c/mu (mu:
/// the reduced mass). In one block both lost up to seven digits.
TEST(DampedModes, FollowFreeBodiesJoinedByAWeakDashpot) {
  const double a = 1.0, b = 0.5, mu = a * b / (a + b), of_a = 10.0, of_b = 9.6,
               common = (a * of_a + b * of_b) / (a + b);
  for (const double dashpot : {2e-3, 0.02, 0.2, 0.3}) {
    const std::string scene =
        "schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = 1.0\n[[element]]\ntype = "
        "\"mass\"\nname = \"b\"\nmass = 0.5\n[[element]]\ntype = \"spring\"\nnodes = [\"a\", "
        "\"b\"]\nstiffness = 0.0\ndamping = " +
        to_text(dashpot) +
        "\n[initial]\nvelocity = [{ nodes = \"a\", dof = \"u\", value = 10.0 }, { nodes = \"b\", "
        "dof = \"u\", value = 9.6 }]\n[integrator]\ntype = \"exponential\"\ntolerance = "
        "1e-8\nend_time = 1.0\n";
    SceneRun run(scene);
    Sampler sampler(run.dof("a"), {0.0025, 0.1, 1.0});
    run.simulation().add(sampler);
    ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
    ASSERT_EQ(sampler.x.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const double t = std::array{0.0025, 0.1, 1.0}[i],
                   way = (of_a - of_b) * mu / dashpot * -std::expm1(-dashpot / mu * t);
      EXPECT_NEAR(sampler.x[i], common * t + b / (a + b) * way, 1e-9) << dashpot << " " << t;
    }
  }
}

/// Two free bodies whose rigid mode has omega^2 = 3e-28: rounding, which is no oscillation. The centre of mass moves
/// by X = F/(m W^2) (cos phi - cos(W t + phi) - W t sin phi); it was wrong by 0.04 to 3 mm.
TEST(DampedModes, DriveTheCentreOfMassOfBodiesWhoseRigidFrequencyIsRounding) {
  constexpr double kForce = 100.0, kTurn = 140.0, kPhase = 1.3, kEnd = 0.02;
  for (const double first : {1.0, 1.0123309709857433, 1.7}) {
    for (const double second : {0.5311249678147054, 0.6, 3.1}) {
      SceneRun run("schema = 1\n[[element]]\ntype = \"mass\"\nname = \"a\"\nmass = " + to_text(first) +
                   "\n[[element]]\ntype = \"mass\"\nname = \"b\"\nmass = " + to_text(second) +
                   "\n[[element]]\ntype = \"spring\"\nnodes = [\"a\", \"b\"]\nstiffness = 35913.98\ndamping = "
                   "0.0167\n[[load]]\nnode = \"a\"\ntype = \"harmonic\"\namplitude = 100.0\nangular_frequency = "
                   "140.0\nphase = 1.3\n[integrator]\ntype = \"exponential\"\ntolerance = 1e-6\nend_time = 0.02\n");
      ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
      const time::State& end = run.simulation().state();
      const double mass = first + second, centre = (first * end.x[run.dof("a")] + second * end.x[run.dof("b")]) / mass,
                   wanted = kForce / (mass * kTurn * kTurn) *
                            (std::cos(kPhase) - std::cos(kTurn * kEnd + kPhase) - kTurn * kEnd * std::sin(kPhase));
      EXPECT_NEAR(centre, wanted, 1e-7 * std::abs(wanted)) << first << ' ' << second;
    }
  }
}

/// A free rotor under a harmonic force at its end: its centre of mass moves as a free mass, whatever gyroscopic moments
/// do.
TEST(DampedModes, MoveTheCentreOfMassOfAFreeRotorAsAFreeMass) {
  const double mass = 3.0, disc = 2.0, amplitude = 5.0, omega = 40.0, end = 2.0;
  const std::string scene =
      "schema = 1\n[rotation]\nspeed = 800.0\n[material.s]\nyoung_modulus = 2e11\ndensity = 7800.0\n[section.c]\n"
      "shape = \"general\"\narea = " +
      to_text(mass / 7800.0 / 1.2) +
      "\nsecond_moment = 8e-9\nsecond_moment_y = 8e-9\n[[element]]\ntype = \"beam\"\nname = \"b\"\nmotion = "
      "\"lateral\"\nmaterial = \"s\"\nsection = \"c\"\nlength = 1.2\nelements = 4\n[[element]]\ntype = \"disc\"\n"
      "node = \"b:1\"\nmass = 2.0\ndiametral_inertia = 0.01\npolar_inertia = 0.02\n[[load]]\ntype = \"harmonic\"\n"
      "node = \"b:4\"\ndof = \"uy\"\namplitude = 5.0\nangular_frequency = 40.0\n[integrator]\ntype = "
      "\"exponential\"\ntolerance = 1e-5\nend_time = 2.0\n";
  SceneRun run(scene);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  const time::State& state = run.simulation().state();
  // The momentum of a unit velocity of all nodes along y, in the motion (x, v).
  VectorXd shift = VectorXd::Zero(run.dynamics().size());
  for (const char* node : {"b:0", "b:1", "b:2", "b:3", "b:4"}) shift[run.dof(node)] = 1.0;
  const VectorXd weights = run.dynamics().system().mass * shift;
  const double all = mass + disc;
  EXPECT_NEAR(weights.dot(shift), all, 1e-9);
  const double way = amplitude / (all * omega * omega) * (1.0 - std::cos(omega * end)),
               speed = amplitude / (all * omega) * std::sin(omega * end);
  EXPECT_NEAR(weights.dot(state.x) / all, way, 1e-7 * amplitude / (all * omega * omega));
  EXPECT_NEAR(weights.dot(state.v) / all, speed, 1e-7 * amplitude / (all * omega));
}

/// A free rotor that is struck at its end: rounding in K and in the modes neither holds its centre of mass back, which
/// would grow with t^3, nor joins its translation to its other motion.
TEST(DampedModes, CarryAStruckFreeRotorAtConstantSpeed) {
  const std::string scene =
      "schema = 1\n[rotation]\nspeed = 1000.0\n[material.s]\nyoung_modulus = 2.1e11\nshear_modulus = 8.1e10\ndensity = "
      "7800.0\n[section.c]\nshape = \"circle\"\nradius = 0.02\n[[element]]\ntype = \"beam\"\ntheory = "
      "\"timoshenko\"\nname = \"b\"\nmotion = \"lateral\"\nmaterial = \"s\"\nsection = \"c\"\nlength = "
      "1.0\nelements = 6\n[[element]]\ntype = \"disc\"\nnode = \"b:3\"\nmass = 8.0\ndiametral_inertia = "
      "0.03\npolar_inertia = 0.055\n[initial]\nvelocity = [{ nodes = \"b:0\", dof = \"uy\", value = 0.1 }]\n"
      "[integrator]\ntype = \"exponential\"\ntolerance = 1e-8\nend_time = 3.0\n";
  SceneRun run(scene);
  VectorXd along_y = VectorXd::Zero(run.dynamics().size());
  for (const char* node : {"b:0", "b:1", "b:2", "b:3", "b:4", "b:5", "b:6"}) along_y[run.dof(node)] = 1.0;
  const VectorXd weights = run.dynamics().system().mass * along_y / along_y.dot(run.dynamics().system().mass * along_y);
  const double speed = weights.dot(run.simulation().state().v);
  EXPECT_GT(speed, 0.001);
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  EXPECT_NEAR(weights.dot(run.simulation().state().x), 3.0 * speed, 3e-10 * speed);
  EXPECT_NEAR(weights.dot(run.simulation().state().v), speed, 3e-10 * speed);
  EXPECT_LT(run.simulation().report().rejected, 5);
}

/// A shaft that hangs in springs 1e-12 times as stiff as itself swings as a rigid body, its ends in phase: M times the
/// acceleration of its centre of mass is the sum of the springs' forces. Rounding of the eigenvalues beside the highest
/// one, 1e10 rad2/s2, was as large as the square of this frequency.
TEST(DampedModes, SwingAStiffShaftInSoftSprings) {
  const double stiffness = 1e-5, end = 600.0;
  const std::string bearing = "[[element]]\ntype = \"bearing\"\nstiffness = [[" + to_text(stiffness) +
                              ", 0.0], [0.0, " + to_text(4.0 * stiffness) + "]]\nnode = ";
  std::string scene =
      "schema = 1\n[rotation]\nspeed = 1000.0\n[material.s]\nyoung_modulus = 2.1e11\nshear_modulus = 8.1e10\ndensity = "
      "7800.0\n[section.c]\nshape = \"circle\"\nradius = 0.02\n[[element]]\ntype = \"beam\"\ntheory = "
      "\"timoshenko\"\nname = \"b\"\nmotion = \"lateral\"\nmaterial = \"s\"\nsection = \"c\"\nlength = "
      "1.0\nelements = 6\n[[element]]\ntype = \"disc\"\nnode = \"b:3\"\nmass = 8.0\ndiametral_inertia = "
      "0.03\npolar_inertia = 0.055\n" +
      bearing + "\"b:0\"\n" + bearing + "\"b:6\"\n[initial]\nvelocity = [";
  for (int node = 0; node <= 6; ++node)
    scene += "{ nodes = \"b:" + std::to_string(node) + "\", dof = \"uy\", value = 0.1 }, ";
  scene.resize(scene.size() - 2);
  scene += "]\n[integrator]\ntype = \"exponential\"\ntolerance = 1e-3\nend_time = " + to_text(end) + "\n";
  SceneRun run(scene);
  VectorXd along_y = VectorXd::Zero(run.dynamics().size());
  for (int node = 0; node <= 6; ++node) along_y[run.dof("b:" + std::to_string(node))] = 1.0;
  const double mass = along_y.dot(run.dynamics().system().mass * along_y), omega = std::sqrt(2.0 * stiffness / mass),
               speed = 0.1;
  ASSERT_TRUE(run.run().completed) << run.simulation().report().message;
  const double got = run.simulation().state().x[run.dof("b:3")], wanted = speed / omega * std::sin(omega * end);
  EXPECT_NEAR(got, wanted, 1e-3 * wanted);
}

/// Angles below and above the limit of the vectorised functions.
TEST(DampedModes, TurnByComplexExponentials) {
  SceneRun run(kShaft);
  const DampedModes modes(run.dynamics(), 1.0);
  const Index p = modes.count();
  for (const Index first : {Index{0}, Index{3}})
    for (const double t : {1e-5, 1e-2, 1.0}) {
      Eigen::ArrayXd re(p - first), im(p - first);
      modes.turn_by(t, first, re, im);
      for (Index k = first; k < p; ++k) {
        const double size = std::exp(modes.decay()[k] * t), angle = modes.turn()[k] * t;
        EXPECT_NEAR(re[k - first], size * std::cos(angle), 1e-15) << k << " " << t;
        EXPECT_NEAR(im[k - first], size * std::sin(angle), 1e-15) << k << " " << t;
      }
    }
  EXPECT_GT(modes.turn()[p - 1], 39000.0);
}

TEST(StepNodes, InterpolatePolynomialsOfDegreeSix) {
  using integrators::StepNodes;
  Eigen::Matrix<double, 1, 7> values, fifth;
  for (Index j = 0; j < 7; ++j) {
    const double s = StepNodes::kPlaces[static_cast<std::size_t>(j)];
    fifth[j] = 1.0 - 3.0 * s + std::pow(s, 5);
    values[j] = fifth[j] + 2.0 * std::pow(s, 6);
  }
  for (const double s : {0.1, 0.7, 0.95}) {
    const double exact = 1.0 - 3.0 * s + std::pow(s, 5);
    EXPECT_NEAR((values * StepNodes::lagrange(s))(0), exact + 2.0 * std::pow(s, 6), 1e-12);
    const Eigen::Matrix<double, 1, 7> powers = fifth * StepNodes::without_middle();
    double sum = 0.0;
    for (Index r = 6; r >= 0; --r) sum = sum * s + powers[r];
    EXPECT_NEAR(sum, exact, 1e-12);
  }
}

TEST(StepNodes, EstimateTheErrorOfTheirQuadrature) {
  using integrators::StepNodes;
  const auto smooth_step = [](double s, double at, double width) { return std::tanh((s - at) / width); };
  int estimates = 0, generous = 0;
  for (const double at : {-0.4, 0.0, 0.3, 0.5, 0.8, 1.2})
    for (const double width : {0.15, 0.3, 0.6, 1.0, 1.5}) {
      // Lobatto's weights are the integrals of the polynomials without the interior node.
      Eigen::Matrix<double, 1, 7> values;
      for (Index j = 0; j < 7; ++j) values[j] = smooth_step(StepNodes::kPlaces[static_cast<std::size_t>(j)], at, width);
      const Eigen::Matrix<double, 1, 7> powers = values * StepNodes::without_middle();
      double got = 0.0;
      for (Index r = 0; r < 7; ++r) got += powers[r] / static_cast<double>(r + 1);
      const double wanted = width * std::log(std::cosh((1.0 - at) / width) / std::cosh(at / width)),
                   error = std::abs(got - wanted),
                   estimate = StepNodes::quadrature_error(values * StepNodes::legendre());
      if (error < 1e-13) continue;
      ++estimates;
      if (estimate > error) ++generous;
      EXPECT_GT(estimate, 0.02 * error) << at << " " << width;
      EXPECT_LT(estimate, 500.0 * error) << at << " " << width;
    }
  EXPECT_GT(estimates, 20);
  EXPECT_GT(generous, estimates / 2);
}

}  // namespace
}  // namespace butee::test::damped_modes_test
