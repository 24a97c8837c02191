#include "integrators/polynomial_root.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace butee::integrators::polynomial_root_test {
namespace {

/// Coefficients of scale times the product of (s - root).
std::vector<double> polynomial(const std::vector<double>& roots, double scale) {
  std::vector<double> c = {scale};
  for (const double root : roots) {
    c.push_back(0.0);
    for (std::size_t k = c.size() - 1; k > 0; --k) c[k] = c[k - 1] - root * c[k];
    c[0] *= -root;
  }
  return c;
}

TEST(PolynomialRoot, FindsTheFirstOfSeveral) {
  PolynomialRoot finder(12);
  const auto root = finder.first(polynomial({0.7, 0.31, 0.9, 2.0, -0.1}, 3.0));
  ASSERT_TRUE(root);
  EXPECT_NEAR(*root, 0.31, 1e-14);
}

TEST(PolynomialRoot, SeparatesRootsThatLieClose) {
  PolynomialRoot finder(12);
  const auto root = finder.first(polynomial({0.5 + 1e-6, 0.5}, 1.0));
  ASSERT_TRUE(root);
  EXPECT_NEAR(*root, 0.5, 1e-9);  // for two roots 1e-6 apart, the error is rounding over that distance
}

TEST(PolynomialRoot, FindsNoneOutsideOrWhereItOnlyTouches) {
  PolynomialRoot finder(12);
  EXPECT_FALSE(finder.first(polynomial({1.2, -0.3}, 1.0)));
  EXPECT_FALSE(finder.first(std::vector<double>{1.0, -2.0, 1.0000001}));  // minimum 1e-7 near s = 1
  EXPECT_FALSE(finder.first(std::vector<double>{0.0, 0.0, 0.0}));
}

TEST(PolynomialRoot, LeavesOutTheRootAtTheStart) {
  PolynomialRoot finder(12);
  const auto root = finder.first(polynomial({0.0, 0.25}, -1.0));  // s (0.25 - s): increases from zero
  ASSERT_TRUE(root);
  EXPECT_NEAR(*root, 0.25, 1e-14);
}

/// (1 - 2 s) ((s - c)^2 + e): the only root lies where intervals are halved, and the other factor has none.
TEST(PolynomialRoot, FindsARootWhereIntervalsAreHalved) {
  PolynomialRoot finder(12);
  for (int i = 0; i <= 20; ++i)
    for (const double e : {1e-4, 1e-3, 1e-2, 0.1, 1.0})
      for (const double scale : {1.0, -1.0}) {
        const double c = 0.05 * i, q = scale * (c * c + e);
        const auto root =
            finder.first(std::vector<double>{q, -2.0 * q - 2.0 * scale * c, scale * (1.0 + 4.0 * c), -2.0 * scale});
        ASSERT_TRUE(root) << c << ' ' << e;
        EXPECT_NEAR(*root, 0.5, 1e-12) << c << ' ' << e;
      }
  // A double root there is a touch.
  EXPECT_FALSE(finder.first(polynomial({0.5, 0.5, 1.5}, 1.0)));
  const auto later = finder.first(polynomial({0.5, 0.5, 0.75}, 1.0));
  ASSERT_TRUE(later);
  EXPECT_NEAR(*later, 0.75, 1e-12);
}

}  // namespace
}  // namespace butee::integrators::polynomial_root_test
