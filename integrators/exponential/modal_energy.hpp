#pragma once

#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/integrator.hpp"
#include "integrators/exponential/breakpoints.hpp"

namespace butee::integrators {

/// The energies of a motion in modal coordinates, the work of loads and the dissipated energy,
/// accumulated from breakpoint to breakpoint.
///
///     kinetic = sum v^2/2,   strain = sum (omega q)^2/2,   work = sum int f v dt,   dissipated = sum 2 delta int v^2
///     dt
///
/// Between two breakpoints each mode, and each load as a function of time, is taken as the cubic
/// through its values and slopes at both. The integral of v^2 is exact for this cubic, that of f v
/// uses Simpson's rule. Their errors, (omega h)^4/720 and (omega h)^4/2880 of the energy
/// transferred in the step, are those of the dense output. Checked in
/// tests/models/modal_energy_test.cpp.
class ModalEnergy {
 public:
  /// Both must outlive it.
  ModalEnergy(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal);

  /// The phases of the harmonic loads at t; q and v must stay valid until the next breakpoint is
  /// passed.
  struct Breakpoint {
    double t;
    const double *q, *v;
    std::span<const Phase> phases;
  };
  void begin(const Breakpoint& point, std::span<const double> instants);
  /// Continues to the next breakpoint. `w`: displacements of the stops there.
  void go_on(const Breakpoint& point, const double* w, bool is_last);
  std::span<const time::EnergyAt> told() const { return told_; }

 private:
  /// The displacement on which a load acts, and its speed.
  struct Path {
    double u = 0.0, v = 0.0;
  };
  /// Copies a breakpoint, whose arrays the next one may reuse.
  void keep(const Breakpoint& point);
  /// Computes the paths of all loads at a breakpoint.
  void find_paths(const Breakpoint& point, std::vector<Path>& paths) const;
  void add_work(const Breakpoint& to);
  void add_dissipation(const Breakpoint& to);

  dynamics::Dynamics& dynamics_;
  const dynamics::ModalSystem& modal_;
  Eigen::ArrayXd double_decay_;
  bool has_decay_;
  /// The last breakpoint.
  double last_t_ = 0.0;
  Eigen::ArrayXd last_q_, last_v_;
  std::vector<Phase> last_phases_;
  std::vector<Path> paths_,
      next_paths_;  ///< two for each harmonic load (cosine and sine), then one for each other load
  double work_ = 0.0, dissipated_ = 0.0;
  std::span<const double> instants_;
  std::vector<time::EnergyAt> told_;
};

}  // namespace butee::integrators
