#pragma once

#include <vector>

#include "integrators/exponential/component_speeds.hpp"
#include "integrators/exponential/contact_force.hpp"
#include "integrators/exponential/contact_gaps.hpp"

namespace butee::integrators {

/// The part of the frequency rise by a closed stop that the projection leaves out if the mode turns by theta (rad) in
/// the step, `square` = theta^2: approximated to within 10 % up to theta = 10 (plugins/exponential/constants.py).
inline double unreceived_part(double square) {
  constexpr double kSlow = 1.8e-5, kFast = 0.027;
  const double slow = kSlow * square * square * square;
  return slow / (1.0 + kFast * square + slow);
}

/// The velocity error of modes that turn too far in a step to feel a closed stop (indicator 8 of
/// plugins/exponential/THEORY.md, section 8.1).
///
/// A closed stop raises the frequency of mode i to (omega_i^2 + k_j phi_ij^2)^(1/2). The projection of the stop's force
/// leaves out a part of this rise, and the phase that is missed grows as long as the stop stays closed. The error of
/// the velocity of a component is the missing phase times the amplitude of the mode there. The sum of these errors is
/// limited by an ErrorAccount. Only stops count that were closed at the start of this macro step and of the last one:
/// impacts are shorter. The account and the stops that were closed are a part of the state. Checked in
/// tests/models/exponential_long_runs_test.cpp.
class UnresolvedModes {
 public:
  /// All must outlive it.
  UnresolvedModes(const dynamics::ModalSystem& modal, std::vector<ContactForce>& contacts, const ContactGaps& gaps,
                  ComponentSpeeds& speeds, const Goal& goal);

  Index memory_size() const { return is_possible_ ? 1 + closed_.size() : 0; }
  /// Fills the entries of a state with the displacements `w` of the stops at the start of a run. Stops that are closed
  /// there count as closed before.
  void start(double t, const double* w, double* memory) const;
  /// Begins a macro step with the state at t.
  void begin(double t, const double* memory, const ModalState& state);
  void save(double* memory) const;

  /// A stop stays closed.
  bool any() const { return any_; }
  /// Takes the amplitudes of the modes from the end of an attempt at a step if they have grown since they were found.
  void look(double t, const ModalState& end);
  /// After a step was accepted.
  void keep() {
    if (is_of_start_) return;
    std::swap(start_, end_);
    is_of_start_ = true;
    energy_ = amplitudes_.square().sum();
  }
  /// The error of a step of length h, relative to the largest velocity so far of the component that it affects most.
  double error(double h);
  /// The largest error() of a step to t.
  double allowed(double t) const { return ErrorAccount::kSpend / kMacroStep * (account_.rate() * t - spent_); }
  void charge(double h) {
    if (any_) spent_ += error(h);
  }

 private:
  /// The modes' motion and the displacements of the stops at an instant.
  struct Instant {
    double t;
    Eigen::ArrayXd q, v, w;

    void set(double instant, const ModalState& state) {
      t = instant;
      q = state.q;
      v = state.v;
      w = state.w;
    }
  };

  void find_rates(const Instant& at);

  const dynamics::ModalSystem& modal_;
  std::vector<ContactForce>& contacts_;
  const ContactGaps& gaps_;
  ComponentSpeeds& speeds_;
  ErrorAccount account_;
  bool is_possible_;        ///< the modes turn at different rates
  Eigen::ArrayXd squares_;  ///< omega^2
  bool any_ = false;
  double spent_ = 0.0;
  Vector raised_;              ///< the largest speeds, at least a part of those that the amplitudes will cause
  Eigen::ArrayXd closed_;      ///< the side on which each stop was closed at the start of the macro step; 0: open
  Eigen::ArrayXd was_closed_;  ///< the same for the macro step before
  Instant start_, end_;        ///< the instants at which amplitudes were found
  bool is_of_start_ = true;    ///< amplitudes_ are those of start_
  double energy_ = 0.0;        ///< sum of the squares of the amplitudes at start_, J
  Eigen::ArrayXd rates_;       ///< error of each mode per second if it does not feel the stops at all, 1/s
  Eigen::ArrayXd amplitudes_;  ///< of the modes' velocities, kg^(1/2) m/s
  Eigen::ArrayXd rise_;        ///< of omega^2 by the stops, 1/s^2
  Eigen::ArrayXd unreceived_;  ///< unreceived_part() of each mode for steps of unreceived_h_
  double unreceived_h_ = 0.0;  ///< s
};

}  // namespace butee::integrators
