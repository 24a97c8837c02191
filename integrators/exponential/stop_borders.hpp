#pragma once

#include <vector>

#include "butee/dynamics/elastic_stops.hpp"
#include "integrators/exponential/step_nodes.hpp"

namespace butee::integrators {

/// The displacements w at which the force of an elastic stop is not smooth, or bends within a small distance. Steps of
/// collocation end there, since a bend between two nodes would not be seen.
///
/// A stop without a force while open has a border on each side where it closes, and a second one at the penetration
/// from which its law is linear, if the law gives the width of its transition. A law that is smooth at g = 0, such as
/// `arctan`, has two more borders, beside its transition. If it exerts a force while open, the force of a stop on both
/// sides jumps at w = 0, from the law of one side to that of the other. Derivation: plugins/exponential/COLLOCATION.md,
/// section 3.
class StopBorders {
 public:
  using Row = StepNodes::Row;

  /// Throws InputError for a law that acts while the stop is open and does not give the width of its transition.
  /// `stops` must outlive it.
  explicit StopBorders(dynamics::ElasticStops& stops);

  /// The position of the first border that the displacement of a stop crosses in the range, or range.last; the
  /// displacement is given by its polynomial over a step. See StepNodes::first_crossing().
  double first_crossing(Index stop, const Row& displacement, CrossingRange range) const;

  /// The stops whose force jumps at w = 0.
  const std::vector<Index>& jumping() const { return jumping_; }
  /// The side of the middle, +1 or -1, on which a stop is in a step: that of its displacement at the start, or soon
  /// after it if the start is at the jump but for the precision with which steps end there; 0 at rest in the middle.
  static double side_of_step(double start, double next);
  /// The force, N, to add to that of a stop at w so that the law of a given side goes on beyond w = 0: 0 on that side,
  /// and for side 0.
  double continuation(Index stop, double side, double w) const;

 private:
  dynamics::ElasticStops& stops_;
  std::vector<std::vector<double>> borders_;  ///< of each stop, m
  std::vector<Index> jumping_;
};

}  // namespace butee::integrators
