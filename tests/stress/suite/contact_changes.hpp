#pragma once

#include <vector>

#include <butee/dynamics/contact.hpp>

#include "promise.hpp"

namespace butee::stress {

/// A stop that closed or opened in the reference.
struct ContactChange {
  double t = 0.0;  ///< s
  Index stop = 0;
  bool closes = false;
  double speed = 0.0, acceleration = 0.0;  ///< |w'|, m/s, and |w''| on the open side, m/s2
  double until = 0.0;                      ///< s; of a closing: when it opened again, or infinite
};

/// Follows a run of `exact` from piece to piece: the largest value of each component so far, and all changes of
/// contact.
class CourseWatch final : public time::Observer {
 public:
  /// `contact` must outlive it.
  explicit CourseWatch(const dynamics::Contact& contact);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;

  enum class Watches { all, largest, nothing };
  Watches watches = Watches::all;
  Vector largest_x, largest_v;
  std::vector<ContactChange> changes;  ///< in their order

 private:
  void change(const time::AcceptedStep& step, double t, Index stop, double side);

  const dynamics::Contact& contact_;
  std::vector<Index> all_;
  std::vector<double> times_, x_, v_;
  Vector w_, penetration_;
  std::vector<double> sides_;             ///< of closed stops, else 0
  std::vector<std::ptrdiff_t> closings_;  ///< the last change that closed each stop, or -1
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
double time_margin(const std::vector<ContactChange>& changes, const dynamics::Contact& contact,
                   const Trajectory& scales, Index row, double t, double parts);

}  // namespace butee::stress
