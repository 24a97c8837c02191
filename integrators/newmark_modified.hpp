#pragma once

#include <memory>

#include "integrators/newmark.hpp"

namespace butee::integrators {

/// newmark_modified (NMM1) and, with a controller, newmark_modified_adaptive (NMM2): Newmark
/// without Newton's iteration.
///
/// The stops at t_{n+1} act with their secant stiffness at t_n, F_c = -K_c(u_n) u_{n+1} + K_c(u_n)
/// j sign(u_n), so that a step takes one linear solve with A = M + gamma h C + beta h^2 (K +
/// K_c(u_n)).
///
/// Order 2 while no stop changes. A stop that opens or closes during a step acts one step late,
/// which is a force error of O(h) for a time O(h): order 1 or 2 across contact, as measured in
/// tests/conformance. Source: C. Duran et al., IMechE VIRM10, London, 2012.
class ModifiedNewmark final : public time::Integrator {
 public:
  ModifiedNewmark(dynamics::Dynamics& dynamics, NewmarkParameters parameters,
                  std::unique_ptr<ZienkiewiczXie> controller = nullptr);

  time::Traits traits() const override {
    return {.starts_as_published = true, .stability_limit = parameters_.stability_limit()};
  }
  const time::StepController* controller() const override { return controller_.get(); }

 private:
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;

  NewmarkParameters parameters_;
  std::unique_ptr<ZienkiewiczXie> controller_;
  Vector secant_, offset_;
};

}  // namespace butee::integrators
