#include <cmath>

#include <Eigen/Dense>
#include <butee/dynamics/frequencies.hpp>
#include <butee/linalg/dense_pairs.hpp>
#include <gtest/gtest.h>

#include "unit/scenes.hpp"

namespace butee::test::modal_damping_test {
namespace {

/// Machine precision times the condition number of these systems; the largest difference is 1.3e-12.
constexpr double kRounding = 1e-11;
/// For the lowest modes of a finer mesh: two methods reduce the problem to standard form differently. They
/// differ by rounding times the ratio 1e7 of the highest to the lowest eigenvalue. The largest difference is
/// 1.2e-10.
constexpr double kTwoReductions = 1e-9;
/// On the mesh for which Lanczos is used, the dense reference solution also loses digits: the ratio of the
/// highest to the lowest eigenvalue is 1e9. The largest difference is 1e-9.
constexpr double kLanczos = 1e-8;

/// Two pinned beams coupled by a spring with a dashpot, one of them on a spring to ground, with stops to
/// ground and between the beams: 4 elements + 2 DOFs.
std::string two_beams(int elements, const std::string& modal) {
  const std::string mesh = "length = 2.0\nelements = " + std::to_string(elements);
  return kHeader + kSteelBar + beam("rotor", mesh) + beam("casing", mesh) +
         support(R"(["rotor:first", "casing:first"])", R"(["u"])") +
         R"(
[[element]]
type      = "spring"
nodes     = ["rotor:last", "casing:last"]
stiffness = 1.0e6
damping   = 20.0

[[element]]
type      = "spring"
node      = "rotor:last"
stiffness = 3.0e5

[[contact]]
type      = "stop"
nodes     = "rotor:all"
gap       = 0.01
stiffness = 1.0e7

[[contact]]
type      = "stop"
between   = ["rotor:all", "casing:all"]
gap       = 0.001
stiffness = 1.0e6

[damping]
modal = )" +
         modal + "\n";
}

Vector some_vector(Index size) {
  Vector x(size);
  for (Index i = 0; i < size; ++i) x[i] = std::cos(1.0 + 0.7 * static_cast<double>(i));
  return x;
}

/// C of one ratio without any mode: 2 zeta M^(1/2) (M^(-1/2) K M^(-1/2))^(1/2) M^(1/2).
Eigen::MatrixXd damping_of_all(const model::System& system, double zeta) {
  const linalg::Pairs mass = linalg::dense_pairs(Eigen::MatrixXd(system.mass)).value();
  const auto power = [&](double exponent) {
    const Vector powers = mass.values.array().pow(exponent);
    return Eigen::MatrixXd(mass.vectors * powers.asDiagonal() * mass.vectors.transpose());
  };
  const Eigen::MatrixXd root = power(0.5), inverse = power(-0.5);
  const linalg::Pairs dynamic = linalg::dense_pairs(Eigen::MatrixXd(inverse * system.stiffness * inverse)).value();
  const Vector omega = dynamic.values.cwiseMax(0.0).cwiseSqrt();
  return 2.0 * zeta * root * dynamic.vectors * omega.asDiagonal() * dynamic.vectors.transpose() * root;
}

/// C of a list of ratios, M Phi diag(2 zeta omega) Phi^T M.
Eigen::MatrixXd damping_of_lowest(const model::System& system, const std::vector<double>& zeta) {
  const Eigen::MatrixXd mass(system.mass);
  const linalg::Pairs pairs = linalg::dense_pairs(Eigen::MatrixXd(system.stiffness), mass).value();
  Eigen::MatrixXd damping = Eigen::MatrixXd::Zero(mass.rows(), mass.cols());
  for (std::size_t i = 0; i < zeta.size(); ++i) {
    const auto mode = static_cast<Index>(i);
    const double omega = std::sqrt(std::max(pairs.values[mode], 0.0));
    const Vector shape = mass * pairs.vectors.col(mode);
    damping += 2.0 * zeta[i] * omega * shape * shape.transpose();
  }
  return damping;
}

struct Case {
  const char* name;
  int elements;
  const char* modal;
  std::vector<double> ratios;  ///< one ratio for all modes, or a list
  double tolerance;
};

std::ostream& operator<<(std::ostream& stream, const Case& one) {
  return stream << one.name;
}

/// All algorithms: an inverse, a dense factor, Woodbury on a narrow band and on a sparse factor, Lanczos.
std::vector<Case> cases() {
  return {{"all_modes_of_a_small_system", 4, "0.03", {0.03}, kRounding},
          {"all_modes_of_a_larger_one", 28, "0.03", {0.03}, kRounding},
          {"a_few_modes_of_a_small_one", 4, "[0.03, 0, 0.5]", {0.03, 0.0, 0.5}, kRounding},
          {"a_few_modes_of_a_larger_one", 28, "[0.03, 0.02, 0, 0.5]", {0.03, 0.02, 0.0, 0.5}, kTwoReductions},
          {"a_few_modes_by_lanczos", 60, "[0.03, 0.02, 0, 0.5]", {0.03, 0.02, 0.0, 0.5}, kLanczos}};
}

class ModalDamping : public testing::TestWithParam<Case> {
 protected:
  SceneRun scene_{two_beams(GetParam().elements, GetParam().modal)};
  const model::System& system_ = scene_.system();

