#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "butee/config/parameters.hpp"
#include "butee/model/system.hpp"

namespace butee::integrators {

/// The tolerance, and the time up to which it is kept, s. A run that begins later keeps it with the same rate of
/// error, on the safe side.
struct Goal {
  double tolerance;
  double run_time;
  /// True: control the error of the whole structure in the norm of the mass matrix instead of the
  /// error of every component.
  bool as_a_whole = false;

  static Goal read(const config::Parameters& parameters) {
    return {parameters.number("tolerance"), parameters.number("end_time"), false};
  }
  static std::optional<Goal> read_if(bool is_adaptive, const config::Parameters& parameters) {
    return is_adaptive ? std::optional(read(parameters)) : std::nullopt;
  }
};

/// The scale of each component: its largest absolute value so far, at least a thousandth of the
/// largest of its kind. Displacements are one kind, rotations another.
class ComponentScales {
 public:
  explicit ComponentScales(const model::System& system);

  /// S_i := max(S_i, |y_i|, largest of its kind/1000)
  void raise(ConstVectorRef y, Eigen::Ref<Vector> scales) const;
  /// all_i := the largest scale of the kind of component i
  void largest_of_kind(ConstVectorRef scales, Vector& all) const;

 private:
  std::vector<std::uint8_t> kinds_;  ///< kind of each DOF
};

/// The account that limits the sum of the relative local errors of a run to its tolerance.
///
/// The balance starts at advance() and grows by rate() per second, together (1 + kAdvance) kBudget
/// tolerances over a run of length T. The local error of a step with a change of contact is charged
/// to the balance and may use the fraction kSpend of it at most. Any other step may have a local
/// error of rate() h. The sum of all local errors is therefore bounded, and the error of the run is
/// at most that sum times the growth of disturbances (integrators/error-control.md).
class ErrorAccount {
 public:
  explicit ErrorAccount(const Goal& goal)
      : rate_(kBudget * goal.tolerance / goal.run_time), advance_(kAdvance * kBudget * goal.tolerance) {}

  double rate() const { return rate_; }        ///< increase of the balance per second, 1/s
  double advance() const { return advance_; }  ///< the balance at the start

  /// The fraction of the balance that one step with a change of contact may use.
  static constexpr double kSpend = 0.5;

 private:
  static constexpr double kBudget = 4.0, kAdvance = 0.1;

  double rate_, advance_;
};

}  // namespace butee::integrators
