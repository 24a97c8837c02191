#include <cmath>

#include <butee/linalg/band_factor.hpp>
#include <butee/linalg/chunk_table.hpp>
#include <butee/linalg/symmetric_product.hpp>
#include <gtest/gtest.h>

namespace butee::test::chunk_table_test {
namespace {

constexpr Index kWidth = 10, kCount = 4000;

double entry(Index chunk, Index i) {
  return static_cast<double>(100 * chunk + i);
}

/// A table of chunks that repeat with the given period.
linalg::ChunkTable table(Index period) {
  linalg::ChunkTable all(kWidth, kCount);
  double* to = all.write();
  for (Index chunk = 0; chunk < kCount; ++chunk)
    for (Index i = 0; i < kWidth; ++i) *to++ = entry(chunk % period, i);
  all.share();
  return all;
}

TEST(ChunkTable, HoldsWhatWasWrittenSharedOrNot) {
  for (const Index period : {Index{1}, Index{7}, Index{200}, kCount / 2, kCount}) {
    const linalg::ChunkTable all = table(period);
    EXPECT_EQ(all.is_shared(), period <= 200) << period;
    for (Index chunk = 0; chunk < kCount; ++chunk)
      for (Index i = 0; i < kWidth; ++i) ASSERT_EQ(all[chunk][i], entry(chunk % period, i)) << period;
    EXPECT_EQ(all[0] == all[7 * 100], period == 1 || period == 7) << period;
  }
}

TEST(ChunkTable, IsWrittenAgainAfterSharing) {
  linalg::ChunkTable all = table(3);
  double* to = all.write();
  EXPECT_FALSE(all.is_shared());
  for (Index i = 0; i < kWidth * kCount; ++i) to[i] = static_cast<double>(i);
  all.share();
  EXPECT_FALSE(all.is_shared());
  EXPECT_EQ(all[kCount - 1][kWidth - 1], static_cast<double>(kWidth * kCount - 1));
}

/// A diagonally dominant matrix whose rows repeat with a period, except a few in the middle.
SparseMatrix repeating(Index size, Index band, Index period) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < size; ++i) {
    const double odd = i / 10 == size / 20 ? 0.25 : 0.0, place = static_cast<double>(i % period);
    entries.emplace_back(i, i, 2.0 * static_cast<double>(band) + 2.0 + std::cos(place) + odd);
    for (Index k = 1; k <= band && i + k < size; ++k) {
      const double value = std::sin(3.0 * place + 7.0 * static_cast<double>(k)) + odd;
      entries.emplace_back(i, i + k, value);
      entries.emplace_back(i + k, i, value);
    }
  }
  SparseMatrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Vector some_vector(Index size) {
  Vector x(size);
  for (Index i = 0; i < size; ++i) x[i] = std::cos(1.0 + 0.7 * static_cast<double>(i));
  return x;
}

/// The band factor of a uniform structure also repeats, starting some rows from its ends; that of a
/// nonuniform structure does not.
TEST(SharedRows, SolveAndMultiplyWhatTheMatrixSays) {
  constexpr double kSolved = 1e-13;
  for (const Index band : {1, 3, 8})
    for (const Index period : {Index{1}, Index{2}, Index{40}, Index{1} << 20U})
      for (const Index size : {6000, 6003, 6007}) {
        const SparseMatrix matrix = repeating(size, band, period);
        const Vector x = some_vector(size);
        const Vector right = matrix * x;
        Vector product(size);
        const linalg::SymmetricProduct symmetric(matrix);
        symmetric.multiply(x.data(), product.data());
        EXPECT_LE((product - right).norm(), kSolved * right.norm()) << size << " " << band << " " << period;
        // In the blocks that in_blocks() uses.
        symmetric.multiply(x.data(), 0, 2048, product.data());
        symmetric.multiply(x.data(), 2048, size - 2048, product.data() + 2048);
        EXPECT_LE((product - right).norm(), kSolved * right.norm()) << size << " " << band << " " << period;

        linalg::BandFactor factor(size, band);
        ASSERT_TRUE(factor.factorize(repeating(size, band, 2)));
        ASSERT_TRUE(factor.factorize(matrix));
        Vector solution = right;
        factor.solve(solution.data());
        EXPECT_LE((solution - x).norm(), kSolved * x.norm()) << size << " " << band << " " << period;
        solution = right;
        factor.solve_less(solution.data(), 2.0, right.data());
        EXPECT_LE((solution - x + 2.0 * right).norm(), kSolved * right.norm()) << size << " " << band << " " << period;
      }
}

}  // namespace
}  // namespace butee::test::chunk_table_test
