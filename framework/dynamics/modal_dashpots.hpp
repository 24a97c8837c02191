#pragma once

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// Adds modal damping to the dashpots of a system whose matrices are not symmetric, such as turning
/// shafts and bearings with cross terms: C = M Phi diag(2 zeta_i omega_i) Phi^T M with the modes at
/// rest, of M and the symmetric part of K. All other systems are unchanged. C is full, and so are
/// the matrices then: throws InputError beyond kMostModalDashpots free DOFs. Checked in
/// tests/verification/rotor_test.cpp.
BUTEE_EXPORT void make_modal_damping_explicit(const model::Model& model, model::System& system);

inline constexpr Index kMostModalDashpots = 400;

}  // namespace butee::dynamics
