#pragma once

#include "butee/core/types.hpp"

namespace butee::dynamics::kernel {

/// Arrays of modes are padded to whole registers of any instruction set.
inline constexpr Index kModesAtOnce = 8;

/// The steady-state response to a harmonic load, cosine cos(angle) + sine sin(angle).
struct KeptUp {
  double angular_frequency;
  const double *cosine, *sine;
  double of_cosine, of_sine;  ///< cos and sin of the present angle
};

/// Modes in a step: y'' + 2 delta y' + omega^2 y = f_0 + f_1 t + f_2 t^2, and quantities that
/// follow from the start of the step.
struct ModesInMotion {
  Index count;                                            ///< padded to whole registers
  const double *square, *compliance, *decay, *frequency;  ///< omega^2, 1/omega^2, delta, omega_d
  double single_decay;                                    ///< delta if all modes share it; negative if they differ
  double *q, *v;                                          ///< at the start, without the steady-state response
  double* force[3];
  double* led[3];         ///< coefficients of the polynomial particular solution for the force
  double *cosine, *sine;  ///< amplitudes of the decaying oscillation about it
};

/// Fills q and v from the given ones at the start, minus the steady-state response `kept`.
using StartModes = void (*)(const ModesInMotion&, const double* q, const double* v, const KeptUp* kept, Index loads);
/// Adds moments[k] P_k over a duration of 1/r to the force, if moments are given, and fills led,
/// cosine and sine.
using LeadModes = void (*)(const ModesInMotion&, const double* const* moments, double r);

/// Modes up to register `slow` are moved by Taylor series with `terms` terms, those from register
/// `fast` on in closed form, and those between by the formula that suits each mode.
struct Speeds {
  Index slow, fast;
  int terms;
};
/// Up to this (omega + delta) t a Taylor series is used; beyond it the closed form, which loses a
/// digit at this limit.
inline constexpr double kSlow = 0.3;
inline constexpr double kLargestAngle = 39000.0;  ///< limit of Highway's sine and cosine
/// Writes q(t) and v(t), including the steady-state response. Results are wrong for modes that are
/// neither slow nor a decaying oscillation with an angle omega_d t below kLargestAngle.
using MoveModes = void (*)(const ModesInMotion&, double t, const Speeds&, const KeptUp* kept, Index loads, double* q,
                           double* v);

/// shape . q, shape . v and weight . q
struct Products {
  double q, v, weighted;
};
using MultiplyModes = Products (*)(Index count, const double* shape, const double* weight, const double* q,
                                   const double* v);

/// re + i im = e^((decay + i turn) t), for any number of modes with |turn t| below kLargestAngle.
using TurnModes = void (*)(Index count, const double* decay, const double* turn, double t, double* re, double* im);

/// For the chosen instruction set.
struct ModalMotionKernels {
  StartModes start;
  LeadModes lead;
  MoveModes move;
  MultiplyModes multiply;
  TurnModes turn;
};
const ModalMotionKernels& modal_motion();

}  // namespace butee::dynamics::kernel
