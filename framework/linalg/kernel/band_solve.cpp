#include "butee/linalg/kernel/band_solve.hpp"

#include <array>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "butee/linalg/kernel/band_solve.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "butee/linalg/kernel/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace butee::linalg::kernel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
/// One entry from the top and one from the bottom.
using Tag = hn::FixedTag<double, 2>;
using Pair = hn::Vec<Tag>;

HWY_INLINE Pair pair_at(const double* pairs, Index i) {
  return hn::LoadU(Tag(), pairs + 2 * i);
}

HWY_INLINE Pair pair_of(const double* from_top, const double* from_bottom) {
  return hn::ConcatLowerLower(Tag(), hn::Set(Tag(), *from_bottom), hn::Set(Tag(), *from_top));
}

HWY_INLINE void put(Pair value, double* from_top, double* from_bottom) {
  *from_top = hn::GetLane(value);
  *from_bottom = hn::GetLane(hn::UpperHalf(hn::Half<Tag>(), value));
}

/// The previous rows, the nearest first.
template <std::size_t band>
struct Recent {
  Pair rows[band];

  HWY_INLINE Recent() {
    for (Pair& row : rows) row = hn::Zero(Tag());
  }

  HWY_INLINE void push(Pair value) {
    for (std::size_t k = band - 1; k > 0; --k) rows[k] = rows[k - 1];
    rows[0] = value;
  }

  /// value - sum over k of entries[k] rows[k - 1], the nearest last, since only it depends on the
  /// previous row.
  HWY_INLINE Pair less(Pair value, const double* entries) const {
    for (std::size_t k = band; k > 0; --k)
      value = hn::NegMulAdd(pair_at(entries, static_cast<Index>(k) - 1), rows[k - 1], value);
    return value;
  }
};

/// The factor of a matrix with this band.
template <Index band>
struct Factor {
  const FactorView& view;

  /// The forward entries of the row that step s eliminates.
  HWY_INLINE const double* forward_of(Index s) const {
    return view.forward[s / kFactorRows] + 2 * band * (s % kFactorRows);
  }

  /// Calls row(s, entries) for all steps, from the ends to the middle.
  template <class Row>
  HWY_INLINE void go_forward(Row& row) const {
    Index s = 0;
    for (Index chunk = 0; s + kFactorRows <= view.steps; ++chunk) {
      const double* entries = view.forward[chunk];
      for (Index i = 0; i < kFactorRows; ++i, ++s, entries += 2 * band) row(s, entries);
    }
    for (; s < view.steps; ++s) row(s, forward_of(s));
  }

  /// The same in the opposite direction.
  template <class Row>
  HWY_INLINE void go_back(Row& row) const {
    constexpr Index kEntries = 2 * (band + 1);
    Index s = view.steps - 1;
    for (; s >= 0 && s % kFactorRows != kFactorRows - 1; --s)
      row(s, view.backward[s / kFactorRows] + kEntries * (s % kFactorRows));
    for (Index chunk = s / kFactorRows; s >= 0; --chunk) {
      const double* entries = view.backward[chunk] + kEntries * (kFactorRows - 1);
      for (Index i = 0; i < kFactorRows; ++i, --s, entries -= kEntries) row(s, entries);
    }
  }
};

/// Subtracts the contribution of the ends from the right side of the middle block and solves there.
template <std::size_t band>
void solve_middle(const Factor<static_cast<Index>(band)>& f, Recent<band> recent, double* x) {
  const Index begin = f.view.steps, end = f.view.size - f.view.steps, count = end - begin;
  for (Index t = 0; t < static_cast<Index>(band); ++t) {
    double from_top = 0.0, from_bottom = 0.0;
    put(recent.less(hn::Zero(Tag()), f.forward_of(begin + t)), &from_top, &from_bottom);
    x[begin + t] += from_top;
    x[end - 1 - t] += from_bottom;
    recent.push(hn::Zero(Tag()));
  }
  double solved[band + 1] = {};
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j) solved[i] += f.view.middle_inverse[i * count + j] * x[begin + j];
  for (Index i = 0; i < count; ++i) x[begin + i] = solved[i];
}

template <std::size_t band>
struct Forward {
  double *x, *mirrored;
  Recent<band> recent;

  HWY_INLINE Forward(double* top, double* bottom) : x(top), mirrored(bottom) {}

  HWY_INLINE void operator()(Index s, const double* entries) {
    const Pair value = recent.less(pair_of(x + s, mirrored - s), entries);
    put(value, x + s, mirrored - s);
    recent.push(value);
  }
};

template <std::size_t band, bool subtracts>
struct Back {
  double *x, *mirrored;
  const Subtrahend& subtrahend;
  Index size;
  Recent<band> recent;

  HWY_INLINE Back(double* top, double* bottom, const Subtrahend& less, Index n)
      : x(top), mirrored(bottom), subtrahend(less), size(n) {}

  HWY_INLINE void operator()(Index s, const double* entries) {
    Pair value = recent.less(hn::Mul(pair_of(x + s, mirrored - s), pair_at(entries, 0)), entries + 2);
    recent.push(value);
    if constexpr (subtracts)
      value = hn::NegMulAdd(hn::Set(Tag(), subtrahend.factor), pair_of(subtrahend.v + s, subtrahend.v + size - 1 - s),
                            value);
    put(value, x + s, mirrored - s);
  }
};

template <std::size_t band, bool subtracts>
void solve(const FactorView& view, double* x, const Subtrahend& less) {
  const Factor<static_cast<Index>(band)> f{view};
  double* mirrored = x + view.size - 1;
  Forward<band> forward(x, mirrored);
  f.go_forward(forward);
  solve_middle<band>(f, forward.recent, x);
  Back<band, subtracts> back(x, mirrored, less, view.size);
  for (std::size_t k = 0; k < band; ++k) {
    const Index row = view.steps + static_cast<Index>(k);
    back.recent.rows[k] = pair_of(x + row, mirrored - row);
  }
  if constexpr (subtracts)
    for (Index i = view.steps; i < view.size - view.steps; ++i) x[i] -= less.factor * less.v[i];
  f.go_back(back);
}

template <bool subtracts, std::size_t... bands>
constexpr std::array<BandSolve, sizeof...(bands)> all_solves(std::index_sequence<bands...>) {
  return {&solve<bands + 1, subtracts>...};
}

}  // namespace

BandSolve band_solve_kernel(Index band, bool subtracts) {
  static constexpr auto kPlain = all_solves<false>(std::make_index_sequence<kWidestFactor>{});
  static constexpr auto kSubtracting = all_solves<true>(std::make_index_sequence<kWidestFactor>{});
  return (subtracts ? kSubtracting : kPlain)[static_cast<std::size_t>(band - 1)];
}

}  // namespace butee::linalg::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace butee::linalg::kernel {

BUTEE_KERNELS(band_solve_kernel);

BandSolve band_solve(Index band, bool subtracts) {
  return BUTEE_KERNEL(band_solve_kernel)(band, subtracts);
}

}  // namespace butee::linalg::kernel
#endif
