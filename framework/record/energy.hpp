#pragma once

#include "butee/time/simulation.hpp"

namespace butee::record {

/// The mechanical energy of a state, J.
struct Energy {
  double kinetic = 0.0;  ///< v.M v / 2
  double strain = 0.0;   ///< x.K x / 2
  double contact = 0.0;  ///< sum of U(w), zero at w = 0

  double total() const { return kinetic + strain + contact; }
};

BUTEE_EXPORT Energy energy_of(const time::State& state, solve::Dynamics& dynamics);

/// Follows the work of the loads and the dissipation over a run.
///
///     work = int v.F dt,   dissipated = int v.C v dt
///
/// by Simpson's rule on every accepted step, its middle from the method's own interpolant: fourth order, so that the
/// balance shows the method's error and not the quadrature's. The balance error is (change + dissipated - work) /
/// largest energy.
class BUTEE_EXPORT EnergyRecorder final : public time::Observer {
 public:
  /// `dynamics` must outlive it.
  explicit EnergyRecorder(solve::Dynamics& dynamics);

  void start(const time::State& state) override;
  void step(const time::AcceptedStep& step) override;
  bool watches_every_step() const override { return true; }
  void save(ByteWriter& to) const override;
  void restore(ByteReader& from) override;

  double work() const { return work_; }
  double dissipated() const { return dissipated_; }
  /// Zero where there never was any energy.
  double balance_error() const;

 private:
  struct Power {
    double of_loads, of_damping;
  };
  Power power(double t, const Vector& v);

  solve::Dynamics& dynamics_;
  std::vector<Index> all_;
  Vector middle_, force_;
  Power last_{};
  double first_total_ = 0.0, last_total_ = 0.0, largest_ = 0.0;
  double work_ = 0.0, dissipated_ = 0.0;
};

}  // namespace butee::record
