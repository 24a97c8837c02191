#pragma once

#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <exception>
#include <memory>
#include <nvector/nvector_serial.h>
#include <string>

#include <butee/dynamics/tangent_solver.hpp>
#include <butee/plugin/entry.hpp>

namespace butee::plugins {

enum class Family { cvode_bdf, cvode_adams, arkode_erk, arkode_dirk };

/// A method of SUNDIALS for y = (x, v), y' = (v, M^-1 (F + F_c - C v - K x)); each step of this
/// integrator is one internal step of SUNDIALS.
///
/// The implicit methods solve (1 - gamma J) z = r in block form, with the effective matrix of this
/// framework and its treatment of the contacts, which is better suited than any matrix that SUNDIALS
/// could use. Errors are relative to each component, plus an absolute tolerance. CVODE keeps its
/// own history: a step that does not continue the last one reinitialises CVODE. A step is therefore
/// not a pure function of the state, and a restart reproduces a run only to the tolerance. Source:
/// A. C. Hindmarsh et al., ACM TOMS 31 (2005) 363-396, doi 10.1145/1089014.1089020.
class SundialsIntegrator final : public time::Integrator {
 public:
  /// `order` 0: the solver selects the order. `absolute_tolerance` in m, rad, m/s and rad/s.
  SundialsIntegrator(dynamics::Dynamics& dynamics, Family family, double tolerance, double absolute_tolerance,
                     int order);
  ~SundialsIntegrator() override;

  const time::StepController* controller() const override { return &controller_; }
  double first_step(const time::State&) const override;

 private:
  class Controller final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport& report) const override;
  };

  /// The accelerations may have changed: the solver starts afresh.
  void do_start(time::State& state) override;
  void do_jump(time::State& state, ConstVectorRef jump) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;

  bool is_cvode() const { return family_ == Family::cvode_bdf || family_ == Family::cvode_adams; }
  void create(const time::State& from);
  void begin(const time::State& from);
  void attach_linear_solver();
  int evaluate(double t, const double* y, double* rate);
  int solve(double* z, const double* r);
  /// Sets the matrix of solve() with the tangents of the contacts at this motion; the iterations of
  /// one stage share it.
  [[nodiscard]] bool set_matrix(double t, double gamma, ConstVectorRef x, ConstVectorRef v);
  /// work_ := (K + K_t) y
  void tangent_force(ConstVectorRef y);

  /// The result of `call`. An exception is kept for do_step(), since it must not pass through the C code of SUNDIALS.
  template <class Function>
  int guarded(Function call) noexcept;
  static int right_side(realtype t, N_Vector y, N_Vector rate, void* self);
  static int solve_linear(SUNLinearSolver solver, SUNMatrix, N_Vector z, N_Vector r, realtype);

  Controller controller_;
  Family family_;
  double tolerance_, absolute_tolerance_;
  int order_;
  std::exception_ptr thrown_;  ///< by a call from SUNDIALS
  SUNContext context_ = nullptr;
  void* memory_ = nullptr;
  N_Vector y_ = nullptr, derivative_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  time::State last_;  ///< the state that the solver has reached
  dynamics::TangentSolver solver_;
  double matrix_t_, matrix_gamma_;  ///< of the matrix that solver_ holds, s; NaN: none
  Vector stop_displacement_, stop_force_, tangent_, work_, stop_work_, other_;
};

}  // namespace butee::plugins
