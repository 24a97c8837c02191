#include <cmath>

#include <Eigen/Dense>
#include <butee/linalg/band_factor.hpp>
#include <gtest/gtest.h>

namespace butee::test::band_factor_test {
namespace {

/// A symmetric band matrix with irregular entries; positive definite if the diagonal is large.
SparseMatrix band_matrix(Index size, Index band, double diagonal) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (Index i = 0; i < size; ++i) {
    dense(i, i) = diagonal + std::cos(static_cast<double>(i));
    for (Index k = 1; k <= band && i + k < size; ++k)
      dense(i, i + k) = dense(i + k, i) = std::sin(static_cast<double>(3 * i + 7 * k));
  }
  return dense.sparseView();
}

TEST(BandFactor, SolvesWhatTheDenseMatrixSays) {
  // Both are direct solutions; the condition numbers are below 100.
  constexpr double kSolved = 1e-13;
  int cases = 0;
  for (Index band = 1; band <= linalg::BandFactor::kWidestBand; ++band)
    for (Index size = 3 * band + 1; size <= 3 * band + 12; ++size) {
      const SparseMatrix matrix = band_matrix(size, band, 2.0 * static_cast<double>(band) + 2.0);
      ASSERT_TRUE(linalg::BandFactor::fits(size, band));
      linalg::BandFactor factor(size, band);
      ASSERT_TRUE(factor.factorize(matrix));
      Vector right(size);
      for (Index i = 0; i < size; ++i) right[i] = std::cos(1.0 + static_cast<double>(i));
      const Vector expected = Eigen::MatrixXd(matrix).ldlt().solve(right);
      Vector less = right;
      const Vector v = right.reverse();
      factor.solve(right.data());
      EXPECT_LE((right - expected).norm(), kSolved * expected.norm()) << "size " << size << ", band " << band;
      factor.solve_less(less.data(), 3.0, v.data());
      EXPECT_LE((less - (right - 3.0 * v)).norm(), kSolved * v.norm()) << "size " << size << ", band " << band;
      ++cases;
    }
  EXPECT_EQ(cases, 8 * 12);
}

TEST(BandFactor, ForgetsTheMatrixBefore) {
  linalg::BandFactor factor(30, 3);
  ASSERT_TRUE(factor.factorize(band_matrix(30, 3, 8.0)));
  const SparseMatrix matrix = band_matrix(30, 3, 20.0);
  ASSERT_TRUE(factor.factorize(matrix));
  Vector right = Vector::Ones(30);
  const Vector expected = Eigen::MatrixXd(matrix).ldlt().solve(right);
  factor.solve(right.data());
  EXPECT_LE((right - expected).norm(), 1e-13 * expected.norm());
}

TEST(BandFactor, RefusesWhatIsNotPositiveDefiniteWhereverItShows) {
  for (const Index row : {0, 14, 15, 29}) {
    SparseMatrix matrix = band_matrix(30, 3, 8.0);
    matrix.coeffRef(row, row) = -1.0;
    EXPECT_FALSE(linalg::BandFactor(30, 3).factorize(matrix)) << row;
  }
}

}  // namespace
}  // namespace butee::test::band_factor_test
