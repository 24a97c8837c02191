#pragma once

#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/time/integrator.hpp"
#include "integrators/modal_knots.hpp"

namespace butee::integrators {

/// The energies of a motion in modal coordinates, the work of its loads and its dissipation, from knot to knot.
///
///     kinetic = sum v^2/2,   strain = sum (omega q)^2/2,   work = sum int f v dt,   dissipated = sum 2 delta int v^2
///     dt
///
/// Between two knots each mode, and each load in time, is the cubic through its values and slopes at both; the
/// integrals are those of these cubics, exactly for v^2 and by Simpson's rule for f v. Their errors, (omega h)^4/720
/// and (omega h)^4/2880 of what is done in the step, are those of the dense output. Checked in
/// tests/models/modal_energy_test.cpp.
class ModalEnergy {
 public:
  /// Both must outlive it.
  ModalEnergy(dynamics::Dynamics& dynamics, const dynamics::ModalSystem& modal);

  /// A knot: the phases of the harmonic loads belong to t, and q and v stay where they are until the next one is taken.
  struct Knot {
    double t;
    const double *q, *v;
    std::span<const Phase> phases;
  };
  void begin(const Knot& knot, std::span<const double> instants);
  /// `w`: the displacements of the stops there.
  void go_on(const Knot& knot, const double* w, bool is_last);
  std::span<const time::EnergyAt> told() const { return told_; }

 private:
  /// A load's share of a motion: the displacement it acts on, and its speed.
  struct Path {
    double u = 0.0, v = 0.0;
  };
  /// Fills paths_ and values_ of a knot.
  void look_at(const Knot& knot, std::vector<Path>& paths) const;
  void add_work(const Knot& to);
  void add_dissipation(const Knot& to);

  dynamics::Dynamics& dynamics_;
  const dynamics::ModalSystem& modal_;
  Eigen::ArrayXd double_decay_;
  bool has_decay_;
  Knot last_{};
  std::vector<Path> paths_, next_paths_;  ///< two of each harmonic load, for its cosine and its sine, then the others
  double work_ = 0.0, dissipated_ = 0.0;
  std::span<const double> instants_;
  std::vector<time::EnergyAt> told_;
};

}  // namespace butee::integrators
