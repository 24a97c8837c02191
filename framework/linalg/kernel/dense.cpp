#include "butee/linalg/kernel/dense.hpp"

#include <algorithm>
#include <array>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "butee/linalg/kernel/dense.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "butee/linalg/kernel/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace butee::linalg::kernel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, kChunk>;
using Register = hn::Vec<Tag>;
constexpr std::size_t kWidth = hn::MaxLanes(Tag());

/// The number of sums that stay in registers together with a column and its factors.
constexpr std::size_t kSums = HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_NEON ? 24 : 12;

/// The sums of one vector for a range of rows.
struct Part {
  const double* values;  ///< from the first row
  Index stride;
  double* y;
  std::size_t rows;  ///< less than the registers hold at the end of the matrix
};

template <std::size_t registers>
HWY_INLINE void put(const Register* sums, double* y, std::size_t rows) {
  for (std::size_t i = 0; i + 1 < registers; ++i) hn::StoreU(sums[i], Tag(), y + i * kWidth);
  constexpr std::size_t kLast = (registers - 1) * kWidth;
  if (rows == registers * kWidth) return hn::StoreU(sums[registers - 1], Tag(), y + kLast);
  HWY_ALIGN double last[kWidth];
  hn::Store(sums[registers - 1], Tag(), last);
  for (std::size_t i = kLast; i < rows; ++i) y[i] = last[i - kLast];
}

template <std::size_t registers, bool chosen>
void multiply_part(const Part& part, const Index* columns, Index count, const double* x) {
  Register sums[registers];
  for (std::size_t i = 0; i < registers; ++i) sums[i] = hn::Zero(Tag());
  for (Index k = 0; k < count; ++k) {
    const Index j = chosen ? columns[k] : k;
    const double* column = part.values + j * part.stride;
    const Register factor = hn::Set(Tag(), x[j]);
    for (std::size_t i = 0; i < registers; ++i)
      sums[i] = hn::MulAdd(hn::Load(Tag(), column + i * kWidth), factor, sums[i]);
  }
  put<registers>(sums, part.y, part.rows);
}

template <std::size_t registers>
void multiply_two_part(const Part& part, double* y1, Index count, const double* x0, const double* x1) {
  Register first[registers], second[registers];
  for (std::size_t i = 0; i < registers; ++i) first[i] = second[i] = hn::Zero(Tag());
  for (Index j = 0; j < count; ++j) {
    const double* column = part.values + j * part.stride;
    const Register factor0 = hn::Set(Tag(), x0[j]), factor1 = hn::Set(Tag(), x1[j]);
    for (std::size_t i = 0; i < registers; ++i) {
      const Register entries = hn::Load(Tag(), column + i * kWidth);
      first[i] = hn::MulAdd(entries, factor0, first[i]);
      second[i] = hn::MulAdd(entries, factor1, second[i]);
    }
  }
  put<registers>(first, part.y, part.rows);
  put<registers>(second, y1, part.rows);
}

using OnePart = void (*)(const Part&, const Index*, Index, const double*);
using TwoParts = void (*)(const Part&, double*, Index, const double*, const double*);

template <bool chosen, std::size_t... registers>
constexpr std::array<OnePart, sizeof...(registers)> one_kernels(std::index_sequence<registers...>) {
  return {&multiply_part<registers + 1, chosen>...};
}
template <std::size_t... registers>
constexpr std::array<TwoParts, sizeof...(registers)> two_kernels(std::index_sequence<registers...>) {
  return {&multiply_two_part<registers + 1>...};
}

/// Calls part(registers, first row, rows) for equal parts of all rows, each of at most `most`
/// registers.
template <class Call>
HWY_INLINE void in_parts(Index all_rows, std::size_t most, const Call& call) {
  const auto rows = static_cast<std::size_t>(all_rows);
  const std::size_t all = (rows + kWidth - 1) / kWidth;
  if (all <= most) return call(all, 0, rows);
  const std::size_t parts = (all + most - 1) / most;
  for (std::size_t p = 0; p < parts; ++p) {
    const std::size_t begin = all * p / parts, end = all * (p + 1) / parts;
    call(end - begin, begin * kWidth, std::min(rows, end * kWidth) - begin * kWidth);
  }
}

constexpr std::size_t kMostOfOne = kSums < 12 ? kSums : 12;

template <bool chosen>
struct One {
  const DenseMatrix& matrix;
  const Index* columns;
  Index count;
  const double* x;
  double* y;
  HWY_INLINE void operator()(std::size_t registers, std::size_t begin, std::size_t rows) const {
    static constexpr auto kParts = one_kernels<chosen>(std::make_index_sequence<kMostOfOne>{});
    kParts[registers - 1]({matrix.values + begin, matrix.stride(), y + begin, rows}, columns, count, x);
  }
};

struct Two {
  const DenseMatrix& matrix;
  const double *x0, *x1;
  double *y0, *y1;
  HWY_INLINE void operator()(std::size_t registers, std::size_t begin, std::size_t rows) const {
    static constexpr auto kParts = two_kernels(std::make_index_sequence<kSums / 2>{});
    kParts[registers - 1]({matrix.values + begin, matrix.stride(), y0 + begin, rows}, y1 + begin, matrix.columns, x0,
                          x1);
  }
};

void multiply(const DenseMatrix& matrix, const double* x, double* y) {
  in_parts(matrix.rows, kMostOfOne, One<false>{matrix, nullptr, matrix.columns, x, y});
}

void multiply_chosen(const DenseMatrix& matrix, const Index* columns, Index count, const double* x, double* y) {
  in_parts(matrix.rows, kMostOfOne, One<true>{matrix, columns, count, x, y});
}

void multiply_two(const DenseMatrix& matrix, const double* x0, const double* x1, double* y0, double* y1) {
  in_parts(matrix.rows, kSums / 2, Two{matrix, x0, x1, y0, y1});
}

}  // namespace

const Dense* dense_kernels() {
  static constexpr Dense kKernels = {&multiply, &multiply_chosen, &multiply_two};
  return &kKernels;
}

}  // namespace butee::linalg::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace butee::linalg::kernel {

BUTEE_KERNELS(dense_kernels);

const Dense& dense() {
  return *BUTEE_KERNEL(dense_kernels)();
}

}  // namespace butee::linalg::kernel
#endif
