#include "butee/solve/symmetric_product.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "butee/core/zeros.hpp"
#include "butee/solve/lanes.hpp"

namespace butee::solve {
namespace {

/// A chain of beams has band 3, one with nodes joined to neighbours a little more.
constexpr std::size_t kWidestBand = kLaneSize;
/// Zeros before the first entry of a stored diagonal.
constexpr Index kPadding = kLaneSize;
/// Up to this size the diagonals below are kept as well, so that every load is aligned; for large matrices reading more
/// memory costs more than that gains.
constexpr Index kInCache = 2048;
/// Doubles of a page, and those by which diagonals of a large matrix are shifted against pages.
constexpr Index kPage = 512, kApart = 17 * kLaneSize;

/// Entries from k places further on in (here, next), or further back in (before, here).
template <int k>
inline void shift_on(const Lane& here, const Lane& next, Lane& to) {
  to = __builtin_shufflevector(here, next, k, k + 1, k + 2, k + 3, k + 4, k + 5, k + 6, k + 7);
}
template <int k>
inline void shift_back(const Lane& before, const Lane& here, Lane& to) {
  to = __builtin_shufflevector(before, here, 8 - k, 9 - k, 10 - k, 11 - k, 12 - k, 13 - k, 14 - k, 15 - k);
}

/// Diagonals in a row: above(k)[i] = A(i, i + k), below(k)[i] = A(i, i - k), zero where there is no such entry.
template <std::size_t band>
struct Diagonals {
  std::array<const double*, band + 1> above, below;

  struct Lanes {
    const Diagonals& all;
    Index i;
    const double* above(std::size_t k) const { return all.above[k] + i; }
    const double* below(std::size_t k) const { return all.below[k] + i; }
  };
  Lanes at(Index i) const { return {*this, i}; }
  /// The last lane of rows but `before`, which may begin within another.
  Lanes last(Index i, Index) const { return at(i); }
};

/// Of lanes that are stored once for all that are equal.
template <std::size_t band>
struct SharedDiagonals {
  const ChunkTable& lanes;
  Index size;

