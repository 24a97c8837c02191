#pragma once

#include <vector>

#include <butee/time/simulation.hpp>

namespace butee::test {

/// The maxima of one DOF: instants at which v changes from positive to negative, by bisection on the method's
/// interpolant.
class TurningPoints final : public time::Observer {
 public:
  explicit TurningPoints(Index dof) : dof_(dof) {}

  void step(const time::AcceptedStep& step) override {
    if (!(step.from.v[dof_] > 0.0 && step.to.v[dof_] <= 0.0)) return;
    double low = step.from.t, high = step.to.t, xi = 0.0, vi = 0.0;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      step.motion.interpolate(middle, {&dof_, 1}, {{&xi, 1}, {&vi, 1}, {}});
      (vi > 0.0 ? low : high) = middle;
    }
    t.push_back(high);
    x.push_back(xi);
  }

  std::vector<double> t, x;

 private:
  /// Reduces a step below the spacing of doubles.
  static constexpr int kHalvings = 60;

  Index dof_;
};

}  // namespace butee::test
