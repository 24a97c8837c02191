#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "butee/model/system.hpp"

namespace butee::dynamics {

/// An instant before t > 0 by rounding: sums of instants that should give it stay below t.
inline double just_before(double t) {
  return t * (1.0 - 4.0 * std::numeric_limits<double>::epsilon());
}

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

  /// F += F(t + after). A load with pieces so short that the rounding of t + after changes it is
  /// expanded about t instead; t + after must then lie in the piece of t.
  void add(double t, double after, VectorRef force) {
    if (t != time_ || after != after_) evaluate(t, after);
    for (const Entry& entry : entries_) force[entry.dof] += entry.weight * values_[entry.load];
  }
  /// rate := dF/dt(t), from Taylor series or, for loads without one, a difference over `h` s
  void rate(double t, double h, VectorRef rate);
  /// Invalidates the load values, after time functions of loads have changed.
  void changed() { time_ = std::numeric_limits<double>::quiet_NaN(); }
  /// The same after time functions have been replaced by others.
  void replaced();
  /// The instants at which a load, the speed of rotation or a derivative jumps, ascending.
  std::vector<double> discontinuities() const;
  /// True if a load jumps at t, or the angular acceleration of the rotation, on which gyroscopic, circulatory and
  /// friction forces depend.
  bool jump_at(double t) const;

 private:
  /// The rotation, if its speed varies and forces depend on it other than loads; else null.
  const model::Rotation* varying_rotation() const;

  void evaluate(double t, double after);

  const model::System& system_;
  std::vector<Entry> entries_;
  double time_ = std::numeric_limits<double>::quiet_NaN(), after_ = 0.0;
  std::vector<double> values_;          ///< of the loads at time_ + after_
  std::vector<std::uint8_t> is_steep_;  ///< loads with short pieces
  std::array<double, 3> series_{};
};

}  // namespace butee::dynamics
