#include "butee/linalg/symmetric_product.hpp"

#include <algorithm>
#include <array>

#include "butee/core/zeros.hpp"
#include "butee/linalg/kernel/band_product.hpp"
#include "butee/linalg/kernel/dense.hpp"

namespace butee::linalg {
namespace {

using kernel::chunks_for;
using kernel::kChunk;

/// A chain of beams has band 3, one with joined nodes a little more.
constexpr std::size_t kWidestBand = kernel::kWidestProduct;
/// Zeros before the first entry of a stored diagonal.
constexpr Index kPadding = kChunk;
/// Up to this size the diagonals below are stored too, so that every load is aligned; for large
/// matrices the cost of reading more memory exceeds this gain.
constexpr Index kInCache = 2048;
/// Doubles per page, and the offset by which diagonals of a large matrix are shifted relative to
/// pages.
constexpr Index kPage = 512, kApart = 17 * kChunk;

}  // namespace

Index bandwidth(const SparseMatrix& matrix) {
  Index band = 0;
  for (Index j = 0; j < matrix.cols(); ++j)
    if (matrix.outerIndexPtr()[j + 1] > matrix.outerIndexPtr()[j])
      band = std::max(band, j - static_cast<Index>(matrix.innerIndexPtr()[matrix.outerIndexPtr()[j]]));
  return band;
}

SymmetricProduct::SymmetricProduct(const SparseMatrix& matrix, bool is_symmetric)
    : size_(matrix.rows()), first_(size_ > 0 ? matrix.coeff(0, 0) : 0.0) {
  band_ = bandwidth(matrix);
  if (!is_symmetric && (size_ > kInCache || band_ > static_cast<Index>(kWidestBand))) {
    transposed_ = std::make_unique<const SparseMatrix>(matrix.transpose());
    rows_ = transposed_.get();
    return;
  }
  if (band_ > static_cast<Index>(kWidestBand)) {
    rows_ = &matrix;
    return;
  }
  kernel_ = kernel::band_products()[static_cast<std::size_t>(band_)];
  // Diagonals a multiple of a page apart would compete for the same cache sets.
  const Index padded = kPadding + chunks_for(size_) * kChunk;
  stride_ = size_ <= kInCache ? padded : (padded / kPage + 1) * kPage + kApart;
  above_ = zeros((band_ + 1) * stride_);
  for (Index j = 0; j < matrix.cols(); ++j)
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
      if (entry.row() <= j) above_[(j - entry.row()) * stride_ + kPadding + entry.row()] = entry.value();
  if (size_ > kInCache) {
    share_rows();
    return;
  }
  below_ = zeros(above_.size());
  for (Index k = 0; k <= band_; ++k)
    below_.segment(k * stride_, padded - kPadding) = above_.segment(k * stride_ + kPadding - k, padded - kPadding);
  if (is_symmetric) return;
  for (Index j = 0; j < matrix.cols(); ++j)
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
      if (entry.row() > j) below_[(entry.row() - j) * stride_ + entry.row()] = entry.value();
}

void SymmetricProduct::share_rows() {
  const Index chunks = chunks_for(size_), width = (2 * band_ + 1) * kChunk;
  chunks_ = ChunkTable(width, chunks + 2);
  double* to = chunks_.write();
  const double* diagonals = above_.data() + kPadding;
  const auto put = [&](Index begin) {
    for (Index k = -band_; k <= band_; ++k)
      for (Index i = begin; i < begin + kChunk; ++i) {
        const Index row = k < 0 ? i + k : i, distance = std::abs(k);
        // Rows beyond the last occur only in their own chunk, which is never read.
        const bool is_there = row >= 0 && row + distance < size_;
        to[(k < 0 ? band_ - k : k) * kChunk + i - begin] = is_there ? diagonals[distance * stride_ + row] : 0.0;
      }
    to += width;
  };
  for (Index chunk = 0; chunk < chunks; ++chunk) put(chunk * kChunk);
  put(size_ - kChunk);
  put(size_ - 2 * kChunk);
  chunks_.share();
  if (chunks_.is_shared())
    above_.resize(0);
  else
    chunks_ = ChunkTable();
}

void SymmetricProduct::multiply(const double* x, Index begin, Index count, double* y) const {
  if (rows_ != nullptr)
    multiply_rows(x, begin, count, y);
  else
    multiply_band(x, begin, count, y);
}

void SymmetricProduct::multiply_band(const double* x, Index begin, Index count, double* y) const {
  std::array<const double*, kWidestBand + 1> above{}, below{};
  for (Index k = 0; k <= band_ && above_.size() > 0; ++k) {
    const double* diagonal = above_.data() + k * stride_ + kPadding;
    above[static_cast<std::size_t>(k)] = diagonal;
    below[static_cast<std::size_t>(k)] = below_.size() == 0 ? diagonal - k : below_.data() + k * stride_;
  }
  kernel_({above.data(), below.data(), chunks_}, {begin, begin + count, size_}, x, y);
}

void SymmetricProduct::multiply_rows(const double* __restrict x, Index begin, Index count, double* __restrict y) const {
  const int* start = rows_->outerIndexPtr();
  const int* index = rows_->innerIndexPtr();
  const double* value = rows_->valuePtr();
  for (Index i = begin; i < begin + count; ++i) {
    double sum = 0.0;
    for (int k = start[i]; k < start[i + 1]; ++k) sum += value[k] * x[index[k]];
    y[i - begin] = sum;
  }
}

}  // namespace butee::linalg
