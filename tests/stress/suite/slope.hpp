#pragma once

#include <string>
#include <vector>

#include "run.hpp"

namespace butee::stress {

/// Dependence of a method's error on its tolerance in one scene.
struct Slope {
  std::string scene, method;
  std::vector<double> tolerances,
      errors;           ///< errors used: above ten times the reference's own error and tolerance/100, below 0.1
  double value = 0.0;   ///< fitted slope of log(error) over log(tolerance)
  bool grazes = false;  ///< Gamma depends on the size of disturbances, as for a grazing contact
                        ///< (checked only if the slope is low)

  /// True if the points span two decades, over which the scatter of single errors hardly turns the line.
  bool is_fitted() const {
    constexpr double kSpan = 100.0, kRounding = 1e-9;
    return errors.size() >= 3 && tolerances.front() >= (1.0 - kRounding) * kSpan * tolerances.back();
  }
  /// True if the error is nearly proportional to the tolerance; the positions of impacts within steps scatter
  /// the slope.
  bool is_kept() const { return !is_fitted() || value >= (grazes ? 0.5 : 0.8); }
};

/// The slope of the least-squares line through (log tolerance, log error).
double fitted_slope(const std::vector<double>& tolerances, const std::vector<double>& errors);

/// Runs each method with a guaranteed tolerance, from 1e-2 on by half decades, each run limited by
/// `work`.
/// Compares only displacements and rotations, because the velocity bands hide errors. Empty if the scene has
/// no reference.
std::vector<Slope> slopes(Scene scene, const std::vector<Method>& methods, std::int64_t work);

}  // namespace butee::stress
