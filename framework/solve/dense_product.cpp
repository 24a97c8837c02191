#include "butee/solve/dense_product.hpp"

#include <array>
#include <cstring>
#include <utility>

#include "butee/core/error.hpp"

namespace butee::solve {
namespace {

/// Eight doubles, which the compiler maps to the registers there are.
using Lane = double __attribute__((vector_size(64)));
constexpr Index kLaneSize = 8;
constexpr std::size_t kMostLanes = DenseProduct::kMostRows / kLaneSize;

template <std::size_t lanes>
void multiply_lanes(const double* matrix, Index columns, const double* x, double* y, std::size_t rows) {
  std::array<Lane, lanes> sums{};
  for (Index j = 0; j < columns; ++j) {
    const auto* column = reinterpret_cast<const Lane*>(matrix + j * static_cast<Index>(lanes) * kLaneSize);
    for (std::size_t i = 0; i < lanes; ++i) sums[i] += column[i] * x[j];
  }
  std::memcpy(y, sums.data(), rows * sizeof(double));
}

using Kernel = void (*)(const double*, Index, const double*, double*, std::size_t);

template <std::size_t... lanes>
constexpr std::array<Kernel, sizeof...(lanes)> kernels(std::index_sequence<lanes...>) {
  return {&multiply_lanes<lanes + 1>...};
}

constexpr auto kKernels = kernels(std::make_index_sequence<kMostLanes>{});

}  // namespace

DenseProduct::DenseProduct(const Eigen::MatrixXd& matrix)
    : rows_(matrix.rows()), columns_(matrix.cols()), lanes_((matrix.rows() + kLaneSize - 1) / kLaneSize) {
  require(rows_ >= 1 && rows_ <= kMostRows, "a dense product is for small matrices");
  padded_ = Eigen::MatrixXd::Zero(lanes_ * kLaneSize, columns_);
  padded_.topRows(rows_) = matrix;
}

void DenseProduct::multiply(const double* x, double* y) const {
  kKernels[static_cast<std::size_t>(lanes_ - 1)](padded_.data(), columns_, x, y, static_cast<std::size_t>(rows_));
}

}  // namespace butee::solve
