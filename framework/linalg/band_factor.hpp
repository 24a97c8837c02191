#pragma once

#include <vector>

#include <butee/export.hpp>

#include "butee/linalg/chunk_table.hpp"

namespace butee::linalg {

namespace kernel {
struct FactorView;
struct Subtrahend;
}  // namespace kernel

/// L D L^T of a symmetric positive definite matrix of narrow band, as of chains of beams.
///
/// Rows are eliminated from both ends towards a dense block of band or band + 1 rows in the middle
/// (a twisted factorization), so that two independent recurrences run side by side in one register:
/// the latency of its recurrence limits the speed of such a solve. Work of a solve: n (4 b + 1)
/// operations for the band b. Checked against a dense solution in tests/unit/band_factor_test.cpp.
class BUTEE_EXPORT BandFactor {
 public:
  static constexpr Index kWidestBand = 8;

  /// True if a matrix of this size and band can be factorized.
  static bool fits(Index size, Index band) { return band >= 1 && band <= kWidestBand && size >= 3 * band + 1; }

  /// For matrices of this size and band, which must fit.
  BandFactor(Index size, Index band);

  /// False if the matrix is not positive definite.
  [[nodiscard]] bool factorize(const SparseMatrix& matrix);

  /// b := A^-1 b. Valid after a successful factorize(). Allocates nothing.
  void solve(double* b) const;
  /// b := A^-1 b - factor v, in the same passes.
  void solve_less(double* b, double factor, const double* v) const;

 private:
  class Chain;
  bool store(const Chain& top, const Chain& bottom, const Eigen::MatrixXd& middle);

  using Kernel = void (*)(const kernel::FactorView&, double*, const kernel::Subtrahend&);
  Kernel solve_, solve_less_;
  Index size_, band_;
  Index steps_;  ///< rows eliminated from each end
  /// Chunks of 8 steps. Each holds pairs (from the top, from the bottom) for every distance k = 1
  /// ... band: forward_ L(s, s - k) for steps_ + band rows; backward_ L(s + k, s), after the pair
  /// of reciprocal pivots.
  ChunkTable forward_, backward_;
  std::vector<double> middle_inverse_;  ///< by rows
};

}  // namespace butee::linalg
