#pragma once

#include <array>
#include <vector>

#include "integrators/exponential/change_accounts.hpp"
#include "integrators/exponential/residual_force.hpp"
#include "integrators/exponential/single_record.hpp"
#include "integrators/exponential/step_size.hpp"

namespace butee::integrators {

/// ExponentialStep for one DOF with one stop under harmonic loads: the same arithmetic in scalars.
class SingleStep {
 public:
  /// True for one DOF with one stop under harmonic loads.
  static bool can_take(const dynamics::Dynamics& dynamics);

  SingleStep(dynamics::Dynamics& dynamics, dynamics::ModalSystem& modal, const StepGoal& goal, std::size_t most);

  /// Entries of a state: q, v, ChangeAccounts and LoadPhases.
  Index memory_size() const { return 2 + accounts_.memory_size() + record_.phases().memory_size(); }
  void complete(double t, double* memory) const {
    accounts_.start(t, memory + 2);
    record_.phases().start(memory + 2 + accounts_.memory_size());
  }
  void begin(double t, const double* memory, ContactScale scale);
  void save(double* memory) const;

  Trial attempt_index(int index) {
    const SingleFlow& flow = flows_.on_grid(index);
    return attempt(flow, t() + flow.h);
  }
  Trial attempt_until(double t) { return attempt(flows_.odd(t - record_.last()), t); }
  StepSizeControl::Outcome outcome() const {
    return {tried_.is_contact_free, {tried_.error, goal_.middle * scale_.displacement}, tried_.interpolation_error};
  }
  void accept(double t);
  /// Not needed: one DOF starts from rest as t^2 or t^3, which a cubic represents.
  void expect_motion(int) {}

  double t() const { return record_.last(); }
  const double* q() const { return &now_.q; }
  const double* v() const { return &now_.v; }
  ContactScale scale() const { return scale_; }
  double time_to_contact() const;
  static constexpr bool has_stops() { return true; }

  std::span<const double> breakpoints() const { return record_.inner(); }
  void interpolate(std::span<const double> times, std::span<const Index> dofs, time::Interpolated out) {
    if (!dofs.empty()) record_.interpolate(times, scale_, out);
  }
  std::span<const time::EnergyAt> energies(std::span<const double> instants) { return record_.energies(instants); }

 private:
  /// The displacements at which the stop closes, infinite on a side on which it does not act, and
  /// constant_force_limit(), m.
  struct Gap {
    double upper, lower, limit;
    explicit Gap(const dynamics::ElasticStops& contact);
  };
  struct Tried {
    const SingleFlow* flow = nullptr;
    Oscillator::Point to{};
    bool is_contact_free = false;
    double t_end = 0.0, error = 0.0, interpolation_error = 0.0;
    double change = 0.0;           ///< change_error() of the step, 0 if the stop neither closes nor opens
    std::array<double, 3> path{};  ///< end, h times the end speed, middle, with the force found so far, m
    ForceMoments force{};
  };

  Trial attempt(const SingleFlow& flow, double t_end);
  /// Iterates for the force along the path that begins with displacement w and h times speed hv;
  /// tried_.path holds the path without the force.
  Trial iterate(const SingleFlow& flow, double w, double hv);
  /// Bound of |w| over the step, the larger one of the paths with and without the residual force,
  /// m.
  double displacement_bound(const SingleFlow& flow, double w, double hv);
  /// True if outputs on a quintic through the ends are accurate enough.
  bool is_smooth(const SingleFlow& flow, double w);
  /// True if the residual force is constant within its error bound.
  bool is_constant(const SingleFlow& flow, double w, double bound) const;
  /// The stop closes or opens on the path, or both; as ContactGaps::changes().
  bool changes(const ContactPath& path, double w, double end) const {
    if (!(gap_.upper > gap_.lower)) return false;
    const auto side_at = [this](double at) { return at > gap_.upper ? 1 : at < gap_.lower ? -1 : 0; };
    return side_at(w) != side_at(end) || (side_at(w) == 0 && beyond(path) > 0.0);
  }
  /// The bound of a path minus the gap, m; negative if the path stays within the gap.
  double beyond(const ContactPath& path) const {
    return std::max(path.highest() - gap_.upper, gap_.lower - path.lowest());
  }

  StepGoal goal_;
  SingleMode mode_;
  ContactForce contact_;
  ContactNewton newton_;
  ResidualForce residual_;
  Gap gap_;
  double longest_near_;  ///< longest_near_stops(), s
  ChangeAccounts accounts_;
  SingleFlows flows_;
  SingleRecord record_;
  Oscillator::Point now_{};
  ContactScale scale_;
  Tried tried_;
};

}  // namespace butee::integrators
