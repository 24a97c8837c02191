#include "butee/solve/dense_product.hpp"

#include <array>
#include <utility>

#include "butee/core/error.hpp"
#include "butee/solve/lanes.hpp"

namespace butee::solve {
namespace {

constexpr std::size_t kMostLanes = DenseProduct::kMostRows / kLaneSize;

template <std::size_t lanes>
inline void add_column(const double* matrix, Index j, double factor, std::array<Lane, lanes>& sums) {
  const auto* column = reinterpret_cast<const Lane*>(matrix + j * static_cast<Index>(lanes) * kLaneSize);
  for (std::size_t i = 0; i < lanes; ++i) sums[i] += column[i] * factor;
}

template <std::size_t lanes>
inline void put(const std::array<Lane, lanes>& sums, double* y, std::size_t rows) {
  for (std::size_t i = 0; i + 1 < lanes; ++i) store(sums[i], y + i * static_cast<std::size_t>(kLaneSize));
  for (std::size_t i = (lanes - 1) * static_cast<std::size_t>(kLaneSize), k = 0; i < rows; ++i, ++k)
    y[i] = sums[lanes - 1][k];
}

struct Chosen {
  static constexpr auto pick = [](const Index* columns, Index j) { return columns[j]; };
};
struct All {
  static constexpr auto pick = [](const Index*, Index j) { return j; };
};

/// y := the sum of `count` columns times their entries of x.
template <std::size_t lanes, class Columns>
void multiply_lanes(const double* matrix, const Index* columns, Index count, const double* x, double* y,
                    std::size_t rows) {
  std::array<Lane, lanes> sums{};
  for (Index k = 0; k < count; ++k) {
    const Index j = Columns::pick(columns, k);
    add_column(matrix, j, x[j], sums);
  }
  put(sums, y, rows);
}

template <std::size_t lanes>
void multiply_two(const double* matrix, Index count, const double* x0, const double* x1, double* y0, double* y1,
                  std::size_t rows) {
  std::array<Lane, lanes> first{}, second{};
  for (Index j = 0; j < count; ++j) {
    const auto* column = reinterpret_cast<const Lane*>(matrix + j * static_cast<Index>(lanes) * kLaneSize);
    for (std::size_t i = 0; i < lanes; ++i) {
      first[i] += column[i] * x0[j];
      second[i] += column[i] * x1[j];
    }
  }
  put(first, y0, rows);
  put(second, y1, rows);
}

using OneKernel = void (*)(const double*, const Index*, Index, const double*, double*, std::size_t);

template <class Columns, std::size_t... lanes>
constexpr std::array<OneKernel, sizeof...(lanes)> one_kernels(std::index_sequence<lanes...>) {
  return {&multiply_lanes<lanes + 1, Columns>...};
}

using TwoKernel = void (*)(const double*, Index, const double*, const double*, double*, double*, std::size_t);

template <std::size_t... lanes>
constexpr std::array<TwoKernel, sizeof...(lanes)> two_kernels(std::index_sequence<lanes...>) {
  return {&multiply_two<lanes + 1>...};
}

constexpr auto kTwo = two_kernels(std::make_index_sequence<kMostLanes>{});
constexpr auto kAll = one_kernels<All>(std::make_index_sequence<kMostLanes>{});
constexpr auto kChosen = one_kernels<Chosen>(std::make_index_sequence<kMostLanes>{});

}  // namespace

DenseProduct::DenseProduct(const Eigen::MatrixXd& matrix)
    : rows_(matrix.rows()), columns_(matrix.cols()), lanes_(lanes_for(matrix.rows())) {
  require(rows_ >= 1 && rows_ <= kMostRows, "a dense product is for small matrices");
  padded_ = Eigen::MatrixXd::Zero(lanes_ * kLaneSize, columns_);
  padded_.topRows(rows_) = matrix;
}

void DenseProduct::multiply(const double* x, double* y) const {
  kAll[static_cast<std::size_t>(lanes_ - 1)](padded_.data(), nullptr, columns_, x, y, static_cast<std::size_t>(rows_));
}

void DenseProduct::multiply(const double* x0, const double* x1, double* y0, double* y1) const {
  kTwo[static_cast<std::size_t>(lanes_ - 1)](padded_.data(), columns_, x0, x1, y0, y1, static_cast<std::size_t>(rows_));
}

void DenseProduct::multiply(std::span<const Index> columns, const double* x, double* y) const {
  if (2 * static_cast<Index>(columns.size()) > columns_) return multiply(x, y);
  kChosen[static_cast<std::size_t>(lanes_ - 1)](padded_.data(), columns.data(), static_cast<Index>(columns.size()), x,
                                                y, static_cast<std::size_t>(rows_));
}

}  // namespace butee::solve
