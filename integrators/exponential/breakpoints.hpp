#pragma once

#include <array>
#include <span>
#include <vector>

#include "butee/dynamics/modal_system.hpp"
#include "integrators/exponential/contact_path.hpp"
#include "integrators/exponential/force_moments.hpp"

namespace butee::integrators {

/// cos and sin of the phase angle of a harmonic load at an instant.
struct Phase {
  double cosine, sine;
};

/// The forces of the stops over a step.
struct StepForces {
  bool is_free = true;            ///< no stop exerts a force in the step
  std::array<Vector, 3> moments;  ///< modal forces of P_0, P_1 and P_2, as dynamics::ModalMotion takes them
  Vector constant;                ///< constant residual forces of open stops, N
  std::vector<Index> touched;     ///< stops in contact, or whose residual force jumps
  /// One row for each stop in `touched`: h times the speed at both ends (m), the quartic
  /// coefficient of the path (m), the allowed error of the speed (m/s), and the force moments (N).
  Eigen::ArrayXXd paths;
  enum Column : Index { kStartSpeed, kEndSpeed, kQuartic, kAllowedSpeed, kMoments, kColumns = kMoments + 3 };

  /// Divides the step at `place` (0 to 1); `second` receives the later part. w0 and w1: displacements of the stops at
  /// its ends, m.
  void divide(double place, ConstVectorRef w0, ConstVectorRef w1, StepForces& second);
  /// Fills the row of a stop in `paths`.
  void set(Index stop, const ContactPath& path, const ForceMoments& force, double allowed_speed);
};

/// The breakpoints of a macro step, which separate its steps: instants, modal states, and the
/// forces of each step.
class Breakpoints {
 public:
  /// For up to `most` steps. `modal` must outlive it.
  Breakpoints(const dynamics::ModalSystem& modal, std::size_t most);

  void clear() { times_.clear(); }
  /// Adds a breakpoint and returns its index. `w`: displacements of the stops.
  std::size_t add(double t, const double* q, const double* v, const double* w);

  /// The forces of the step that begins at breakpoint k, to be filled after the breakpoint was
  /// added.
  StepForces& forces(std::size_t k) {
    if (forces_[k].moments.front().size() == 0) make_room(forces_[k]);
    return forces_[k];
  }
  const StepForces& forces(std::size_t k) const { return forces_[k]; }

  std::size_t capacity() const { return forces_.size(); }
  double last() const { return times_.back(); }
  std::size_t steps() const { return times_.size() - 1; }
  double time(std::size_t k) const { return times_[k]; }
  /// The breakpoints strictly within the macro step.
  std::span<const double> inner() const;
  /// The last breakpoint not after t at which a step begins.
  std::size_t before(double t) const;

  /// cos and sin of the harmonic loads at breakpoint k.
  std::span<const Phase> phases(std::size_t k);
  const double* q(std::size_t k) const { return q_.col(static_cast<Index>(k)).data(); }  ///< padded for ModalMotion
  const double* v(std::size_t k) const { return v_.col(static_cast<Index>(k)).data(); }
  auto w(std::size_t k) const { return w_.col(static_cast<Index>(k)); }

 private:
  void make_room(StepForces& forces) const;

  const dynamics::ModalSystem& modal_;
  std::vector<double> times_;
  Eigen::MatrixXd q_, v_, w_;  ///< one column per breakpoint
  std::vector<bool> has_phases_;
  std::vector<Phase> phases_;
  std::vector<StepForces> forces_;
};

}  // namespace butee::integrators
