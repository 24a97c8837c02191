#pragma once

#include <optional>

#include "butee/core/error.hpp"
#include "butee/dynamics/elastic_stops.hpp"

namespace butee::dynamics {

/// The lowest and the highest natural frequency of an undamped system, rad/s. Rigid-body motion has
/// frequency 0.
struct FrequencyRange {
  double lowest = 0.0;
  double highest = 0.0;
};

enum class StopState { open, closed };

/// The range with all stops open or all stops closed (K + S^T k_c S). Dense for small systems,
/// Lanczos for large ones (relative accuracy about 1e-6, the square of the lowest with the rounding of that of the
/// highest; find_modes() has it to more digits); nothing if Lanczos did not converge.
BUTEE_EXPORT std::optional<FrequencyRange> frequency_range(const model::System& system, StopState stops);

/// The stiffness has a negative eigenvalue.
struct UnstableStiffness : InputError {
  using InputError::InputError;
};

/// Throws UnstableStiffness if the lowest eigenvalue of K phi = omega^2 M phi, 1/s2, is negative by more than rounding
/// relative to the highest one: such motion grows and is no mode.
BUTEE_EXPORT void require_no_growth(double lowest, double highest);

/// Modes of an undamped system with open stops, lowest first: K phi_i = omega_i^2 M phi_i, Phi^T M
/// Phi = 1.
struct Modes {
  Vector frequencies;      ///< omega, rad/s; zero for rigid motion
  Eigen::MatrixXd shapes;  ///< Phi, n x p
};

/// The `count` lowest modes, 1 <= count <= n. Dense for small systems and for more than half of all
/// modes; otherwise Lanczos with a count of the eigenvalues below the last one. Nothing if Lanczos
/// did not converge or missed a mode.
///
/// omega_i^2 is accurate to rounding of the entries of K; if that cannot distinguish it from rigid motion, omega_i is
/// zero. Of a stiffness that is not symmetric the symmetric part counts. Throws InputError as
/// require_no_growth().
BUTEE_EXPORT std::optional<Modes> lowest_modes(const model::System& system, Index count);

/// The largest sqrt(k_c/m) of all stops, rad/s, with the masses on the diagonal of M at the stop's
/// DOFs: a lower estimate of the frequency of an impact, cheaper than shortest_impact(). 0
/// without stops.
BUTEE_EXPORT double contact_frequency(const model::System& system, const ElasticStops& contact);

/// The duration of the shortest impact, s: pi/sqrt(k_c s^T M^-1 s) for a unit force s on a stop, ring or plane; the
/// structure behind it makes an impact longer. Of more than 200 contacts as many evenly spaced ones count. Infinite
/// without contacts, or if M is singular.
BUTEE_EXPORT double shortest_impact(const model::System& system);

/// K, or K + S^T k_c S with all stops closed.
BUTEE_EXPORT SparseMatrix stiffness_with_stops(const model::System& system, StopState stops);

/// The dashpots of closed contacts (Kelvin-Voigt) and of those that stick, N s/m, rings along both axes; dissipation
/// that depends on the penetration or the normal force is left out.
BUTEE_EXPORT SparseMatrix damping_of_contacts(const model::System& system);

/// The largest lambda of C phi = lambda M phi, 1/s, by iteration from below; nothing if M is singular.
BUTEE_EXPORT std::optional<double> fastest_decay(const SparseMatrix& damping, const SparseMatrix& mass);

}  // namespace butee::dynamics
