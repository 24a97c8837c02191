#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "butee/time/integrator.hpp"

namespace butee::integrators {

/// Zienkiewicz and Xie's step size control of a Newmark method by the local error of the
/// displacement.
///
///     eta = |beta - 1/6| h^2 |a_{n+1} - a_n|_2 / |x_{n+1} - x_n|_2
///     nu1 eta_e <= eta <= nu2 eta_e: h stays; else h := h sqrt(eta_e/eta);  eta > nu2 eta_e: the step is repeated
///
/// Without motion a step is accepted and h stays. At beta = 1/6 the estimate vanishes; this value
/// is refused. Source: O. C. Zienkiewicz and Y. M. Xie, Earthquake Eng. Struct. Dyn. 20 (1991)
/// 871-887, doi 10.1002/eqe.4290200907.
class ZienkiewiczXie final : public time::StepController {
 public:
  ZienkiewiczXie(double beta, double target_error, double lower, double upper)
      : factor_(std::abs(beta - 1.0 / 6.0)), target_(target_error), lower_(lower), upper_(upper) {}

  /// eta of a step; kNoMotion if nothing moves.
  double error(const time::State& from, const time::State& to, double h) const;

  time::StepDecision decide(double h, const time::StepReport& report) const override;

  static std::vector<config::Parameter> parameters();
  static std::unique_ptr<ZienkiewiczXie> make(const config::Parameters& parameters);
  static void check(const config::Parameters& parameters, config::Diagnostics& diagnostics);

 private:
  static constexpr double kNoMotion = -1.0;

  double factor_, target_, lower_, upper_;
};

}  // namespace butee::integrators
