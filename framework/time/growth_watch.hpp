#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "butee/core/bytes.hpp"
#include "butee/time/diagnosis.hpp"
#include "butee/time/integrator.hpp"

namespace butee::time {

/// Detects motion that grows beyond the energy that the loads can have supplied.
///
///     E = v.M v/2 + x.K x/2 + V(stops),   d sqrt(E)/dt <= |F|/sqrt 2,   |F|^2 = F.M^-1 F
///
/// holds for every true motion where damping and stops only dissipate; scenes in which friction, cross terms, damping
/// that turns or negative damping feed the motion are not watched. E is checked after 16, 32
/// ... 256 accepted steps and then after every 256; the bound is evaluated only if E has grown.
/// Energy above the bound is excess. A sequence of checks whose excess adds up to a factor of 100,
/// or an energy that much above the bound since the start, is taken for an instability (a larger
/// factor for explicit methods that control displacements alone). For methods that keep a tolerance, energy below a
/// hundredth of the largest one so far may be errors, and its growth is not counted. Unconditionally stable methods
/// are watched only if there are stops. For methods whose steps follow no tolerance the watch also records how coarse
/// they are. Checked in tests/unit/growth_watch_test.cpp.
class BUTEE_EXPORT GrowthWatch {
 public:
  /// `dynamics` must outlive this object.
  GrowthWatch(dynamics::Dynamics& dynamics, const MethodLimits& limits, const Integrator& integrator);

  void start(const State& state);

  /// Counts an accepted step; checks it if a check is due or it is the last one. True if the run
  /// must end.
  bool step(const State& from, const State& to, double h, bool is_last) {
    if (++count_ < next_look_ && !is_last) return false;
    return look(from, to, h);
  }

  /// How much the motion grew, where, and how to avoid it. To be called after step() returned true.
  std::string describe(const State& state, double h) const;

  /// Saves its state for a snapshot of the run.
  void save(ByteWriter& to) const;
  void restore(ByteReader& from);

  /// Warnings for a run that completed: steps that were stable but too long to be accurate.
  std::vector<std::string> warnings() const;

 private:
  void prepare();
  bool look(const State& from, const State& to, double h);
  double energy(const State& state);
  /// The largest energy, J, that loads can have made of an energy at `since`.
  double explained(double energy, double since, double t);
  bool has_grown_since_start(double t, double now);
  /// The largest |F| between two instants, times their distance, divided by sqrt 2.
  double push(double from, double to);
  void find_load_norms();
  void note_coarseness(const State& from, const State& to, double h);

  dynamics::Dynamics& dynamics_;
  MethodLimits limits_;
  bool has_fixed_steps_, may_be_coarse_, is_watching_;
  bool is_fed_ = false;  ///< a negative stiffness supplies energy
  double too_much_;      ///< logarithm of the excess factor that ends a run
  std::vector<double> discontinuities_;
  std::vector<double> load_norms_;  ///< sqrt(p.M^-1 p) of each load's pattern p; empty until first use
  Vector work_, zero_, stops_, stored_;

  std::int64_t count_ = 0, next_look_ = 0;
  double last_time_ = 0.0, last_energy_ = 0.0;
  double excess_ = 0.0;  ///< logarithm of the excess factor since the growth began
  double begin_time_ = 0.0, begin_energy_ = 0.0, start_time_ = 0.0, start_energy_ = 0.0;
  double largest_energy_ = 0.0;
  double sound_energy_ = 0.0;  ///< below this energy nothing has grown since the start, J

  double largest_x_ = 0.0;  ///< largest |x|_M so far
  double coarseness_ = 0.0, coarse_step_ = 0.0, longest_step_ = 0.0;
  bool is_met_ = false;             ///< a stop was closed, or nearly closed, at a check
  double contact_frequency_ = 0.0;  ///< rad/s, lower estimate of the contact frequency of the stiffest stop
};

}  // namespace butee::time
