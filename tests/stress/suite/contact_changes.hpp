#pragma once

#include <vector>

#include <butee/dynamics/dynamics.hpp>

#include "promise.hpp"

namespace butee::stress {

/// A contact that closed or opened in the reference.
struct ContactChange {
  double t = 0.0;     ///< s
  Index contact = 0;  ///< first the stops, then the obstacles
  bool closes = false;
  double speed = 0.0, acceleration = 0.0;  ///< |w'|, m/s, and |w''| on the open side, m/s2
  double until = 0.0;                      ///< s; of a closing: when it opened again, or infinite
};

/// Follows a run of `exact` from piece to piece: the largest value of each component so far, and all changes of
/// contact.
class CourseWatch final : public time::Observer {
 public:
  /// `dynamics` must outlive it.
  explicit CourseWatch(dynamics::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;

  enum class Watches { all, largest, nothing };
  Watches watches = Watches::all;
  Vector largest_x, largest_v;
  std::vector<ContactChange> changes;  ///< in their order

  /// The free DOFs of each contact.
  const std::vector<std::vector<Index>>& ends() const { return ends_; }
  /// Of each contact while it is closed, N/m.
  const Vector& closed_stiffness() const { return stiffness_; }

 private:
  /// The side on which each contact is closed, or 0, into now_.
  void find_sides(double t, ConstVectorRef x, ConstVectorRef v);
  void change(const time::AcceptedStep& step, double t, Index contact, double side);
  /// Speed and acceleration of a contact's opening at an instant.
  std::pair<double, double> motion_of(const time::AcceptedStep& step, double t, Index contact);

  const dynamics::Contact& contact_;
  const dynamics::Obstacles* obstacles_;  ///< null where there are none
  std::vector<std::vector<Index>> ends_;
  Vector stiffness_;
  std::vector<double> now_;
  std::vector<Index> all_;
  std::vector<double> times_, x_, v_;
  Vector w_, penetration_;
  std::vector<double> sides_;             ///< of closed contacts, else 0
  std::vector<std::ptrdiff_t> closings_;  ///< the last change that closed each contact, or -1
};

/// The least and the largest velocities of a run within an interval of time.
class VelocityBand final : public time::Observer {
 public:
  void watch(double begin, double end, Index size);
  void step(const time::AcceptedStep& step) override;

  bool is_active = false;
  Vector low, high;

 private:
  double begin_ = 0.0, end_ = 0.0;
  std::vector<Index> all_;
  std::vector<double> v_;
};

/// How far in time, s, velocities at `t` may be off near changes of contact, if w may be off by `parts` of the scales
/// S_w at `row`: parts S_w/|w'| from each change on, but no longer than w'' takes for that way. A contact that is
/// shorter than the motion's own time S_w/S_w' counts as near in all its length. 0 where no change is near.
double time_margin(const std::vector<ContactChange>& changes, const std::vector<std::vector<Index>>& ends,
                   const Trajectory& scales, Index row, double t, double parts);

}  // namespace butee::stress
