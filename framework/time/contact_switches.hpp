#pragma once

#include <array>
#include <span>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/dense_output.hpp"

namespace butee::time {

/// Evaluates the switching functions of contacts for motions of a structure. Their signs allow for the rounding of the
/// motion, which is relative to that of the whole structure.
class ContactSwitches {
 public:
  using Switch = dynamics::Obstacles::Switch;

  /// `dynamics` must have obstacles and outlive this object. `velocity_uncertainty`: see Traits.
  ContactSwitches(dynamics::Dynamics& dynamics, double velocity_uncertainty);

  /// A motion at an instant.
  struct Sample {
    double t = 0.0;
    Vector x, v, a;  ///< a only if a contact switches by acceleration
    Vector held;     ///< forces that hold the rigid sticks, N
  };
  /// A sample of zeros.
  Sample room() const;

  /// Sets the motion of the whole structure to that of a state.
  void measure(const State& state);
  /// Sets the rigid sticks to those of the present phases, as do take() and look_ahead().
  void update_sticks() { sticks_ = obstacles_.rigid_sticks(); }
  const std::vector<Index>& sticks() const { return sticks_; }

  /// The motion of a state.
  void take(const State& state, Sample& at);
  /// The motion `ahead` of a state (behind it if negative) in the same phases, by its acceleration.
  void look_ahead(const State& state, double ahead, Sample& at);
  /// The motion of `dofs` within a step, or of all DOFs if contacts stick rigidly.
  void interpolate(const DenseOutput& motion, double t, const std::vector<Index>& dofs, Sample& at);

  /// The switching functions of a contact in its present phase; valid until the next call.
  std::span<const Switch> of(Index contact, const Sample& at);
  double value(Index contact, std::size_t which, const Sample& at) { return of(contact, at)[which].value; }

 private:
  void hold(Sample& at);

  dynamics::Dynamics& dynamics_;
  dynamics::Obstacles& obstacles_;
  std::vector<Index> all_, sticks_;
  std::vector<double> values_x_, values_v_, values_a_;
  std::array<Switch, dynamics::Obstacles::kMostSwitches> found_{};
  bool needs_velocities_ = false, needs_accelerations_ = false;
  Vector root_mass_;
  double velocity_uncertainty_;
  /// The motion of the structure in the norm of the diagonal of M, m sqrt(kg) and m sqrt(kg)/s.
  dynamics::Obstacles::Rounding whole_;
  std::vector<double> rounding_shares_;  ///< uncertainty of the motion at each contact per unit of `whole_`, 1/sqrt(kg)
};

}  // namespace butee::time
