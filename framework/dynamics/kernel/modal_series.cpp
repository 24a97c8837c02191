#include "butee/dynamics/kernel/modal_series.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "butee/dynamics/kernel/modal_series.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "butee/linalg/kernel/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace butee::dynamics::kernel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, kChunk>;
using Register = hn::Vec<Tag>;
constexpr std::size_t kWidth = hn::MaxLanes(Tag());

HWY_INLINE Register all(double value) {
  return hn::Set(Tag(), value);
}

/// The series of a forcing in t/h: coefficients 0 to last.
struct Forcing {
  Register terms[kTerms];
  int last;
};

/// y(h) and y'(h) of y'' + 2 delta y' + omega^2 y = forcing, at rest at t = 0.
struct Response {
  Register q, v;
};

struct Oscillator {
  double h;
  Register damping, stiffness;  ///< 2 delta h, omega^2 h^2

  HWY_INLINE void respond(const Forcing& forcing, Response& to) const {
    Register before = hn::Zero(Tag()), latest = before;  // y_k, y_{k+1}
    to.q = to.v = before;
    for (int k = 0; k + 2 <= kTerms; ++k) {
      Register next = hn::MulAdd(hn::Mul(damping, latest), all(k + 1), hn::Mul(stiffness, before));
      next = k <= forcing.last ? hn::MulSub(all(h * h), forcing.terms[k], next) : hn::Neg(next);
      next = hn::Mul(next, all(kDivisors[static_cast<std::size_t>(k)]));
      to.q = hn::Add(to.q, next);
      to.v = hn::MulAdd(all(k + 2), next, to.v);
      before = latest;
      latest = next;
    }
    to.v = hn::Mul(to.v, all(1.0 / h));
  }
};

/// The columns of a propagator, those of one register.
struct Columns {
  Values* values;
  std::size_t begin;
  HWY_INLINE void put(std::size_t column, Register value) const {
    hn::StoreU(value, Tag(), values[column].data() + begin);
  }
};

/// Free motion by its departure from q = 1 at rest, and from uniform motion with v = 1.
HWY_INLINE void put_free(const Oscillator& of, Register frequency, Register decay, const Columns& to) {
  const Register square = hn::Mul(frequency, frequency);
  Forcing forcing;
  Response from_q, from_v;
  forcing.last = 0;
  forcing.terms[0] = hn::Neg(square);
  of.respond(forcing, from_q);
  forcing.last = 1;
  forcing.terms[0] = hn::Mul(all(-2.0), decay);
  forcing.terms[1] = hn::Mul(hn::Neg(square), all(of.h));
  of.respond(forcing, from_v);
  to.put(0, hn::Add(all(1.0), from_q.q));
  to.put(1, hn::Add(all(of.h), from_v.q));
  to.put(2, from_q.v);
  to.put(3, hn::Add(all(1.0), from_v.v));
}

/// P_0, P_1 and P_2 from powers of t/h.
HWY_INLINE void put_legendre(std::size_t column, Register p0, Register p1, Register p2, const Columns& to) {
  to.put(column, p0);
  to.put(column + 2, hn::MulSub(all(2.0), p1, p0));
  to.put(column + 4, hn::Add(hn::MulSub(all(6.0), p2, hn::Mul(all(6.0), p1)), p0));
}

HWY_INLINE void put_forces(const Oscillator& of, const Columns& to) {
  Response power[3];
  for (int k = 0; k < 3; ++k) {
    Forcing forcing;
    for (Register& term : forcing.terms) term = hn::Zero(Tag());
    forcing.terms[k] = all(1.0);
    forcing.last = k;
    of.respond(forcing, power[k]);
  }
  put_legendre(4, power[0].q, power[1].q, power[2].q, to);
  put_legendre(5, power[0].v, power[1].v, power[2].v, to);
}

/// cosine - i sine, turned.
HWY_INLINE void put_harmonic(const Oscillator& of, const HarmonicSeries& load, std::size_t column, const Columns& to) {
  const Register cosine = hn::LoadU(Tag(), load.cosine.data() + to.begin),
                 sine = hn::LoadU(Tag(), load.sine.data() + to.begin);
  Forcing real, imaginary;
  real.last = imaginary.last = kTerms;
  for (std::size_t k = 0; k < kTerms; ++k) {
    const Register re = all(load.turn[k].real()), im = all(load.turn[k].imag());
    real.terms[k] = hn::MulAdd(re, cosine, hn::Mul(im, sine));
    imaginary.terms[k] = hn::MulSub(im, cosine, hn::Mul(re, sine));
  }
  Response response;
  of.respond(real, response);
  to.put(column, response.q);
  to.put(column + 1, response.v);
  of.respond(imaginary, response);
  to.put(column + 2, response.q);
  to.put(column + 3, response.v);
}

void sum_all(const ModalSeries& modes, std::span<const HarmonicSeries> loads, Values* columns) {
  for (std::size_t begin = 0; begin < static_cast<std::size_t>(kChunk); begin += kWidth) {
    const Register frequency = hn::LoadU(Tag(), modes.frequency.data() + begin),
                   decay = hn::LoadU(Tag(), modes.decay.data() + begin);
    const double h = modes.h;
    const Oscillator of{h, hn::Mul(all(2.0 * h), decay), hn::Mul(all(h * h), hn::Mul(frequency, frequency))};
    const Columns to{columns, begin};
    put_free(of, frequency, decay, to);
    put_forces(of, to);
    std::size_t column = 10;
    for (const HarmonicSeries& load : loads) {
      put_harmonic(of, load, column, to);
      column += 4;
    }
  }
}

}  // namespace

SumSeries sum_series_kernel() {
  return &sum_all;
}

}  // namespace butee::dynamics::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace butee::dynamics::kernel {

BUTEE_KERNELS(sum_series_kernel);

SumSeries sum_series() {
  return BUTEE_KERNEL(sum_series_kernel)();
}

}  // namespace butee::dynamics::kernel
#endif