  struct Lanes {
    const double* chunk;
    const double* above(std::size_t k) const { return chunk + k * static_cast<std::size_t>(kLaneSize); }
    const double* below(std::size_t k) const { return above(band + k); }
  };
  Lanes at(Index i) const { return {lanes[i / kLaneSize]}; }
  Lanes last(Index, Index before) const { return {lanes[lanes_for(size) + before]}; }
};

/// Eight rows; before, here and next are lanes of x in a row, the middle one that of the rows.
template <class Lanes, std::size_t... k>
inline void multiply_lane(const Lanes& d, const Lane& before, const Lane& here, const Lane& next, Lane& sum,
                          std::index_sequence<k...>) {
  Lane entry, value, other{};
  load(d.above(0), entry);
  sum = entry * here;
  ((load(d.above(k + 1), entry), shift_on<static_cast<int>(k) + 1>(here, next, value), sum += entry * value,
    load(d.below(k + 1), entry), shift_back<static_cast<int>(k) + 1>(before, here, value), other += entry * value),
   ...);
  sum += other;
}

/// Rows of a product, and the size of all of it.
struct Rows {
  Index begin, end, size;
};

/// All of x, and the rows, are three lanes or more; rows that do not begin or end the matrix do so with whole lanes.
template <std::size_t band, class Stored>
void multiply_lanes(const Stored& d, Rows rows, const double* x, double* y) {
  constexpr auto kDistances = std::make_index_sequence<band>{};
  const Index begin = rows.begin, size = rows.size;
  Lane before{}, here, next, sum;
  const auto row = [&](const auto& lanes, Index i) {
    multiply_lane(lanes, before, here, next, sum, kDistances);
    store(sum, y + (i - begin));
  };
  if (begin > 0) load(x + begin - kLaneSize, before);
  load(x + begin, here);
  const Index end_of_lanes = rows.end < size ? rows.end : size - kLaneSize;
  for (Index i = begin; i + kLaneSize <= end_of_lanes; i += kLaneSize) {
    load(x + i + kLaneSize, next);
    row(d.at(i), i);
    before = here;
    here = next;
  }
  if (rows.end < size) return;
  // The last rows, some of them once more.
  const Index last = size - kLaneSize;
  load(x + last - 2 * kLaneSize, before);
  load(x + last - kLaneSize, here);
  load(x + last, next);
  row(d.last(last - kLaneSize, 1), last - kLaneSize);
  before = here;
  here = next;
  next = Lane{};
  row(d.last(last, 0), last);
}

/// Systems with fewer rows than three lanes are taken row by row.
constexpr Index kFew = 3 * kLaneSize;

template <std::size_t band>
void multiply_few(const Diagonals<band>& d, Index size, const double* x, double* y) {
  for (Index i = 0; i < size; ++i) {
    double sum = d.above[0][i] * x[i];
    for (std::size_t k = 1; k <= band; ++k) {
      const auto distance = static_cast<Index>(k);
      if (i + distance < size) sum += d.above[k][i] * x[i + distance];
      if (i >= distance) sum += d.below[k][i] * x[i - distance];
    }
    y[i] = sum;
  }
}

/// Where the diagonals begin, or the lanes.
struct Stored {
  const double *const *above, *const *below;
  const ChunkTable& lanes;
};

template <std::size_t band>
void multiply_diagonals(const Stored& stored, Rows rows, const double* x, double* y) {
  if (!stored.lanes.empty()) return multiply_lanes<band>(SharedDiagonals<band>{stored.lanes, rows.size}, rows, x, y);
  Diagonals<band> diagonals;
  for (std::size_t k = 0; k <= band; ++k) {
    diagonals.above[k] = stored.above[k];
    diagonals.below[k] = stored.below[k];
  }
  rows.size < kFew ? multiply_few(diagonals, rows.size, x, y) : multiply_lanes<band>(diagonals, rows, x, y);
}

using BandKernel = void (*)(const Stored&, Rows, const double*, double*);

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

SymmetricProduct::SymmetricProduct(const SparseMatrix& matrix)
    : size_(matrix.rows()), first_(size_ > 0 ? matrix.coeff(0, 0) : 0.0) {
  band_ = bandwidth(matrix);
  if (band_ > static_cast<Index>(kWidestBand)) {
    rows_ = &matrix;
    return;
  }
  // Diagonals a multiple of a page apart would compete for the same places of a cache.
  const Index padded = kPadding + lanes_for(size_) * kLaneSize;
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
}

void SymmetricProduct::share_rows() {
  const Index lanes = lanes_for(size_), width = (2 * band_ + 1) * kLaneSize;
  lanes_ = ChunkTable(width, lanes + 2);
  double* to = lanes_.write();
  const double* diagonals = above_.data() + kPadding;
  const auto put = [&](Index begin) {
    for (Index k = -band_; k <= band_; ++k)
      for (Index i = begin; i < begin + kLaneSize; ++i) {
        const Index row = k < 0 ? i + k : i, distance = std::abs(k);
        // Rows behind the last are in the lane of its own alone, which nothing reads.
        const bool is_there = row >= 0 && row + distance < size_;
        to[(k < 0 ? band_ - k : k) * kLaneSize + i - begin] = is_there ? diagonals[distance * stride_ + row] : 0.0;
      }
    to += width;
  };
  for (Index lane = 0; lane < lanes; ++lane) put(lane * kLaneSize);
  put(size_ - kLaneSize);
  put(size_ - 2 * kLaneSize);
  lanes_.share();
  if (lanes_.is_shared())
    above_.resize(0);
  else
    lanes_ = ChunkTable();
}

void SymmetricProduct::multiply(const double* x, Index begin, Index count, double* y) const {
  if (rows_ != nullptr)
    multiply_rows(x, begin, count, y);
  else
    multiply_band(x, begin, count, y);
}

void SymmetricProduct::multiply_band(const double* x, Index begin, Index count, double* y) const {
  static constexpr auto kKernels = band_kernels(std::make_index_sequence<kWidestBand + 1>{});
  std::array<const double*, kWidestBand + 1> above{}, below{};
  for (Index k = 0; k <= band_ && above_.size() > 0; ++k) {
    const double* diagonal = above_.data() + k * stride_ + kPadding;
    above[static_cast<std::size_t>(k)] = diagonal;
    below[static_cast<std::size_t>(k)] = below_.size() == 0 ? diagonal - k : below_.data() + k * stride_;
  }
  kKernels[static_cast<std::size_t>(band_)]({above.data(), below.data(), lanes_}, {begin, begin + count, size_}, x, y);
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

}  // namespace butee::solve
