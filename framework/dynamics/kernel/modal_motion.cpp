#include "butee/dynamics/kernel/modal_motion.hpp"

#include <cmath>

#include "butee/dynamics/kernel/modal_series.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "butee/dynamics/kernel/modal_motion.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// Must follow highway.h.
#include <hwy/contrib/math/math-inl.h>

#include "butee/linalg/kernel/dispatch.hpp"

HWY_BEFORE_NAMESPACE();
namespace butee::dynamics::kernel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, static_cast<std::size_t>(kModesAtOnce)>;
using Register = hn::Vec<Tag>;
constexpr Index kWidth = hn::MaxLanes(Tag());

HWY_INLINE Register all(double value) {
  return hn::Set(Tag(), value);
}
HWY_INLINE Register load(const double* from, Index i) {
  return hn::LoadU(Tag(), from + i);
}
HWY_INLINE void store(Register value, double* to, Index i) {
  hn::StoreU(value, Tag(), to + i);
}

struct Moved {
  Register q, v;
};

HWY_INLINE Moved kept_up(const KeptUp* kept, Index loads, Index i) {
  Moved sum = {hn::Zero(Tag()), hn::Zero(Tag())};
  for (const KeptUp* load_of = kept; load_of != kept + loads; ++load_of) {
    const Register c = load(load_of->cosine, i), s = load(load_of->sine, i), of_c = all(load_of->of_cosine),
                   of_s = all(load_of->of_sine);
    sum.q = hn::MulAdd(of_c, c, hn::MulAdd(of_s, s, sum.q));
    sum.v = hn::MulAdd(all(load_of->angular_frequency), hn::MulSub(of_c, s, hn::Mul(of_s, c)), sum.v);
  }
  return sum;
}

void start_all(const ModesInMotion& modes, const double* q, const double* v, const KeptUp* kept, Index loads) {
  for (Index i = 0; i < modes.count; i += kWidth) {
    const Moved sum = kept_up(kept, loads, i);
    store(hn::Sub(load(q, i), sum.q), modes.q, i);
    store(hn::Sub(load(v, i), sum.v), modes.v, i);
  }
}

void lead_all(const ModesInMotion& modes, const double* const* moments, double r) {
  for (Index i = 0; i < modes.count; i += kWidth) {
    Register force[3] = {load(modes.force[0], i), load(modes.force[1], i), load(modes.force[2], i)};
    if (moments != nullptr) {
      const Register m0 = load(moments[0], i), m1 = load(moments[1], i), m2 = load(moments[2], i);
      force[0] = hn::Add(force[0], hn::Add(hn::Sub(m0, m1), m2));
      force[1] = hn::MulAdd(all(r), hn::NegMulAdd(all(6.0), m2, hn::Add(m1, m1)), force[1]);
      force[2] = hn::MulAdd(all(6.0 * r * r), m2, force[2]);
      for (int k = 0; k < 3; ++k) store(force[k], modes.force[k], i);
    }
    const Register compliance = load(modes.compliance, i), decay = load(modes.decay, i);
    const Register led2 = hn::Mul(force[2], compliance),
                   led1 = hn::Mul(hn::NegMulAdd(hn::Mul(all(4.0), decay), led2, force[1]), compliance),
                   led0 = hn::Mul(hn::NegMulAdd(hn::Add(decay, decay), led1, hn::NegMulAdd(all(2.0), led2, force[0])),
                                  compliance);
    const Register cosine = hn::Sub(load(modes.q, i), led0);
    store(led0, modes.led[0], i);
    store(led1, modes.led[1], i);
    store(led2, modes.led[2], i);
    store(cosine, modes.cosine, i);
    store(hn::Div(hn::MulAdd(decay, cosine, hn::Sub(load(modes.v, i), led1)), load(modes.frequency, i)), modes.sine, i);
  }
}

/// y'' + 2 delta y' + omega^2 y = f as a series in s = time/t, term by term, for several registers
/// at a time, so that their independent chains of terms overlap.
template <Index Together>
HWY_INLINE void by_series(const ModesInMotion& modes, double t, int terms, Index begin, Moved* to) {
  const double power[] = {t * t, t * t * t, t * t * t * t};
  Register damping[Together], stiffness[Together], before[Together], latest[Together];
  for (Index j = 0; j < Together; ++j) {
    const Index i = begin + j * kWidth;
    damping[j] = hn::Mul(all(2.0 * t), load(modes.decay, i));
    stiffness[j] = hn::Mul(all(t * t), load(modes.square, i));
    before[j] = load(modes.q, i);
    latest[j] = hn::Mul(all(t), load(modes.v, i));
    to[j] = {hn::Add(before[j], latest[j]), latest[j]};
  }
  for (int k = 0; k + 2 <= terms; ++k) {
    const Register divisor = all(kDivisors[static_cast<std::size_t>(k)]), factor = all(k + 1), next_factor = all(k + 2);
    for (Index j = 0; j < Together; ++j) {
      Register next = hn::MulAdd(hn::Mul(damping[j], latest[j]), factor, hn::Mul(stiffness[j], before[j]));
      next = k < 3 ? hn::MulSub(all(power[k]), load(modes.force[k], begin + j * kWidth), next) : hn::Neg(next);
      next = hn::Mul(next, divisor);
      to[j].q = hn::Add(to[j].q, next);
      to[j].v = hn::MulAdd(next_factor, next, to[j].v);
      before[j] = latest[j];
      latest[j] = next;
    }
  }
  for (Index j = 0; j < Together; ++j) to[j].v = hn::Mul(to[j].v, all(1.0 / t));
}

