#pragma once

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// The system of a model as runs use it. If its matrices are not symmetric, as with turning shafts
/// and bearings with cross terms, modal damping is added to the dashpots:
/// C = M Phi diag(2 zeta_i omega_i) Phi^T M with the modes at rest, of M and the symmetric part of
/// K. C is full, and so are the matrices then: throws InputError beyond kMostModalDashpots free
/// DOFs. Checked in tests/verification/rotor_test.cpp.
BUTEE_EXPORT model::System assemble_to_run(const model::Model& model);

inline constexpr Index kMostModalDashpots = 400;

}  // namespace butee::dynamics
