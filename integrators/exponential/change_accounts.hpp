#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>

#include "integrators/error_account.hpp"
#include "integrators/exponential/error_indicators.hpp"

namespace butee::integrators {

/// The goal of the accounts of a run. The run counts as no longer than kMostPeriods of the slowest mode, since the
/// guaranteed error grows with the run beyond. `lowest_frequency`: of the slowest mode, rad/s; 0 for rigid motion.
inline Goal account_goal(const StepGoal& goal, double lowest_frequency) {
  constexpr double kMostPeriods = 1000.0;
  const double most = lowest_frequency > 0.0 ? kMostPeriods * 2.0 * std::numbers::pi / lowest_frequency : goal.run_time;
  return {goal.tolerance, std::min(goal.run_time, most)};
}

/// One ErrorAccount per stop, for the speed errors of steps in which the stop closes, opens or stays closed.
///
/// The errors of the changes of one stop may add up in the same sense: each impact at a given step
/// size takes a little energy. Those of different stops act on different parts of the structure.
/// The accounts are a part of the state. Checked in tests/models/exponential_long_runs_test.cpp.
class ChangeAccounts {
 public:
  ChangeAccounts(const Goal& goal, Index stops) : account_(goal), spent_(Eigen::ArrayXd::Zero(stops)) {}

  Index memory_size() const { return spent_.size(); }
  /// Fills the entries of a state at the start of a run.
  void start(double t, double* memory) const {
    std::fill_n(memory, spent_.size(), account_.rate() * t - account_.advance());
  }
  void load(const double* memory) { spent_ = Eigen::Map<const Eigen::ArrayXd>(memory, spent_.size()); }
  void save(double* memory) const { Eigen::Map<Eigen::ArrayXd>(memory, spent_.size()) = spent_; }

  /// The speed error, relative to the speed scale of the stop, that a step to t may have.
  double allowed(Index stop, double t) const { return ErrorAccount::kSpend * (account_.rate() * t - spent_[stop]); }
  /// The same for a step in which the stop stays closed. There are many of these: a macro step may spend as much.
  double allowed_closed(Index stop, double t) const { return allowed(stop, t) / kMacroStep; }
  void charge(Index stop, double error) { spent_[stop] += error; }

 private:
  ErrorAccount account_;
  Eigen::ArrayXd spent_;  ///< minus the balance at t = 0, for each stop
};

}  // namespace butee::integrators
