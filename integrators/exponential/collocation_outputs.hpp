#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/exponential/dof_acceleration.hpp"
#include "integrators/exponential/fast_modes.hpp"
#include "integrators/exponential/fast_motion.hpp"
#include "integrators/exponential/lanes.hpp"
#include "integrators/exponential/modal_loads.hpp"
#include "integrators/exponential/modal_superposition.hpp"

namespace butee::integrators {

/// The motion of DOFs at the nodes of a step, computed at the first request: for all DOFs of contacts at once if that
/// goes through the natural modes, else for one DOF after the other.
class NodeTraces {
 public:
  /// `modes` must outlive it; `contacts` are the DOFs of contacts.
  NodeTraces(const dynamics::DampedModes& modes, const std::vector<Index>& contacts);

  void reset() {
    x_.found.assign(x_.found.size(), false);
    v_.found.assign(v_.found.size(), false);
  }
  using Trace = Eigen::Matrix<double, StepNodes::kCount, Eigen::Dynamic>::ConstColXpr;
  /// x or v of a DOF at the nodes; `nodes` holds z there, 2p rows.
  Trace displacement(Index dof, const Lanes& nodes) {
    return of(dof, x_, modes_.displacement(), &ModalSuperposition::displacements, nodes);
  }
  Trace velocity(Index dof, const Lanes& nodes) {
    return of(dof, v_, modes_.velocity(), &ModalSuperposition::velocities, nodes);
  }

 private:
  struct Traces {
    std::vector<char> found;
    Eigen::Matrix<double, StepNodes::kCount, Eigen::Dynamic> at_nodes;
  };
  using Superpose = void (ModalSuperposition::*)(const Lanes&, Lanes&);
  Trace of(Index dof, Traces& traces, const Eigen::MatrixXd& shapes, Superpose superpose, const Lanes& nodes);

  const dynamics::DampedModes& modes_;
  std::vector<Index> contacts_;
  std::vector<char> is_of_contact_;  ///< for each DOF
  ModalSuperposition superposition_;
  Lanes rows_;
  Traces x_, v_;
};

/// The motion within the steps of ModalCollocation: outputs, traces of contacts, and breakpoints
/// between which a quintic approximates it.
class CollocationOutputs final : public time::Interpolant {
 public:
  /// `contacts` are the DOFs of contacts; `memory_begin` is the offset of z and the force polynomials in State::memory.
  /// `modes` and `loads` must outlive it.
  CollocationOutputs(const dynamics::DampedModes& modes, const ModalLoads& loads, const std::vector<Index>& contacts,
                     double tolerance, Index memory_begin);

  /// Sets the current step, an accepted one. `nodes` holds z at its nodes, 2p rows, and must
  /// stay valid until the next call.
  void accept(double begin, double end, const Lanes& nodes);
  /// Discards the current step.
  void reset();

  time::Interpolation interpolation() const override { return time::Interpolation::near_quintic; }
  void interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                   time::Interpolated out) override;
  void interpolate_all(const time::State& from, const time::State& to, std::span<const double> times,
                       std::span<const Index> dofs, time::Interpolated out) override;
  /// x and v at an instant, by the polynomials through the nodes of the step that was accepted last. That of x has the
  /// velocities of both ends: just behind a change of contact the sign of a velocity near 0 decides on the next one.
  void trace(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
             time::Interpolated out) override;
  int trace_parts(const time::State&, const time::State&) override { return kTraceParts; }
  /// The nodes of the step and, if modes or loads rotate fast between them, instants that limit the
  /// angle from one breakpoint to the next; for time::Detail::power equal parts.
  std::span<const double> breakpoints(const time::State& from, const time::State& to, time::Detail detail) override;
  /// The longest steps, s, whose numbers of breakpoints, with accelerations, stay within their limit: from the start of
  /// this step, and from its end, where fast motion has decayed.
  struct Longest {
    double here, next;
  };
  Longest longest(const time::State& from, const time::State& to);

  /// A polynomial of degree 8 has few extremes in a step: 16 instants and the search of dips between them detect its
  /// zeros.
  static constexpr int kTraceParts = 2;

 private:
  const double* modal(const time::State& state) const { return state.memory.data() + memory_begin_; }
  bool holds(const time::State& from, const time::State& to) const { return from.t == begin_ && to.t == end_; }
  std::optional<Index> node_at(const time::State& from, const time::State& to, double t) const;
  /// Fills last_ with the modal coordinates at an instant, and with dz/dt if `wants_rate`.
  void find(const time::State& from, const time::State& to, double t, bool wants_rate);
  /// z at an instant, and at a position within a step.
  void find(const time::State& from, const time::State& to, double t, Eigen::Ref<Eigen::VectorXd> z);
  void move_to(const time::State& from, const time::State& to, double place, Eigen::Ref<Eigen::VectorXd> z);
  /// dz/dt for given z and force polynomials.
  void find_rate(double t, double place, const double* forces, const Eigen::Ref<const Eigen::VectorXd>& z,
                 Eigen::VectorXd& rate) const;
  /// True if the polynomial through the nodes gives the response of a mode to the polynomial forces of a step of length
  /// h, from `begin` to `end`, within `allowed` of its amplitude: the error is at most StepNodes::kProduct of the term
  /// of degree 7. Forces may vary faster than the mode turns.
  bool is_polynomial(Index mode, double h, const double* begin, const double* end, double allowed) const;
  /// Divides the modes for the step: those that the polynomial through the nodes gives, and those of fast_motion_.
  void divide_modes(const time::State& from, const time::State& to);
  /// The largest amplitudes of the fast modes' free motion in the step, at its start unless they grow; those of the
  /// others 0.
  Eigen::ArrayXd free_amplitudes(const time::State& from, const time::State& to);

  const dynamics::DampedModes& modes_;
  const ModalLoads& loads_;
  double tolerance_;
  Index memory_begin_;
  FastModes fast_;
  NodeTraces traces_;
  double begin_ = 0.0, end_ = -1.0;  ///< the current step, s
  const Lanes* nodes_ = nullptr;
  FastMotion fast_motion_;     ///< of the current step
  std::optional<Index> slow_;  ///< the number of modes that the polynomial through the nodes gives; empty before the
                               ///< first request
  Index fast_begin_ = 0;       ///< the first mode of fast_motion_
  // The motion of the last request. Callers often request the same instant for one DOF after
  // another.
  struct Request {
    double instant = 0.0;  ///< s; NaN: none
    bool has_rate = false;
    Eigen::VectorXd z, rate;
  };
  Request last_;
  /// The modal coordinates at the instants of the last request for several, in the first columns.
  struct Batch {
    std::vector<double> times;  ///< empty: none
    Eigen::MatrixXd z;
  };
  Batch batch_;
  std::vector<DofAcceleration::Phase> phases_;
  struct Breakpoints {
    bool is_known = false;  ///< they are those of the current step
    std::vector<double> all;
  };
  std::array<Breakpoints, 4> breakpoints_;  ///< by time::Detail
};

}  // namespace butee::integrators
