#include "butee/linalg/kernel/band_product.hpp"

#include <utility>

#include "butee/linalg/kernel/dense.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "butee/linalg/kernel/band_product.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "butee/linalg/kernel/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace butee::linalg::kernel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, kChunk>;
using Register = hn::Vec<Tag>;
constexpr Index kWidth = hn::MaxLanes(Tag());

template <std::size_t band>
struct Diagonals {
  std::array<const double*, band + 1> above, below;

  struct Chunk {
    const Diagonals& all;
    Index i;
    const double* above(std::size_t k) const { return all.above[k] + i; }
    const double* below(std::size_t k) const { return all.below[k] + i; }
  };
  Chunk at(Index i) const { return {*this, i}; }
  /// The chunk of rows `before` places before the last one; it may overlap another.
  Chunk last(Index i, Index) const { return at(i); }
};

/// For chunks stored once for all equal ones.
template <std::size_t band>
struct SharedDiagonals {
  const ChunkTable& chunks;
  Index size;

  struct Chunk {
    const double* values;
    const double* above(std::size_t k) const { return values + k * static_cast<std::size_t>(kChunk); }
    const double* below(std::size_t k) const { return above(band + k); }
  };
  Chunk at(Index i) const { return {chunks[i / kChunk]}; }
  Chunk last(Index, Index before) const { return {chunks[chunks_for(size) + before]}; }
};

#if HWY_TARGET == HWY_AVX3
/// Three consecutive chunks of x, one register each, since every unaligned load would access two
/// cache lines.
class Window {
 public:
  /// Chunks begin at x + i; the first or the last is zero if it lies outside x.
  HWY_INLINE Window(const double* x, Index i, Index size)
      : before_(i > 0 ? hn::LoadU(Tag(), x + i - kChunk) : hn::Zero(Tag())),
        here_(hn::LoadU(Tag(), x + i)),
        next_(i + kChunk < size ? hn::LoadU(Tag(), x + i + kChunk) : hn::Zero(Tag())) {}

  HWY_INLINE void advance(const double* x, Index i) {
    before_ = here_;
    here_ = next_;
    next_ = hn::LoadU(Tag(), x + i + kChunk);
  }

  /// The entries shifted by `shift` places from those of the chunk.
  template <int shift>
  HWY_INLINE Register at(Index) const {
    if constexpr (shift == 0) return here_;
    if constexpr (shift > 0) return joined<shift>(here_, next_);
    if constexpr (shift < 0) return joined<kChunk + shift>(before_, here_);
  }

 private:
  template <int k>
  static HWY_INLINE Register joined(Register low, Register high) {
    return Register{__builtin_shufflevector(low.raw, high.raw, k, k + 1, k + 2, k + 3, k + 4, k + 5, k + 6, k + 7)};
  }

  Register before_, here_, next_;
};
#else
/// The same from memory, with a copy padded by zeros at either end of x.
class Window {
 public:
  HWY_INLINE Window(const double* x, Index i, Index size) : here_(x + i) {
    const bool first = i == 0, last = i + kChunk >= size;
    if (!first && !last) return;
    for (Index k = -kChunk; k < 2 * kChunk; k += kWidth) {
      const bool outside = (k < 0 && first) || (k >= kChunk && last);
      hn::Store(outside ? hn::Zero(Tag()) : hn::LoadU(Tag(), x + i + k), Tag(), copy_ + kChunk + k);
    }
    here_ = copy_ + kChunk;
  }

  HWY_INLINE void advance(const double* x, Index i) { here_ = x + i; }

  template <int shift>
  HWY_INLINE Register at(Index row) const {
    return hn::LoadU(Tag(), here_ + row + shift);
  }

 private:
  HWY_ALIGN double copy_[3 * kChunk];
  const double* here_;
};
#endif

/// A chunk of rows, with two independent sums.
template <class Chunk, std::size_t... k>
HWY_INLINE void multiply_chunk(const Chunk& d, const Window& x, double* y, std::index_sequence<k...>) {
  for (Index row = 0; row < kChunk; row += kWidth) {
    const auto entry = [&](const double* chunk) HWY_ATTR { return hn::LoadU(Tag(), chunk + row); };
    Register sum = hn::Mul(entry(d.above(0)), x.at<0>(row)), other = hn::Zero(Tag());
    ((sum = hn::MulAdd(entry(d.above(k + 1)), x.template at<static_cast<int>(k) + 1>(row), sum),
      other = hn::MulAdd(entry(d.below(k + 1)), x.template at<-static_cast<int>(k) - 1>(row), other)),
     ...);
    hn::StoreU(hn::Add(sum, other), Tag(), y + row);
  }
}

/// x, and the range of rows, have at least three chunks; ranges within the matrix begin and end
/// with whole chunks.
template <std::size_t band, class Stored>
void multiply_chunks(const Stored& d, Rows rows, const double* x, double* y) {
  constexpr auto kDistances = std::make_index_sequence<band>{};
  const Index begin = rows.begin, size = rows.size;
  const Index end = rows.end < size ? rows.end : size - kChunk;
  Index i = begin;
  Window window(x, i, size);
  multiply_chunk(d.at(i), window, y, kDistances);
  for (i += kChunk; i + kChunk <= end; i += kChunk) {
    window.advance(x, i);
    multiply_chunk(d.at(i), window, y + (i - begin), kDistances);
  }
  if (rows.end < size) return;
  // The last rows; some are computed twice.
  for (const Index before : {1, 0}) {
    const Index last = size - (1 + before) * kChunk;
    multiply_chunk(d.last(last, before), Window(x, last, size), y + (last - begin), kDistances);
  }
}

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

/// Systems with fewer rows than three chunks are computed row by row.
constexpr Index kFew = 3 * kChunk;

template <std::size_t band>
void multiply(const BandMatrix& matrix, Rows rows, const double* x, double* y) {
  if (!matrix.chunks.empty()) return multiply_chunks<band>(SharedDiagonals<band>{matrix.chunks, rows.size}, rows, x, y);
  Diagonals<band> diagonals;
  for (std::size_t k = 0; k <= band; ++k) {
    diagonals.above[k] = matrix.above[k];
    diagonals.below[k] = matrix.below[k];
  }
  rows.size < kFew ? multiply_few(diagonals, rows.size, x, y) : multiply_chunks<band>(diagonals, rows, x, y);
}

template <std::size_t... bands>
constexpr std::array<BandProduct, sizeof...(bands)> all_products(std::index_sequence<bands...>) {
  return {&multiply<bands>...};
}

}  // namespace

const std::array<BandProduct, kWidestProduct + 1>* band_product_kernels() {
  static constexpr auto kKernels = all_products(std::make_index_sequence<kWidestProduct + 1>{});
  return &kKernels;
}

}  // namespace butee::linalg::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace butee::linalg::kernel {

BUTEE_KERNELS(band_product_kernels);

const std::array<BandProduct, kWidestProduct + 1>& band_products() {
  return *BUTEE_KERNEL(band_product_kernels)();
}

}  // namespace butee::linalg::kernel
#endif
