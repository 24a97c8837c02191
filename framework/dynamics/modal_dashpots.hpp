#pragma once

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// Puts modal damping into the dashpots of a system whose matrices are not symmetric, as those of turning shafts and of
/// bearings with cross terms: C = M Phi diag(2 zeta_i omega_i) Phi^T M with the modes of rest, of M and the symmetric
/// part of K. All other systems stay as they are. C is full, and so the matrices then are: throws InputError beyond
/// kMostModalDashpots free DOFs. Checked in tests/verification/rotor_test.cpp.
BUTEE_EXPORT void make_modal_damping_explicit(const model::Model& model, model::System& system);

inline constexpr Index kMostModalDashpots = 400;

}  // namespace butee::dynamics
