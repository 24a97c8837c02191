#pragma once

#include <memory>
#include <vector>

#include "butee/core/error.hpp"
#include "butee/dynamics/damped_modes.hpp"
#include "butee/time/integrator.hpp"
#include "integrators/exponential/exponential_step.hpp"
#include "integrators/exponential/single_step.hpp"

namespace butee::integrators {

struct ExponentialOptions {
  double tolerance = 1e-4;  ///< relative to the scale of each component (integrators/error-control.md)
  double run_time = 1.0;    ///< s
  Index modes = 0;          ///< number of lowest modes; 0: all, for large systems 300
  /// The largest number of natural modes that damping, turning parts or cross terms may couple.
  Index most_coupled = dynamics::DampedModes::kMost;
};

/// exponential: the linear part is propagated exactly in modal coordinates; the forces of stops are
/// projected onto polynomials.
///
///     q(t+h) = propagate(q, load) + sum_k R_k(omega h) Phi^T f_k, f_k = (2k+1) int_0^1 P_k(s) F_c(w(s)) ds
///
/// Modes, damping and harmonic or piecewise parabolic loads are integrated without error; without
/// stops a step reaches from one output to the next, or until the fastest motion has turned by kMostTurn.
/// Over a step the force of a stop is projected onto the Legendre polynomials P_0, P_1, P_2 along its
/// path w(s), a quartic through the displacements and speeds at both ends and the displacement in the
/// middle. These values depend on the forces, so that f is found by iteration over the stops near their
/// gaps; it contracts by (h omega_c)^2/26 or faster, omega_c^2 = k_c S M^-1 S^T. Changes of contact
/// within a step are integrated piece by piece; they need no event location.
///
/// The order is 6 away from changes of contact; across them it is 4 with small constants. Step sizes lie on a geometric
/// grid of ratio sqrt(2). They are controlled by the displacement in the middle, which the propagator of half a step
/// gives independently of the path. Checked in tests/models/exponential_test.cpp against 80-bit references. Theory:
/// plugins/exponential/THEORY.md. Sources: energy-preserving collocation by projection, E. Hairer, JNAIAM 5 (2010)
/// 73-84; exponential integrators, M. Hochbruck and A. Ostermann, Acta Numerica 19 (2010) 209-286,
/// doi 10.1017/S0962492910000048.
///
/// `Step` performs the steps: ExponentialStep for any system, SingleStep for one DOF with one stop,
/// with the same arithmetic in scalars. make_exponential() selects it.
template <class Step>
class Exponential final : public time::Integrator, private time::Interpolant {
 public:
  Exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options);

  time::Traits traits() const override {
    return {.handles_load_discontinuities = true, .lands_on_outputs = !step_.has_stops()};
  }
  const time::StepController* controller() const override { return &controller_; }
  double first_step(const time::State& state) const override;

 private:
  class Controller final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport& report) const override { return {true, report.error}; }
  };

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  time::Interpolant& interpolant() override { return *this; }

  time::Interpolation interpolation() const override {
    return step_.has_stops() ? time::Interpolation::near_quintic : time::Interpolation::other;
  }
  std::span<const double> breakpoints(const time::State& from, const time::State& to, time::Detail) override;
  void interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                   time::Interpolated out) override {
    interpolate_all(from, to, {&t, 1}, dofs, out);
  }
  void interpolate_all(const time::State& from, const time::State& to, std::span<const double> times,
                       std::span<const Index> dofs, time::Interpolated out) override;
  std::span<const time::EnergyAt> energies(const time::State& from, const time::State& to,
                                           std::span<const double> instants) override;
  void departure(const time::State& from, const time::State& to, double begin, double end, std::span<const Index> dofs,
                 time::Interpolated out) override;

  /// Takes up to `most` steps from `from` towards `end` and records their breakpoints; no step
  /// begins at or after `until`.
  time::StepReport follow(const time::State& from, double end, int most, double until);
  /// Takes one step that ends at `end` at the latest; false if none fits or none succeeds.
  bool advance(double end, time::StepReport& report);
  double next_load_discontinuity(double t) const;
  /// Lets stops that rest in the middle of their gap leave it with a load that begins now (time::leave_middle()).
  void leave_middle(time::State& state) const;
  int first_index() const;
  /// The length of a step from a state without stops, at most `wanted`, s.
  double longest_without_stops(const time::State& from, double wanted) const;
  /// True if the cache holds this macro step.
  bool holds(const time::State& from, double t_end) const;
  /// The steps of a macro step; they are repeated if the cache holds another one.
  Step& recall(const time::State& from, const time::State& to);

  ExponentialOptions options_;
  Controller controller_;
  dynamics::ModalSystem& modal_;
  std::vector<double> load_kinks_;

  // Cache of the last macro step; dense output refills it for another one.
  Step step_;
  StepSizeControl sizes_;
  double begin_t_ = 0.0, end_t_ = -1.0;
  Vector begin_memory_;
};

/// The smallest tolerance for scenes with elastic stops. Below it the rounding of many short steps on
/// coupled modes adds up to more than the guaranteed error of a run.
inline constexpr double kSmallestWithStops = 1e-8;

/// The tolerance is below what rounding in the modes of this structure allows.
struct ToleranceBelowRounding : InputError {
  using InputError::InputError;
};

/// True if the system needs ModalCollocation whatever its stiffness: modes are coupled, the dashpot of a single DOF is
/// negative, contacts act in the plane or the speed of an unbalance varies. Structures with a negative stiffness need
/// it as well, which make_exponential() sees in their modes.
bool needs_collocation(const model::System& system);

/// Throws InputError for tolerances below kSmallestWithStops and for scenes that ModalCollocation
/// does not support, ToleranceBelowRounding for tolerances below its smallest_tolerance().
std::unique_ptr<time::Integrator> make_exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options);

}  // namespace butee::integrators
