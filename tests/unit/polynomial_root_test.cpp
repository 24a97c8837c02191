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

}  // namespace
}  // namespace butee::integrators::polynomial_root_test
