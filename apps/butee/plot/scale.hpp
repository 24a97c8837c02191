#pragma once

#include <span>
#include <string>

namespace butee::app::plot {

/// A readable unit: a value times `factor` is in `unit`.
struct Scale {
  double factor = 1.0;
  std::string unit;

  /// "time / ms"
  std::string axis(const std::string& what) const { return unit.empty() ? what : what + " / " + unit; }
};

/// The largest prefix (nano to mega, m: to m, s: to s) with which `largest` is at least 1.
Scale scale_for(double largest, const std::string& unit);

/// The largest |value|.
double largest_of(std::span<const double> values);

/// A number with few digits.
std::string short_number(double value, int digits = 4);

}  // namespace butee::app::plot
