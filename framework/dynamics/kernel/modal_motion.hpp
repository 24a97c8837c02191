#pragma once

#include "butee/core/types.hpp"

namespace butee::dynamics::kernel {

/// Arrays of modes hold whole registers of any instruction set.
inline constexpr Index kModesAtOnce = 8;

/// The motion that a harmonic load keeps up by itself, cosine cos(angle) + sine sin(angle).
struct KeptUp {
  double angular_frequency;
  const double *cosine, *sine;
  double of_cosine, of_sine;  ///< cos and sin of its angle
};

/// Modes in a step: y'' + 2 delta y' + omega^2 y = f_0 + f_1 t + f_2 t^2, with what follows from the start of the step.
struct ModesInMotion {
  Index count;                                            ///< in whole registers
  const double *square, *compliance, *decay, *frequency;  ///< omega^2, 1/omega^2, delta, omega_d
  double single_decay;                                    ///< of all modes alike; negative where they differ
  double *q, *v;                                          ///< at the start, without what is kept up
  double* force[3];
  double* led[3];         ///< the polynomial that the force leads to
  double *cosine, *sine;  ///< of the decaying oscillation about it
};

/// Fills q and v from those at the start, less what `kept` holds up.
using StartModes = void (*)(const ModesInMotion&, const double* q, const double* v, const KeptUp* kept, Index loads);
/// Adds to the force moments[k] P_k over a time of 1/r, if there are any, and fills led, cosine and sine.
using LeadModes = void (*)(const ModesInMotion&, const double* const* moments, double r);

/// Registers whose modes are moved by Taylor series, those after them by what suits each mode, and from `fast` on in
/// closed form. `terms` of the series are needed.
struct Speeds {
  Index slow, fast;
  int terms;
};
/// Up to this (omega + delta) t a Taylor series is taken, beyond it the closed form, which loses a digit there.
inline constexpr double kSlow = 0.3;
inline constexpr double kLargestAngle = 39000.0;  ///< of Highway's sine and cosine
/// Writes q(t) and v(t), what is kept up included. What is neither slow nor a decaying oscillation with an angle
/// omega_d t below kLargestAngle comes out wrong.
using MoveModes = void (*)(const ModesInMotion&, double t, const Speeds&, const KeptUp* kept, Index loads, double* q,
                           double* v);

/// shape . q, shape . v and weight . q
struct Products {
  double q, v, weighted;
};
using MultiplyModes = Products (*)(Index count, const double* shape, const double* weight, const double* q,
                                   const double* v);

/// Of the chosen instruction set.
struct ModalMotionKernels {
  StartModes start;
  LeadModes lead;
  MoveModes move;
  MultiplyModes multiply;
};
const ModalMotionKernels& modal_motion();

}  // namespace butee::dynamics::kernel
