#pragma once

#include "butee/time/integrator.hpp"

namespace butee::integrators {

struct NewtonOptions {
  double residual_tolerance;      ///< eps_r, relative to |F| + |F_c| + |M a| + |C v| + |K x|
  double increment_tolerance;     ///< eps_delta, relative to |x|
  int max_iterations;             ///< i_max linear solves
  bool keep_failures = false;     ///< goes on where they did not suffice
  bool checks_linear_too = true;  ///< looks at the residual after the solve of a scene without stops
};

/// Solves the equations of motion of one stage of an implicit method by Newton's iteration,
///
///     M a + C v + K x = F(t) + F_c(x),    x = x* + displacement_factor a,    v = v* + velocity_factor a
///
/// with A da = r, A = M + velocity_factor C + displacement_factor (K + K_tangent), until |r| <= eps_r (|F| + |F_c| + |M
/// a| + |C v| + |K x|) and, after the first solve, |dx| <= eps_delta |x|. Whatever the stage stands for, it is a system
/// of the size of K.
class StageSolver {
 public:
  StageSolver(dynamics::Dynamics& dynamics, NewtonOptions options);
  virtual ~StageSolver() = default;
  StageSolver(const StageSolver&) = delete;
  StageSolver& operator=(const StageSolver&) = delete;

  /// x, v and a come as a guess that fulfils the two relations, and leave as the solution.
  time::StepReport solve(double t, double velocity_factor, double displacement_factor, VectorRef x, VectorRef v,
                         VectorRef a);

 protected:
  dynamics::Dynamics& dynamics() const { return dynamics_; }

 private:
  /// The stops' forces f and, where asked for, tangent stiffnesses k at displacements w.
  virtual void contact(ConstVectorRef w, bool with_tangent, VectorRef f, VectorRef k);
  /// 2-norms
  struct Change {
    double correction, x;
  };
  /// a += correction, and v and x with their factors, by the solution in residual_.
  Change add_correction(double velocity_factor, double displacement_factor, VectorRef x, VectorRef v, VectorRef a);
  linalg::ForceBalance evaluate_residual(ConstVectorRef x, ConstVectorRef v, ConstVectorRef a, bool with_tangent);

  dynamics::Dynamics& dynamics_;
  NewtonOptions options_;
  Vector load_, residual_;
  Vector stop_displacement_, stop_force_, stop_tangent_;
};

}  // namespace butee::integrators