  Eigen::MatrixXd damping() const {
    const auto& ratios = GetParam().ratios;
    const Eigen::MatrixXd modal =
        ratios.size() == 1 ? damping_of_all(system_, ratios[0]) : damping_of_lowest(system_, ratios);
    return modal + Eigen::MatrixXd(system_.dashpots);
  }
  void expect_near(const Vector& got, const Vector& wanted) const {
    EXPECT_LE((got - wanted).norm(), GetParam().tolerance * wanted.norm());
  }
};

TEST_P(ModalDamping, ForceIsThatOfTheDenseMatrix) {
  ASSERT_TRUE(scene_.dynamics().has_damping());
  const Vector v = some_vector(system_.size());
  Vector force(v.size());
  scene_.dynamics().damping_force(v, force);
  expect_near(force, damping() * v);
}

TEST_P(ModalDamping, DecelerationIsThatOfTheDenseMatrix) {
  const Vector v = some_vector(system_.size()), rest = Vector::Zero(v.size());
  Vector a(v.size());
  scene_.dynamics().acceleration(0.0, rest, v, a);
  expect_near(a, -Eigen::MatrixXd(system_.mass).ldlt().solve(damping() * v));
}

TEST_P(ModalDamping, EffectiveEquationsAreSolvedWithStopsOpenAndClosed) {
  const dynamics::ElasticStops& contact = scene_.dynamics().stops();
  Eigen::MatrixXd pick = Eigen::MatrixXd::Zero(contact.size(), system_.size());
  for (Index i = 0; i < contact.size(); ++i) {
    if (contact.dof_a(i) >= 0) pick(i, contact.dof_a(i)) += 1.0;
    if (contact.dof_b(i) >= 0) pick(i, contact.dof_b(i)) -= 1.0;
  }
  const Eigen::MatrixXd mass(system_.mass), stiffness(system_.stiffness), c = damping();
  const Vector right = some_vector(system_.size());
  using Contacts = dynamics::EffectiveSolver::Contacts;
  const auto modal = dynamics::ModalDamping::of(system_);
  ASSERT_NE(modal, nullptr);
  for (const Contacts way : {Contacts::local, Contacts::factorized}) {
    linalg::Counters counters;
    dynamics::EffectiveSolver solver(system_, contact, counters, way, modal.get());
    for (const double h : {1e-5, 1e-3, 1e-5})
      for (const double closed : {0.0, 1.0, 1e7}) {
        Vector kappa(contact.size()), y = right;
        for (Index i = 0; i < kappa.size(); ++i) kappa[i] = i % 3 == 0 ? 0.0 : closed * static_cast<double>(i);
        solver.set_factors(0.5 * h, 0.25 * h * h);
        ASSERT_TRUE(solver.solve(kappa, y));
        const Eigen::MatrixXd full =
            mass + 0.5 * h * c + 0.25 * h * h * (stiffness + pick.transpose() * kappa.asDiagonal() * pick);
        expect_near(y, full.ldlt().solve(right));
      }
  }
}

TEST_P(ModalDamping, EffectiveSolverOfTheDynamicsHasIt) {
  const double h = 1e-4;
  Vector y = some_vector(system_.size());
  const Eigen::MatrixXd full =
      Eigen::MatrixXd(system_.mass) + 0.5 * h * damping() + 0.25 * h * h * Eigen::MatrixXd(system_.stiffness);
  const Vector expected = full.ldlt().solve(y);
  scene_.dynamics().effective().set_factors(0.5 * h, 0.25 * h * h);
  ASSERT_TRUE(scene_.dynamics().effective().solve(Vector::Zero(scene_.dynamics().stop_count()), y));
  expect_near(y, expected);
}

INSTANTIATE_TEST_SUITE_P(ways, ModalDamping, testing::ValuesIn(cases()),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(ModalDampingOfOneMass, IsADashpotOf2ZetaSqrtKM) {
  for (const std::string stops :
       {"", "\n[[contact]]\ntype = \"stop\"\nnodes = \"ball\"\ngap = 1.0\nstiffness = 1e3\n"}) {
    SceneRun scene(kHeader + mass("ball", "2.0") +
                   "\n[[element]]\ntype = \"spring\"\nnode = \"ball\"\nstiffness = 50.0\n" + stops +
                   "\n[damping]\nmodal = 0.1\n");
    const double c = 2.0 * 0.1 * std::sqrt(50.0 * 2.0);
    Vector x = Vector::Zero(1), v = Vector::Ones(1), y(1);
    scene.dynamics().damping_force(v, y);
    EXPECT_NEAR(y[0], c, kRounding);
    scene.dynamics().acceleration(0.0, x, v, y);
    EXPECT_NEAR(y[0], -c / 2.0, kRounding);
    y.setOnes();
    scene.dynamics().effective().set_factors(0.3, 0.01);
    ASSERT_TRUE(scene.dynamics().effective().solve(Vector::Zero(scene.dynamics().stop_count()), y));
    EXPECT_NEAR(y[0], 1.0 / (2.0 + 0.3 * c + 0.01 * 50.0), kRounding);
    const Vector none = Vector::Zero(scene.dynamics().stop_count());
    ASSERT_TRUE(scene.dynamics().solve_secant(0.0, 0.3, 0.01, none, none, x, v, y));
    EXPECT_NEAR(y[0], -c / (2.0 + 0.3 * c + 0.01 * 50.0), kRounding);
  }
}

TEST(ModalDampingOfAFreeBeam, LeavesRigidMotionAlone) {
  for (const int elements : {10, 150})
    for (const std::string modal : {"0.05", "[0, 0, 0.05]"}) {
      SceneRun scene(kHeader + kSteelBar + beam("rod", "length = 2.0\nelements = " + std::to_string(elements)) +
                     "\n[damping]\nmodal = " + modal + "\n");
      Vector shift = Vector::Zero(scene.system().size()), force(shift.size());
      for (Index i = 0; i < shift.size(); i += 2) shift[i] = 1.0;
      scene.dynamics().damping_force(shift, force);
      // Relative to the damping force of a bending motion of the same size, 1e5 N s/m.
      EXPECT_LE(force.norm(), 1e-3);
    }
}

/// Two equal masses on equal springs: which of the two modes is damped would be arbitrary.
TEST(ModalDampingOfEqualFrequencies, IsRefusedUnlessTheRatiosAreEqual) {
  const auto scene = [](const std::string& modal) {
    std::string text = kHeader;
    for (const std::string name : {"a", "b"})
      text += mass(name, "2.0") + "\n[[element]]\ntype = \"spring\"\nnode = \"" + name + "\"\nstiffness = 50.0\n";
    return text + "\n[damping]\nmodal = " + modal + "\n";
  };
  EXPECT_TRUE(holds(refusal(scene("[0.1]")), "modes 1 and 2, which have the same frequency, 5 rad/s"));
  EXPECT_TRUE(holds(refusal(scene("[0.1, 0.2]")), "give both the same ratio"));
  EXPECT_NO_THROW(SceneRun(scene("[0.1, 0.1]")));
}

TEST(ModalDampingOfAFreeBeam, RefusesARatioForRigidMotion) {
  const std::string text = refusal(kHeader + kSteelBar + beam("rod", "length = 2.0\nelements = 10") +
                                   "\n[damping]\nmodal = [0, 0.05, 0.05]\n");
  EXPECT_TRUE(holds(text, "[damping] modal gives a ratio to mode 2, whose frequency is zero")) << text;
  EXPECT_TRUE(holds(text, "write 0 for rigid motion, or use longer elements")) << text;
}

TEST(LowestModes, AreFoundAlsoWhereTwoAreEqual) {
  // Two uncoupled beams: every frequency occurs twice.
  const std::string mesh = "length = 2.0\nelements = 80";
  const SceneRun scene(kHeader + kSteelBar + beam("a", mesh) + beam("b", mesh) +
                       support(R"(["a:first", "a:last", "b:first", "b:last"])", R"(["u"])"));
  for (const Index count : {2, 4, 6}) {
    const auto modes = dynamics::lowest_modes(scene.system(), count);
    ASSERT_TRUE(modes.has_value());
    for (Index i = 0; i < count; i += 2)
      EXPECT_NEAR(modes->frequencies[i + 1] / modes->frequencies[i], 1.0, kLanczos) << "pair " << i / 2;
    const Eigen::MatrixXd gram = modes->shapes.transpose() * scene.system().mass * modes->shapes;
    EXPECT_LE((gram - Eigen::MatrixXd::Identity(count, count)).norm(), kRounding);
  }
}

TEST(NoModalDamping, IsNoDamping) {
  for (const std::string modal : {"0", "[0, 0.0]"}) {
    SceneRun scene(kHeader + mass("ball", "2.0") + mass("other", "1.0") + "\n[damping]\nmodal = " + modal + "\n");
    EXPECT_FALSE(scene.dynamics().has_damping());
  }
}

/// A dashpot between two equal masses: c (1/m + 1/m).
TEST(FastestDecay, IsThatOfTheRelativeMotion) {
  SparseMatrix damping(3, 3), mass(3, 3);
  mass.setIdentity();
  mass.coeffRef(0, 0) = mass.coeffRef(1, 1) = 2.0;
  for (const auto& [i, j, value] :
       {std::tuple(0, 0, 8.0), std::tuple(1, 1, 8.0), std::tuple(0, 1, -8.0), std::tuple(1, 0, -8.0)})
    damping.coeffRef(i, j) = value;
  const auto fastest = dynamics::fastest_decay(damping, mass);
  ASSERT_TRUE(fastest);
  EXPECT_NEAR(*fastest, 8.0, 1e-9);
  EXPECT_EQ(dynamics::fastest_decay(SparseMatrix(3, 3), mass), 0.0);
}

}  // namespace
}  // namespace butee::test::modal_damping_test
