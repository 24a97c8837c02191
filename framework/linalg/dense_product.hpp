#pragma once

#include <span>

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::linalg {

namespace kernel {
struct Dense;
}

/// y = A x for a small dense A of up to 96 rows. Its columns are padded to whole vector registers,
/// so that all sums stay in registers while A is read once. Several times as fast as a general
/// product at this size. Allocates nothing after construction.
class BUTEE_EXPORT DenseProduct {
 public:
  static constexpr Index kMostRows = 96;

  DenseProduct() = default;
  explicit DenseProduct(const Eigen::MatrixXd& matrix);

  bool empty() const { return columns_ == 0; }
  /// y := A x; y has the rows and x the columns of A; they must not overlap.
  void multiply(const double* x, double* y) const;
  /// The same for two vectors, y0 := A x0 and y1 := A x1, reading A once.
  void multiply(const double* x0, const double* x1, double* y0, double* y1) const;
  /// y := A x for an x that is zero outside these entries.
  void multiply(std::span<const Index> columns, const double* x, double* y) const;

 private:
  const kernel::Dense* kernels_ = nullptr;
  Index rows_ = 0, columns_ = 0;
  Eigen::MatrixXd padded_;
};

}  // namespace butee::linalg
