#pragma once

#include <memory>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/exponential/exponential_step.hpp"
#include "integrators/exponential/single_step.hpp"

namespace butee::integrators {

struct ExponentialOptions {
  double tolerance = 1e-4;  ///< relative to the scales of what moves (integrators/error-control.md)
  double run_time = 1.0;    ///< s
  int order = 6;            ///< 2, 4 or 6
  Index modes = 0;          ///< the lowest; 0: all, but of large systems 300
};

/// exponential: the linear part propagated exactly in modal coordinates, the stops by the projection of their force.
///
///     q(t+h) = flow(q, load) + sum_k R_k(omega h) Phi^T f_k,    f_k = (2k+1) int_0^1 P_k(s) F_c(w(s)) ds
///
/// All modes, damping and harmonic or piecewise linear loads are without error; a scene without stops goes from output
/// to output. Over a step the force of a stop is projected onto the Legendre polynomials P_0, P_1, P_2 along its path
/// w(s), a quartic through the displacements and speeds at both ends and the displacement in the middle, of which the
/// forces are a part: f is found by iteration over the stops near their gaps alone, which contracts by
/// (h omega_c)^2/26 or faster, omega_c^2 = k_c S M^-1 S^T. Changes of contact within a step are integrated piece by
/// piece, so that they do not cost the order and need no event location.
///
/// Order 2 (f_0), 4 (f_0, f_1, a cubic path) or 6 away from contact changes and 4 with small constants across them.
/// Step sizes lie on a geometric grid of ratio sqrt 2 and are controlled by the displacement in the middle, which the
/// propagator of half a step gives independently of the path. Checked in tests/models/exponential_test.cpp against
/// 80-bit references. Theory: plugins/exponential/THEORY.md. Sources: energy-preserving collocation by projection,
/// E. Hairer, JNAIAM 5 (2010) 73-84; exponential integrators, M. Hochbruck and A. Ostermann, Acta Numerica 19 (2010)
/// 209-286, doi 10.1017/S0962492910000048.
///
/// `Step` takes the steps: ExponentialStep those of any system, SingleStep those of one DOF with one stop, the same
/// arithmetic in plain numbers. make_exponential() chooses.
template <class Step>
class Exponential final : public time::Integrator {
 public:
  Exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options);

  bool handles_load_discontinuities() const override { return true; }
  const time::StepController* controller() const override { return &controller_; }
  double first_step(const time::State& state) const override;
  bool lands_on_outputs() const override { return !step_.has_stops(); }
  std::span<const double> breakpoints(const time::State& from, const time::State& to) const override;
  std::span<const time::EnergyAt> energies(const time::State& from, const time::State& to,
                                           std::span<const double> instants) const override;
  time::DenseOutput dense_output() const override {
    return step_.has_stops() ? time::DenseOutput::near_quintic : time::DenseOutput::other;
  }
  void departure(const time::State& from, const time::State& to, double begin, double end, std::span<const Index> dofs,
                 time::Interpolated out) const override;

 private:
  class Controller final : public time::StepController {
   public:
    time::StepDecision decide(double, const time::StepReport& report) const override { return {true, report.error}; }
  };

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  void do_interpolate_all(const time::State& from, const time::State& to, std::span<const double> times,
                          std::span<const Index> dofs, time::Interpolated out) const override;

  /// Takes up to `most` steps from `from` towards `end`, with their breakpoints, and none from `until` on.
  time::StepReport follow(const time::State& from, double end, int most, double until) const;
  /// Takes a single one, to `end` at the latest; false where none fits or none can be taken.
  bool advance(double end, time::StepReport& report) const;
  double next_load_discontinuity(double t) const;
  int first_index() const;
  /// The cache holds the macro step.
  bool holds(const time::State& from, double t_end) const;
  /// The steps of a macro step, taken again if it is no longer the last.
  Step& recall(const time::State& from, const time::State& to) const;

  ExponentialOptions options_;
  Controller controller_;
  dynamics::ModalSystem& modal_;
  std::vector<double> load_kinks_;

  // The last macro step: a cache that dense output refills if it asks for another one. Not thread-safe.
  mutable Step step_;
  mutable StepSizeControl sizes_;
  mutable double begin_t_ = 0.0, end_t_ = -1.0;
  mutable Vector begin_memory_;
};

/// The smallest tolerance of modes that no damping couples where stops act: below it the errors of hundreds of impacts,
/// each within its bound, add up to more than the promise. Collocation has an account for them.
inline constexpr double kSmallestWithStops = 1e-8;

/// Throws InputError for tolerances below that, and for what ModalCollocation cannot take.
std::unique_ptr<time::Integrator> make_exponential(dynamics::Dynamics& dynamics, const ExponentialOptions& options);

}  // namespace butee::integrators
