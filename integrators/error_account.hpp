#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "butee/config/parameters.hpp"
#include "butee/model/system.hpp"

namespace butee::integrators {

/// The tolerance and the length of the run that it is meant for, s.
struct Goal {
  double tolerance;
  double run_time;
  /// True: the error of the whole structure in the norm of the mass matrix instead of that of every component.
  bool as_a_whole = false;

  static Goal read(const config::Parameters& parameters) {
    return {parameters.number("tolerance"), parameters.number("end_time"), false};
  }
  static std::optional<Goal> read_if(bool is_adaptive, const config::Parameters& parameters) {
    return is_adaptive ? std::optional(read(parameters)) : std::nullopt;
  }
};

/// The scale of every component: its largest value so far, but at least a thousandth of the largest of its kind, where
/// displacements are of one kind and rotations of another.
class ComponentScales {
 public:
  explicit ComponentScales(const model::System& system);

  /// S_i := max(S_i, |y_i|, largest of its kind/1000)
  void raise(ConstVectorRef y, Eigen::Ref<Vector> scales) const;

 private:
  std::vector<std::uint8_t> kinds_;  ///< of each DOF
};

/// How local errors, relative to the scales of what moves, add up to the tolerance of a run.
///
/// The account begins with kAdvance and earns rate() a second, together (1 + kAdvance) kBudget tolerances over a run of
/// length T. Steps with a change of contact pay their local errors from the balance and spend a part of it at most;
/// all others err by rate() h. The sum of all local errors is therefore bounded, and the error of the run is that bound
/// times the growth of disturbances (integrators/error-control.md).
class ErrorAccount {
 public:
  explicit ErrorAccount(const Goal& goal)
      : rate_(kBudget * goal.tolerance / goal.run_time), advance_(kAdvance * kBudget * goal.tolerance) {}

  double rate() const { return rate_; }        ///< 1/s
  double advance() const { return advance_; }  ///< the balance at the start

  /// The part of the balance that one step with a change of contact may spend.
  static constexpr double kSpend = 0.5;

 private:
  static constexpr double kBudget = 4.0, kAdvance = 0.1;

  double rate_, advance_;
};

}  // namespace butee::integrators
