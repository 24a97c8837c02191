#pragma once

#include <memory>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/stage_solver.hpp"
#include "integrators/zienkiewicz_xie.hpp"

namespace butee::integrators {

/// Newmark's parameters in x_{n+1} = x_n + h v_n + h^2 [(1/2 - beta) a_n + beta a_{n+1}], v_{n+1} =
/// v_n + h [(1 - gamma) a_n + gamma a_{n+1}].
struct NewmarkParameters {
  double beta = 0.25;
  double gamma = 0.5;

  static std::vector<config::Parameter> declare();
  static NewmarkParameters read(const config::Parameters& parameters);
  /// The largest stable h omega: 1/sqrt(gamma/2 - beta) if beta < gamma/2, else infinite.
  double stability_limit() const;
};

/// newmark (NM1) and, with a controller, newmark_adaptive (NM2): Newmark with Newton-Raphson.
///
/// Predictor a_{n+1} = a_n, then Newton's iteration (StageSolver) with A = M + gamma h C + beta h^2 (K + K_tangent).
///
/// Order 2 at gamma = 1/2; unconditionally stable for linear motion at beta >= gamma/2 >= 1/4;
/// energy is not conserved across a change of contact. With stops, one factorization and one solve
/// per iteration. Checked in tests/conformance. Source: N. M. Newmark, J. Eng. Mech. Div. ASCE 85
/// (1959) 67-94.
class Newmark final : public time::Integrator {
 public:
  Newmark(dynamics::Dynamics& dynamics, NewmarkParameters parameters, NewtonOptions newton,
          std::unique_ptr<ZienkiewiczXie> controller = nullptr);

  time::Traits traits() const override {
    return {.starts_as_published = true, .stability_limit = parameters_.stability_limit()};
  }
  const time::StepController* controller() const override { return controller_.get(); }

 private:
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;

  NewmarkParameters parameters_;
  StageSolver stage_;
  std::unique_ptr<ZienkiewiczXie> controller_;
};

}  // namespace butee::integrators
