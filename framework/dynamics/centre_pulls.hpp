#pragma once

#include <vector>

#include "butee/dynamics/obstacles.hpp"

namespace butee::dynamics {

/// A contact around a centre whose law pulls while apart, such as `arctan` in a ring. At the centre the pull changes
/// its direction, on a straight way to the opposite one.
struct CentrePull {
  Index contact;
  Eigen::Vector2d centre;  ///< m
  double gap;              ///< m
  double force;            ///< at the centre, N
};

BUTEE_EXPORT std::vector<CentrePull> centre_pulls(const Obstacles& obstacles);

}  // namespace butee::dynamics
