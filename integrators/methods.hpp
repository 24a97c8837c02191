#pragma once

#include "butee/time/integrator.hpp"

/// The declarations of all methods of this folder; each is registered by a module of its own in plugins/.
namespace butee::integrators {

time::IntegratorType rk4_type();
time::IntegratorType rk4_fixed_factors_type();
time::IntegratorType rk4_error_scaled_type();
time::IntegratorType newmark_type();
time::IntegratorType newmark_adaptive_type();
time::IntegratorType newmark_modified_type();
time::IntegratorType newmark_modified_adaptive_type();

}  // namespace butee::integrators
