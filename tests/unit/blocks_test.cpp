// Systems of several blocks of rows, compared with the sparse matrices themselves.
#include "butee/core/blocks.hpp"

#include <cmath>

#include <butee/linalg/symmetric_product.hpp>
#include <gtest/gtest.h>

#include "support/large_scenes.hpp"
#include "unit/scenes.hpp"

namespace butee::test::blocks_test {
namespace {

/// Rounding of sums of a few products, relative to the largest entry.
constexpr double kRounding = 1e-13;

Vector wave(Index size, double phase) {
  return Vector::NullaryExpr(size, [phase](Index i) { return std::sin(phase + 0.7 * static_cast<double>(i)); });
}

void expect_near(const Vector& value, const Vector& expected, double tolerance = kRounding) {
  ASSERT_EQ(value.size(), expected.size());
  EXPECT_LE((value - expected).lpNorm<Eigen::Infinity>(), tolerance * expected.lpNorm<Eigen::Infinity>());
}

TEST(Blocks, CoverEveryRowOnce) {
  for (const Index size : {Index{0}, Index{1}, kLargestBlock, kLargestBlock + 1, 3 * kBlock + 5}) {
    Index next = 0;
    std::size_t blocks = 0;
    in_blocks(size, [&](Index begin, Index count) {
      EXPECT_EQ(begin, next);
      EXPECT_LE(count, kLargestBlock);
      EXPECT_EQ(block_of(begin, size), blocks);
      EXPECT_EQ(block_of(std::max(begin, begin + count - 1), size), blocks);
      next = begin + count;
      ++blocks;
    });
    EXPECT_EQ(next, size);
    EXPECT_EQ(block_count(size), blocks);
  }
}

class LargeScene : public testing::TestWithParam<std::string> {
 protected:
  dynamics::Dynamics& dynamics() { return scene_.dynamics(); }
  const model::System& system() const { return scene_.system(); }
  Index size() const { return system().size(); }
  Vector damping_force(const Vector& v) const {
    const model::Damping& damping = system().damping;
    Vector y =
        damping.mass_proportional * (system().mass * v) + damping.stiffness_proportional * (system().stiffness * v);
    if (system().dashpots.size() > 0) y += system().dashpots * v;
    return y;
  }

 private:
  SceneRun scene_{GetParam()};
};

TEST_P(LargeScene, HasTheProductsOfItsMatrices) {
  ASSERT_GT(size(), 2 * kLargestBlock);
  const Vector x = wave(size(), 0.0), v = wave(size(), 1.0);
  Vector y(size());
  dynamics().elastic_force(x, y);
  expect_near(y, system().stiffness * x);
  const linalg::SymmetricProduct product(system().stiffness);
  Vector by_blocks(size());
  in_blocks(size(),
            [&](Index begin, Index count) { product.multiply(x.data(), begin, count, by_blocks.data() + begin); });
  EXPECT_EQ(by_blocks, y);
  dynamics().damping_force(v, y);
  expect_near(y, damping_force(v));
}

TEST_P(LargeScene, HasTheResidualOfItsEquations) {
  const Index stops = dynamics().stop_count();
  const Vector x = wave(size(), 0.0), v = 1e3 * wave(size(), 1.0), a = 1e6 * wave(size(), 2.0);
  const Vector stop_force = 1e8 * wave(stops, 4.0);
  Vector r(size()), load(size()), contact = Vector::Zero(size());
  dynamics().external_force(0.3, load);
  const linalg::ForceBalance balance = dynamics().residual(load, stop_force, x, v, a, r);
  dynamics().stops().scatter(stop_force, contact);
  const Vector inertia = system().mass * a, elastic = system().stiffness * x, damping = damping_force(v);
  expect_near(r, load + contact - inertia - damping - elastic);
  EXPECT_NEAR(balance.residual() / r.norm(), 1.0, 1e-12);
  const double scale = load.norm() + contact.norm() + inertia.norm() + damping.norm() + elastic.norm();
  EXPECT_NEAR(balance.scale() / scale, 1.0, 1e-12);
}

TEST_P(LargeScene, AcceleratesAsItsForcesSay) {
  const Vector x = 1e-3 * wave(size(), 0.0), v = wave(size(), 1.0);
  Vector a(size()), given(size()), load(size()), contact = Vector::Zero(size());
  dynamics().acceleration(0.3, x, v, a);
  dynamics().external_force(0.3, load);
  dynamics().add_contact_force(x, contact);
  const Vector inertia = system().mass * a, damping = damping_force(v), elastic = system().stiffness * x;
  const double scale = inertia.norm() + damping.norm() + elastic.norm() + contact.norm() + load.norm();
  EXPECT_LE((load + contact - inertia - damping - elastic).norm(), 1e-12 * scale);
  given = load + contact;
  dynamics().solve_acceleration(x, v, given);
  expect_near(given, a, 1e-11);
}

TEST_P(LargeScene, FulfilsItsEquationsAfterASecantSolve) {
  const Index stops = dynamics().stop_count();
  const double t = 0.3, velocity_factor = 5e-5, displacement_factor = 2.5e-9;
  const Vector x = 1e-3 * wave(size(), 0.0), v = wave(size(), 1.0), kappa = Vector::Constant(stops, 1e7),
               c = 1e4 * wave(stops, 2.0);
  Vector a(size()), load(size()), w(stops), contact = Vector::Zero(size());
  ASSERT_TRUE(dynamics().solve_secant(t, velocity_factor, displacement_factor, kappa, c, x, v, a));
  const Vector end = x + displacement_factor * a;
  dynamics().external_force(t, load);
  dynamics().stops().displacement(end, w);
  dynamics().stops().scatter(c - kappa.cwiseProduct(w), contact);
  const Vector inertia = system().mass * a, damping = damping_force(v + velocity_factor * a),
               elastic = system().stiffness * end;
  const double scale = inertia.norm() + damping.norm() + elastic.norm() + contact.norm() + load.norm();
  EXPECT_LE((load + contact - inertia - damping - elastic).norm(), 1e-12 * scale);
}

const std::string kBothDampings = "\n[damping]\nmass_proportional = 0.3\nstiffness_proportional = 1e-5\n";

std::string with_both_dampings(std::string scene) {
  const std::string one = "[damping]\nmass_proportional = 0.03\n";
  const std::size_t place = scene.find(one);
  if (place == std::string::npos) throw std::logic_error("large scenes are damped otherwise than this test knows");
  return scene.replace(place, one.size(), kBothDampings);
}

const std::string kDashpot = "\n[[element]]\ntype = \"spring\"\nnode = \"b0:1000\"\nstiffness = 1e4\ndamping = 300.0\n";

INSTANTIATE_TEST_SUITE_P(all, LargeScene,
                         testing::Values(long_beam(5000), with_both_dampings(long_beam(5000)),
                                         with_both_dampings(long_beam(5000)) + kDashpot, tied_beams(300),
                                         with_both_dampings(tied_beams(300))));

}  // namespace
}  // namespace butee::test::blocks_test
