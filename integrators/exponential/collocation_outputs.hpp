#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "butee/time/integrator.hpp"
#include "integrators/exponential/modal_loads.hpp"

namespace butee::integrators {

/// The highest frequency of damped modes that an output shows.
class FastModes {
 public:
  FastModes(const dynamics::DampedModes& modes, double tolerance);

  double highest() const { return highest_; }  ///< |lambda|, 1/s
  /// The highest |lambda| above `slow` that moves an output of the step by more than the tolerance; else `slow`, 1/s.
  /// `turning` is the largest |dz/dt|/|lambda| of each mode.
  double find(const time::State& from, const time::State& to, double slow, const Eigen::ArrayXd& turning) const;

 private:
  const dynamics::DampedModes& modes_;
  double tolerance_, highest_;
  Eigen::MatrixXd shape_, speed_shape_;  ///< |r_k| and |lambda_k r_k| by DOF and mode, n x p
};

/// The motion of DOFs at the nodes of a step, found when they are first asked for.
class NodeTraces {
 public:
  explicit NodeTraces(const dynamics::DampedModes& modes);

  void reset() { ++step_; }
  using Trace = Eigen::Matrix<double, StepNodes::kCount, Eigen::Dynamic>::ConstColXpr;
  /// x and v of a DOF at the nodes; `nodes` is z there, 2p x 7.
  std::pair<Trace, Trace> of(Index dof, const Eigen::MatrixXd& nodes);

 private:
  const dynamics::DampedModes& modes_;
  std::uint64_t step_ = 0;
  std::vector<std::uint64_t> found_;
  Eigen::Matrix<double, StepNodes::kCount, Eigen::Dynamic> x_, v_;
};

/// The motion within the steps of ModalCollocation: outputs, traces of contacts, and the instants between which it is
/// near to a quintic.
class CollocationOutputs {
 public:
  /// `memory_begin` is the place of z and the force polynomials in State::memory. All must outlive it.
  CollocationOutputs(const dynamics::DampedModes& modes, const ModalLoads& loads, double tolerance, Index memory_begin);

  /// Takes over an accepted step; `nodes` is z at its nodes, 2p x 7, which must stay until the next call.
  void accept(double begin, double end, const Eigen::MatrixXd& nodes);
  /// Forgets it.
  void reset();

  /// The motion at an instant of any step that was accepted once.
  void interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                   time::Interpolated out);
  /// The same for x and v by the polynomial through the nodes of the step that was accepted last.
  void trace(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
             time::Interpolated out);
  /// The nodes of the step and, if modes or loads turn fast between them, instants that part these turns.
  std::span<const double> breakpoints(const time::State& from, const time::State& to);
  /// The longest step whose breakpoints are few enough, s, if the fastest motion turns as in this one.
  double longest(const time::State& from, const time::State& to) const;

 private:
  const double* modal(const time::State& state) const { return state.memory.data() + memory_begin_; }
  bool holds(const time::State& from, const time::State& to) const { return from.t == begin_ && to.t == end_; }
  std::optional<Index> node_at(const time::State& from, const time::State& to, double t) const;
  /// Makes z_ the motion at an instant, and rate_ its rate where that is wanted.
  void find(const time::State& from, const time::State& to, double t, bool wants_rate);
  /// z at a place within a step.
  void move_to(const time::State& from, const time::State& to, double place, Eigen::VectorXd& z) const;
  /// dz/dt where the motion is z.
  void find_rate(double t, double place, const double* forces, const Eigen::VectorXd& z, Eigen::VectorXd& rate) const;
  /// FastModes::find() for the step.
  double find_fastest(const time::State& from, const time::State& to, double slow) const;

  const dynamics::DampedModes& modes_;
  const ModalLoads& loads_;
  double tolerance_;
  Index memory_begin_;
  FastModes fast_;
  NodeTraces traces_;
  double begin_ = 0.0, end_ = -1.0;  ///< s, of the step held
  const Eigen::MatrixXd* nodes_ = nullptr;
  // The motion that was asked for last, since many ask for the same instant, one DOF after the other.
  double instant_ = 0.0;  ///< s; not a number: none
  bool has_rate_ = false;
  Eigen::VectorXd z_, rate_;
  bool is_parted_ = false;  ///< knots_ are those of the step held
  std::vector<double> knots_;
};

}  // namespace butee::integrators
