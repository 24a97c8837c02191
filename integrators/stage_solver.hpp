#pragma once

#include "butee/time/integrator.hpp"

namespace butee::integrators {

struct NewtonOptions {
  double residual_tolerance;      ///< eps_r, relative to |F| + |F_c| + |M a| + |C v| + |K x|
  double increment_tolerance;     ///< eps_delta, relative to |x|
  int max_iterations;             ///< i_max, the largest number of linear solves
  bool keep_failures = false;     ///< continue if the iteration did not converge
  bool checks_linear_too = true;  ///< check the residual after the solve also without stops
  /// True: a guess whose residual meets residual_tolerance is the solution. False: only one whose residual is rounding;
  /// otherwise a structure at rest drifts by the acceleration that the tolerance lets pass, and light parts beside
  /// heavy ones move with a late acceleration.
  bool takes_guess = true;
  /// True: the force of each stop, too, must agree with its linearisation, to eps_r of the force itself and of the
  /// inertia force there. The norms of the whole do not see a stop on a light part.
  bool checks_each_stop = false;
};

/// Solves the equations of motion of one stage of an implicit method by Newton's iteration,
///
///     M a + C v + K x = F(t) + F_c(x),    x = x* + displacement_factor a,    v = v* + velocity_factor a
///
/// with A da = r, A = M + velocity_factor C + displacement_factor (K + K_tangent), until |r| <=
/// eps_r (|F| + |F_c| + |M a| + |C v| + |K x|) and, after the first solve, |dx| <= eps_delta |x|.
/// The system has the size of K for every method.
class StageSolver {
 public:
  StageSolver(dynamics::Dynamics& dynamics, NewtonOptions options);
  virtual ~StageSolver() = default;
  StageSolver(const StageSolver&) = delete;
  StageSolver& operator=(const StageSolver&) = delete;

  /// On entry x, v and a are a guess that satisfies the two relations for x and v; on return they
  /// are the solution.
  time::StepReport solve(double t, double velocity_factor, double displacement_factor, VectorRef x, VectorRef v,
                         VectorRef a);

 protected:
  dynamics::Dynamics& dynamics() const { return dynamics_; }

 private:
  /// The forces f of the stops at displacements w and, if `with_tangent`, their tangent stiffnesses
  /// k.
  virtual void contact(ConstVectorRef w, bool with_tangent, VectorRef f, VectorRef k);
  /// 2-norms of the last correction of x and of x.
  struct Change {
    double correction, x;
  };
  /// Adds the solution in residual_ to a, and to v and x with their factors.
  Change add_correction(double velocity_factor, double displacement_factor, VectorRef x, VectorRef v, VectorRef a);
  /// Whether the residual of every equation is but rounding of the forces in it.
  bool is_rounding(ConstVectorRef x, ConstVectorRef v, ConstVectorRef a);
  /// Whether the stops have the forces that the last solve expected of them.
  bool stops_agree(ConstVectorRef x, ConstVectorRef a) const;
  linalg::ForceBalance evaluate_residual(ConstVectorRef x, ConstVectorRef v, ConstVectorRef a, bool with_tangent);

  dynamics::Dynamics& dynamics_;
  NewtonOptions options_;
  Vector load_, residual_;
  Vector stop_displacement_, stop_force_, stop_tangent_, stop_stiffness_;
  Vector expected_force_;  ///< of the stops, by the linearisation of the last solve
  Vector masses_;          ///< diagonal of M; empty unless options_.checks_each_stop
  Vector magnitudes_;
};

}  // namespace butee::integrators
