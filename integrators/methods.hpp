#pragma once

#include <numbers>

#include "butee/time/integrator.hpp"
#include "integrators/stage_solver.hpp"

/// Declarations of all methods of this folder; a module in plugins/ registers each of them.
namespace butee::integrators {

/// Stability of classical Runge-Kutta on the imaginary axis: h omega <= 2 sqrt 2.
inline constexpr double kRungeKutta4Limit = 2.0 * std::numbers::sqrt2;
/// The same on the negative real axis: h c/m <= 2.785.
inline constexpr double kRungeKutta4DampingLimit = 2.7852935634052818;

/// Options of Newton's iteration for methods without parameters for it: convergence to rounding, as
/// the local error estimates require.
inline constexpr NewtonOptions kNewton = {.residual_tolerance = 1e-11,
                                          .increment_tolerance = 1e-9,
                                          .max_iterations = 40,
                                          .checks_linear_too = false,
                                          .takes_guess = false,
                                          .checks_each_stop = true};

time::IntegratorType auto_type();
time::IntegratorType bathe_type();
time::IntegratorType bathe_adaptive_type();
time::IntegratorType central_differences_type();
time::IntegratorType central_differences_adaptive_type();
time::IntegratorType discrete_gradient_type();
time::IntegratorType discrete_gradient_adaptive_type();
time::IntegratorType dopri5_type();
time::IntegratorType exact_type();
time::IntegratorType extrapolation8_type();
time::IntegratorType exponential_type();
time::IntegratorType generalized_alpha_type();
time::IntegratorType generalized_alpha_adaptive_type();
time::IntegratorType hht_alpha_type();
time::IntegratorType hht_alpha_adaptive_type();
time::IntegratorType piecewise_type();
time::IntegratorType rodas4_type();
time::IntegratorType rk4_type();
time::IntegratorType rk4_fixed_factors_type();
time::IntegratorType rk4_error_scaled_type();
time::IntegratorType newmark_type();
time::IntegratorType newmark_adaptive_type();
time::IntegratorType newmark_modified_type();
time::IntegratorType newmark_modified_adaptive_type();

}  // namespace butee::integrators
