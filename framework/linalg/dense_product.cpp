#include "butee/linalg/dense_product.hpp"

#include "butee/core/error.hpp"
#include "butee/linalg/kernel/dense.hpp"

namespace butee::linalg {

DenseProduct::DenseProduct(const Eigen::MatrixXd& matrix)
    : kernels_(&kernel::dense()), rows_(matrix.rows()), columns_(matrix.cols()) {
  require(rows_ >= 1 && rows_ <= kMostRows, "a dense product is for small matrices");
  padded_ = Eigen::MatrixXd::Zero(kernel::chunks_for(rows_) * kernel::kChunk, columns_);
  padded_.topRows(rows_) = matrix;
}

void DenseProduct::multiply(const double* x, double* y) const {
  kernels_->multiply({padded_.data(), rows_, columns_}, x, y);
}

void DenseProduct::multiply(const double* x0, const double* x1, double* y0, double* y1) const {
  kernels_->multiply_two({padded_.data(), rows_, columns_}, x0, x1, y0, y1);
}

void DenseProduct::multiply(std::span<const Index> columns, const double* x, double* y) const {
  const auto count = static_cast<Index>(columns.size());
  if (2 * count > columns_) return multiply(x, y);
  kernels_->multiply_chosen({padded_.data(), rows_, columns_}, columns.data(), count, x, y);
}

}  // namespace butee::linalg
