#pragma once

#include <span>
#include <vector>

#include "butee/solve/dynamics.hpp"
#include "integrators/quintic.hpp"

namespace butee::integrators {

/// The instants between which a method took its steps in modal coordinates, and the motion between them: quintics
/// through displacement, velocity and acceleration, laid only where somebody asks.
class ModalKnots {
 public:
  /// For up to `most` steps. Both must outlive it.
  ModalKnots(solve::Dynamics& dynamics, const solve::ModalSystem& modal, std::size_t most);

  void begin(double t, const Eigen::ArrayXd& q, const Eigen::ArrayXd& v);
  void add(double t, const Eigen::ArrayXd& q, const Eigen::ArrayXd& v);

  double last() const { return times_.back(); }
  std::size_t steps() const { return times_.size() - 1; }
  double time(std::size_t knot) const { return times_[knot]; }
  /// Those strictly within.
  std::span<const double> inner() const;

  /// The knot before t.
  std::size_t before(double t) const;
  const double* q(std::size_t knot) const { return q_.col(static_cast<Index>(knot)).data(); }
  const double* v(std::size_t knot) const { return v_.col(static_cast<Index>(knot)).data(); }

  /// The motion of `dofs` at t.
  void interpolate(double t, std::span<const Index> dofs, time::Interpolated out);

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Fills the acceleration at a knot.
  void complete(std::size_t knot);
  Motion motion_at(std::size_t knot, Index dof);
  /// Fills courses_ between a knot and the next.
  void lay_courses(std::size_t knot, std::span<const Index> dofs);

  solve::Dynamics& dynamics_;
  const solve::ModalSystem& modal_;
  std::vector<double> times_;
  Eigen::MatrixXd q_, v_, a_;
  std::vector<bool> is_complete_;
  std::size_t course_knot_ = kNone;
  std::vector<Index> course_dofs_;
  std::vector<Motion> course_ends_;
  std::vector<Quintic> courses_;
  Vector stop_displacement_, stop_force_;
};

}  // namespace butee::integrators
