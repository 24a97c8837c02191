#pragma once

#include "butee/model/time_function.hpp"

namespace butee::embed {

/// A force set by another solver: linear in time from one instant on.
class NodalForce final : public model::TimeFunction {
 public:
  struct Line {
    double value = 0.0;  ///< N, or N m on theta, at `begin`
    double slope = 0.0;  ///< N/s
    double begin = 0.0;  ///< s
  };

  double value(double t) const override { return line.value + line.slope * (t - line.begin); }
  bool taylor(double t, double h, std::span<double> coefficients) const override {
    for (double& coefficient : coefficients) coefficient = 0.0;
    if (!coefficients.empty()) coefficients[0] = value(t);
    if (coefficients.size() > 1) coefficients[1] = line.slope * h;
    return true;
  }

  bool is_piecewise_parabolic() const override { return true; }

  Line line;
};

}  // namespace butee::embed
