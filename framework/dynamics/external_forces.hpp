#pragma once

#include <array>
#include <limits>
#include <vector>

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// F(t) of the loads of a system. Load values are kept for one instant, since the stages of a
/// method often share it.
class ExternalForces {
 public:
  /// `system` must outlive this object.
  explicit ExternalForces(const model::System& system);

  /// A load on one free DOF.
  struct Entry {
    Index dof;
    double weight;
    std::size_t load;
  };
  const std::vector<Entry>& entries() const { return entries_; }

  /// F += F(t)
  void add(double t, VectorRef force) {
    if (t != time_) evaluate(t);
    for (const Entry& entry : entries_) force[entry.dof] += entry.weight * values_[entry.load];
  }
  /// rate := dF/dt(t), from Taylor series or, for loads without one, a difference over `h` s
  void rate(double t, double h, VectorRef rate);
  /// Invalidates the load values, after time functions of loads have changed.
  void changed() { time_ = std::numeric_limits<double>::quiet_NaN(); }
  /// The instants at which a load, the speed of rotation or a derivative jumps, ascending.
  std::vector<double> discontinuities() const;

 private:
  void evaluate(double t);

  const model::System& system_;
  std::vector<Entry> entries_;
  double time_ = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values_;  ///< of the loads at time_
  std::array<double, 2> series_{};
};

}  // namespace butee::dynamics
