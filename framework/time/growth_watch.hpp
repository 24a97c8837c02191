#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "butee/core/bytes.hpp"
#include "butee/time/diagnosis.hpp"
#include "butee/time/integrator.hpp"

namespace butee::time {

/// Notices motion that grows beyond what the loads can have put into it.
///
///     E = v.M v/2 + x.K x/2 + V(stops),   d sqrt(E)/dt <= |F|/sqrt 2,   |F|^2 = F.M^-1 F
///
/// holds for every true motion, since damping and stops only take energy. E is looked at after 16, 32 ... 256 accepted
/// steps and after every 256 from then on, and the bound is evaluated only where E has grown. What exceeds it is
/// excess; a run of looks that adds up to a hundredfold, or as much above the bound since the start, is no motion of
/// this system (more than that of explicit methods that control displacements alone). Methods that no step makes
/// unstable are watched only where there are stops. Of fixed steps it also notes how coarse they are. Checked in
/// tests/unit/growth_watch_test.cpp.
class BUTEE_EXPORT GrowthWatch {
 public:
  /// `dynamics` must outlive it.
  GrowthWatch(dynamics::Dynamics& dynamics, const MethodLimits& limits, const Integrator& integrator);

  void start(const State& state);

  /// Counts an accepted step and looks at it now and then, and where it is the last; true where the run is to end.
  bool step(const State& from, const State& to, double h, bool is_last) {
    if (++count_ < next_look_ && !is_last) return false;
    return look(from, to, h);
  }

  /// How much it grew, where, and what to do: after step() said so.
  std::string describe(const State& state, double h) const;

  /// What it remembers, for a snapshot of the run.
  void save(ByteWriter& to) const;
  void restore(ByteReader& from);

  /// Of a run that ended well: steps that were stable but too long to be accurate.
  std::vector<std::string> warnings() const;

 private:
  void prepare();
  bool look(const State& from, const State& to, double h);
  double energy(const State& state);
  /// The most that loads can have made of an energy since an instant, J.
  double explained(double energy, double since, double t);
  bool has_grown_since_start(double t, double now);
  /// |F| at its largest between two instants, times their distance, over sqrt 2.
  double push(double from, double to);
  void find_load_norms();
  void note_coarseness(const State& from, const State& to, double h);

  dynamics::Dynamics& dynamics_;
  MethodLimits limits_;
  bool has_fixed_steps_, may_be_coarse_, is_watching_;
  double too_much_;  ///< the logarithm of what ends a run
  std::vector<double> discontinuities_;
  std::vector<double> load_norms_;  ///< sqrt(p.M^-1 p) of each load's pattern p; empty until it is asked for
  Vector work_, zero_, stops_, stored_;

  std::int64_t count_ = 0, next_look_ = 0;
  double last_time_ = 0.0, last_energy_ = 0.0;
  double excess_ = 0.0;  ///< the logarithm of what no load explains, since it began
  double begin_time_ = 0.0, begin_energy_ = 0.0, start_time_ = 0.0, start_energy_ = 0.0;
  double sound_energy_ = 0.0;  ///< below this nothing has grown since the start, J

  double largest_x_ = 0.0;  ///< |x|_M so far
  double coarseness_ = 0.0, coarse_step_ = 0.0, longest_step_ = 0.0;
  bool is_met_ = false;             ///< a stop was closed at a look, or nearly
  double contact_frequency_ = 0.0;  ///< rad/s, an estimate from below of that of the stiffest stop
};

}  // namespace butee::time
