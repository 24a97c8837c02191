#pragma once

#include <string>
#include <vector>

#include "run.hpp"

namespace butee::stress {

/// How the error of a method follows its tolerance on one scene.
struct Slope {
  std::string scene, method;
  std::vector<double> tolerances,
      errors;           ///< that count: above ten times the reference's own error and tolerance/100, below 0.1
  double value = 0.0;   ///< of log(error) over log(tolerance), fitted
  bool grazes = false;  ///< Gamma depends on the size of disturbances, as that of a grazing contact does
                        ///< (looked for where the slope is low)

  /// Enough points for a slope.
  bool is_fitted() const { return errors.size() >= 3; }
  /// True where it is proportional, or nearly so: impacts that fall well or badly in a step scatter it.
  bool is_kept() const { return !is_fitted() || value >= (grazes ? 0.5 : 0.8); }
};

/// The slope of a straight line through (log tolerance, log error).
double fitted_slope(const std::vector<double>& tolerances, const std::vector<double>& errors);

/// Runs each of the methods whose tolerance is a promise from 1e-2 on by decades, each bounded by `work`, and compares
/// displacements and rotations: velocities are compared with bands, which hide errors. None where the scene has no
/// reference.
std::vector<Slope> slopes(Scene scene, const std::vector<Method>& methods, std::int64_t work);

}  // namespace butee::stress