/// `size`: e^(-delta t) if it is the same for all modes.
template <bool has_single_decay>
HWY_INLINE Moved in_closed_form(const ModesInMotion& modes, double t, double size, Index i) {
  const Register decay = load(modes.decay, i), frequency = load(modes.frequency, i);
  const Register a = load(modes.cosine, i), b = load(modes.sine, i), angle = hn::Mul(frequency, all(t));
  Register decayed = all(size);
  if constexpr (!has_single_decay) decayed = hn::Exp(Tag(), hn::Mul(decay, all(-t)));
  const Register cosine = hn::Mul(decayed, hn::Cos(Tag(), angle)), sine = hn::Mul(decayed, hn::Sin(Tag(), angle));
  const Register of_cosine = hn::NegMulAdd(decay, a, hn::Mul(b, frequency)),
                 of_sine = hn::MulAdd(decay, b, hn::Mul(a, frequency));
  const Register led2 = load(modes.led[2], i), led1 = load(modes.led[1], i);
  const Register q = hn::MulAdd(all(t), hn::MulAdd(all(t), led2, led1), load(modes.led[0], i)),
                 v = hn::MulAdd(all(2.0 * t), led2, led1);
  return {hn::MulAdd(a, cosine, hn::MulAdd(b, sine, q)),
          hn::NegMulAdd(of_sine, sine, hn::MulAdd(of_cosine, cosine, v))};
}

HWY_INLINE Moved as_suits(const ModesInMotion& modes, double t, int terms, Index i) {
  Moved slow;
  by_series<1>(modes, t, terms, i, &slow);
  const Moved fast = in_closed_form<false>(modes, t, 1.0, i);
  const Register rate = hn::Add(hn::Sqrt(load(modes.square, i)), load(modes.decay, i));
  const auto is_slow = hn::Le(hn::Mul(rate, all(t)), all(kSlow));
  return {hn::IfThenElse(is_slow, slow.q, fast.q), hn::IfThenElse(is_slow, slow.v, fast.v)};
}

void move_all(const ModesInMotion& modes, double t, const Speeds& speeds, const KeptUp* kept, Index loads, double* q,
              double* v) {
  const auto put = [&](Index i, const Moved& moved) {
    const Moved sum = kept_up(kept, loads, i);
    store(hn::Add(moved.q, sum.q), q, i);
    store(hn::Add(moved.v, sum.v), v, i);
  };
  constexpr Index kTogether = 4;
  Index i = 0;
  for (; i + kTogether * kWidth <= speeds.slow; i += kTogether * kWidth) {
    Moved moved[kTogether];
    by_series<kTogether>(modes, t, speeds.terms, i, moved);
    for (Index j = 0; j < kTogether; ++j) put(i + j * kWidth, moved[j]);
  }
  for (; i < speeds.slow; i += kWidth) {
    Moved moved;
    by_series<1>(modes, t, speeds.terms, i, &moved);
    put(i, moved);
  }
  for (; i < speeds.fast; i += kWidth) put(i, as_suits(modes, t, kTerms, i));
  if (modes.single_decay >= 0.0) {
    const double size = std::exp(-modes.single_decay * t);
    for (; i < modes.count; i += kWidth) put(i, in_closed_form<true>(modes, t, size, i));
  } else {
    for (; i < modes.count; i += kWidth) put(i, in_closed_form<false>(modes, t, 1.0, i));
  }
}

Products multiply_all(Index count, const double* shape, const double* weight, const double* q, const double* v) {
  Register of_q = hn::Zero(Tag()), of_v = of_q, weighted = of_q;
  for (Index i = 0; i < count; i += kWidth) {
    const Register place = load(q, i), part = load(shape, i);
    of_q = hn::MulAdd(part, place, of_q);
    of_v = hn::MulAdd(part, load(v, i), of_v);
    weighted = hn::MulAdd(load(weight, i), place, weighted);
  }
  const auto sum = [](Register lanes) { return hn::GetLane(hn::SumOfLanes(Tag(), lanes)); };
  return {sum(of_q), sum(of_v), sum(weighted)};
}

HWY_INLINE void turn_register(const double* decay, const double* turn, double t, double* re, double* im) {
  const Register size = hn::Exp(Tag(), hn::Mul(load(decay, 0), all(t))), angle = hn::Mul(load(turn, 0), all(t));
  store(hn::Mul(size, hn::Cos(Tag(), angle)), re, 0);
  store(hn::Mul(size, hn::Sin(Tag(), angle)), im, 0);
}

void turn_all(Index count, const double* decay, const double* turn, double t, double* re, double* im) {
  Index i = 0;
  for (; i + kWidth <= count; i += kWidth) turn_register(decay + i, turn + i, t, re + i, im + i);
  if (i == count) return;
  double rest[4][kWidth] = {};
  for (Index k = i; k < count; ++k) {
    rest[0][k - i] = decay[k];
    rest[1][k - i] = turn[k];
  }
  turn_register(rest[0], rest[1], t, rest[2], rest[3]);
  for (Index k = i; k < count; ++k) {
    re[k] = rest[2][k - i];
    im[k] = rest[3][k - i];
  }
}

const ModalMotionKernels kAll = {&start_all, &lead_all, &move_all, &multiply_all, &turn_all};

}  // namespace

const ModalMotionKernels* modal_motion_kernels() {
  return &kAll;
}

}  // namespace butee::dynamics::kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace butee::dynamics::kernel {

BUTEE_KERNELS(modal_motion_kernels);

const ModalMotionKernels& modal_motion() {
  return *BUTEE_KERNEL(modal_motion_kernels)();
}

}  // namespace butee::dynamics::kernel
#endif
