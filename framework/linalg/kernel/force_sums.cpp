#include "butee/linalg/kernel/force_sums.hpp"

#include "butee/linalg/kernel/dense.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "butee/linalg/kernel/force_sums.cpp"
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
/// Number of registers processed together, to hide the latency of the sums.
constexpr Index kTogether = kWidth < kChunk ? 2 : 1;

/// Sums of squares: the five terms and the residual.
struct Sums {
  Register term[kTogether][5], residual[kTogether];
};

HWY_INLINE void take(double sign, const double* term, Register& r, Register& squares) {
  const Register piece = hn::LoadU(Tag(), term);
  r = sign > 0.0 ? hn::Add(r, piece) : hn::Sub(r, piece);
  squares = hn::MulAdd(piece, piece, squares);
}

HWY_INLINE void take(double sign, const double* term, double& r, double& square) {
  r += sign * *term;
  square += *term * *term;
}

/// One row, or a register of rows.
template <bool has_load, bool has_contact, bool has_damping, class Piece>
HWY_INLINE void take_all(const ForceTerms& terms, Index i, Piece& r, Piece* squares) {
  if constexpr (has_load) take(1.0, terms.load + i, r, squares[0]);
  if constexpr (has_contact) take(1.0, terms.contact + i, r, squares[1]);
  take(-1.0, terms.inertia + i, r, squares[2]);
  if constexpr (has_damping) take(-1.0, terms.damping + i, r, squares[3]);
  take(-1.0, terms.elastic + i, r, squares[4]);
}

HWY_INLINE double total(const Register* sums, Index stride) {
  Register sum = sums[0];
  for (Index part = 1; part < kTogether; ++part) sum = hn::Add(sum, sums[part * stride]);
  return hn::GetLane(hn::SumOfLanes(Tag(), sum));
}

template <bool has_load, bool has_contact, bool has_damping>
void add(const ForceTerms& terms, Index count, double* residual, std::array<double, 5>& squares,
         double& residual_square) {
  Index i = 0;
  if (count >= kTogether * kWidth) {
    Sums sums;
    for (Index part = 0; part < kTogether; ++part) {
      for (Register& square : sums.term[part]) square = hn::Zero(Tag());
      sums.residual[part] = hn::Zero(Tag());
    }
    for (; i + kTogether * kWidth <= count; i += kTogether * kWidth)
      for (Index part = 0; part < kTogether; ++part) {
        const Index row = i + part * kWidth;
        Register r = hn::Zero(Tag());
        take_all<has_load, has_contact, has_damping>(terms, row, r, sums.term[part]);
        sums.residual[part] = hn::MulAdd(r, r, sums.residual[part]);
        hn::StoreU(r, Tag(), residual + row);
      }
    for (std::size_t k = 0; k < 5; ++k) squares[k] += total(&sums.term[0][k], 5);
    residual_square += total(sums.residual, 1);
  }
  for (; i < count; ++i) {
    double r = 0.0;
    take_all<has_load, has_contact, has_damping>(terms, i, r, squares.data());
    residual_square += r * r;
    residual[i] = r;
  }
}

template <bool has_load, bool has_contact>
void add_with(const ForceTerms& terms, Index count, double* residual, std::array<double, 5>& squares,
              double& residual_square) {
  terms.damping != nullptr ? add<has_load, has_contact, true>(terms, count, residual, squares, residual_square)
                           : add<has_load, has_contact, false>(terms, count, residual, squares, residual_square);
}

void add_any(const ForceTerms& terms, Index count, double* residual, std::array<double, 5>& squares,
             double& residual_square) {
  if (terms.contact != nullptr)
    terms.load != nullptr ? add_with<true, true>(terms, count, residual, squares, residual_square)
                          : add_with<false, true>(terms, count, residual, squares, residual_square);
  else
    terms.load != nullptr ? add_with<true, false>(terms, count, residual, squares, residual_square)
                          : add_with<false, false>(terms, count, residual, squares, residual_square);
}

}  // namespace

AddForces add_forces_kernel() {
  return &add_any;
}

}  // namespace butee::linalg::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace butee::linalg::kernel {

BUTEE_KERNELS(add_forces_kernel);

AddForces add_forces() {
  return BUTEE_KERNEL(add_forces_kernel)();
}

}  // namespace butee::linalg::kernel
#endif
