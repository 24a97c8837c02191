#include "butee/solve/symmetric_product.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace butee::solve {
namespace {

/// A chain of beams has band 3, one with nodes joined to neighbours a little more.
constexpr std::size_t kWidestBand = 8;
/// One row near an end, where diagonals run out.
double end_row(const double* const* d, Index band, Index size, const double* x, Index i) {
  double sum = d[0][i] * x[i];
  for (Index k = 1; k <= band; ++k) {
    if (i + k < size) sum += d[k][i] * x[i + k];
    if (i >= k) sum += d[k][i - k] * x[i - k];
  }
  return sum;
}

template <std::size_t band>
void multiply_diagonals(const double* const* d, Index size, const double* __restrict x, double* __restrict y) {
  constexpr auto kBand = static_cast<Index>(band);
  const Index inner_begin = std::min(kBand, size), inner_end = std::max(inner_begin, size - kBand);
  for (Index i = 0; i < inner_begin; ++i) y[i] = end_row(d, kBand, size, x, i);
  for (Index i = inner_begin; i < inner_end; ++i) {
    double sum = d[0][i] * x[i];
    for (Index k = 1; k <= kBand; ++k) sum += d[k][i] * x[i + k] + d[k][i - k] * x[i - k];
    y[i] = sum;
  }
  for (Index i = inner_end; i < size; ++i) y[i] = end_row(d, kBand, size, x, i);
}

using BandKernel = void (*)(const double* const*, Index, const double*, double*);

template <std::size_t... bands>
constexpr std::array<BandKernel, sizeof...(bands)> band_kernels(std::index_sequence<bands...>) {
  return {&multiply_diagonals<bands>...};
}

}  // namespace

Index bandwidth(const SparseMatrix& matrix) {
  Index band = 0;
  for (Index j = 0; j < matrix.cols(); ++j)
    if (matrix.outerIndexPtr()[j + 1] > matrix.outerIndexPtr()[j])
      band = std::max(band, j - static_cast<Index>(matrix.innerIndexPtr()[matrix.outerIndexPtr()[j]]));
  return band;
}

SymmetricProduct::SymmetricProduct(const SparseMatrix& matrix) : size_(matrix.rows()) {
  const Index band = bandwidth(matrix);
  if (band > static_cast<Index>(kWidestBand)) {
    rows_ = &matrix;
    return;
  }
  for (Index k = 0; k <= band; ++k) diagonals_.push_back(Vector::Zero(size_ - std::min(k, size_)));
  for (Index j = 0; j < matrix.cols(); ++j)
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
      if (entry.row() <= j) diagonals_[static_cast<std::size_t>(j - entry.row())][entry.row()] = entry.value();
}

void SymmetricProduct::multiply(const double* x, double* y) const {
  if (rows_ != nullptr)
    multiply_rows(x, y);
  else
    multiply_band(x, y);
}

void SymmetricProduct::multiply_band(const double* x, double* y) const {
  constexpr auto kKernels = band_kernels(std::make_index_sequence<kWidestBand + 1>{});
  std::array<const double*, kWidestBand + 1> diagonals{};
  for (std::size_t k = 0; k < diagonals_.size(); ++k) diagonals[k] = diagonals_[k].data();
  kKernels[diagonals_.size() - 1](diagonals.data(), size_, x, y);
}

void SymmetricProduct::multiply_rows(const double* __restrict x, double* __restrict y) const {
  const int* start = rows_->outerIndexPtr();
  const int* index = rows_->innerIndexPtr();
  const double* value = rows_->valuePtr();
  for (Index i = 0; i < size_; ++i) {
    double sum = 0.0;
    for (int k = start[i]; k < start[i + 1]; ++k) sum += value[k] * x[index[k]];
    y[i] = sum;
  }
}

}  // namespace butee::solve
