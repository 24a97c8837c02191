#pragma once

#include <cstdint>
#include <vector>

#include <butee/dynamics/dynamics.hpp>

#include "promise.hpp"

namespace butee::stress {

/// A closing or opening of a contact in the reference.
struct ContactChange {
  double t = 0.0;     ///< s
  Index contact = 0;  ///< index: stops first, then obstacles
  bool closes = false;
  double speed = 0.0, acceleration = 0.0;  ///< |w'|, m/s, and |w''| on the open side, m/s2
  double until = 0.0;                      ///< s; for a closing: the instant of the next opening, or infinity
};

/// Observes a run of `exact` piece by piece: the largest value of each component so far, and all contact
/// changes.
class CourseWatch final : public time::Observer {
 public:
  /// `dynamics` must outlive it.
  explicit CourseWatch(dynamics::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;

  enum class Watches { all, largest, nothing };
  Watches watches = Watches::all;
  Vector largest_x, largest_v;
  std::vector<ContactChange> changes;  ///< in chronological order

  /// The free DOFs of each contact.
  const std::vector<std::vector<Index>>& ends() const { return ends_; }
  /// Stiffness of each contact while it is closed, N/m.
  const Vector& closed_stiffness() const { return stiffness_; }

 private:
  /// Stores the side on which each contact is closed, or 0, in now_.
  void find_sides(double t, ConstVectorRef x, ConstVectorRef v);
  void change(const time::AcceptedStep& step, double t, Index contact, double side);
  /// Speed and acceleration of a contact at an instant.
  std::pair<double, double> motion_of(const time::AcceptedStep& step, double t, Index contact);

  const dynamics::ElasticStops& contact_;
  const dynamics::Obstacles* obstacles_;  ///< null if there are none
  std::vector<std::vector<Index>> ends_;
  Vector stiffness_;
  std::vector<double> now_;
  std::vector<Index> all_;
  std::vector<double> times_, x_, v_;
  Vector w_, penetration_;
  std::vector<double> sides_;             ///< side of each closed contact, 0 if open
  std::vector<std::ptrdiff_t> closings_;  ///< index of the last change that closed each contact, or -1
};

/// The smallest and the largest velocities of a run within a time interval.
class VelocityBand final : public time::Observer {
 public:
  void watch(double begin, double end, Index size);
  void step(const time::AcceptedStep& step) override;

  bool is_active = false;
  Vector low, high;
  std::int64_t looks = 0;  ///< instants at which the motion was evaluated

 private:
  double begin_ = 0.0, end_ = 0.0;
  std::vector<Index> all_;
  std::vector<double> v_;
};

/// Tolerance in time, s, for velocities at `t` near contact changes, if w may have an error of `parts` times
/// the scales S_w at `row`: parts S_w/|w'| around each change, limited by the time that w'' needs for that
/// distance. If a contact is shorter than the characteristic time S_w/S_w', its whole duration counts as
/// near. 0 if no change is near.
double time_margin(const std::vector<ContactChange>& changes, const std::vector<std::vector<Index>>& ends,
                   const Trajectory& scales, Index row, double t, double parts);

}  // namespace butee::stress
