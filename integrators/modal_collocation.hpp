#pragma once

#include <list>
#include <optional>

#include "integrators/local_error.hpp"
#include "integrators/modal_response.hpp"

namespace butee::integrators {

/// exponential for structures whose modes are coupled (dashpots, parts that turn, bearings with cross terms) and for
/// contacts in the plane, with dissipation or friction.
///
/// The linear part is exact, in damped modes (dynamics::DampedModes), harmonic loads included. Contact forces, and
/// loads that are no harmonics, are polynomials over a step through their values at Lobatto's six points, found by
/// sweeps: forces, motion of the contacts, forces. With the value in the middle as a seventh point one more sweep
/// follows; what it changes at the end is the error of the step. The motion of a smooth step has order 10. Steps end
/// where a contact changes its phase and where a stop with a kinked law opens or closes.
/// plugins/exponential/COLLOCATION.md derives it.
class ModalCollocation final : public time::Integrator {
 public:
  ModalCollocation(dynamics::Dynamics& dynamics, const Goal& goal);

  const time::StepController* controller() const override { return &control_.controller(); }
  double first_step(const time::State& state) const override;
  bool follows_contact_phases() const override { return true; }
  double event_precision() const override { return event_precision_; }
  time::DenseOutput dense_output() const override { return time::DenseOutput::near_quintic; }
  /// The nodes of the step, between which the motion is near to a quintic.
  std::span<const double> knots(const time::State& from, const time::State& to) const override;

 private:
  using Nodes = Eigen::Matrix<double, Eigen::Dynamic, StepNodes::kCount>;
  /// Responses at all nodes but the first for a length of step.
  struct Table {
    double h;
    std::vector<PlaceResponse> places;
  };
  enum class Outcome { converged, diverged, not_finite };

  void do_start(time::State& state) override;
  time::StepReport do_step(const time::State& from, const time::Step& step, time::State& to) override;
  void do_interpolate(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                      time::Interpolated out) const override;
  void do_trace(const time::State& from, const time::State& to, double t, std::span<const Index> dofs,
                time::Interpolated out) const override;

  const Table& table(double h);
  void find_active(const time::State& from);
  void add_loads(double t, double h);
  /// Sweeps until the forces stay, then estimates the error.
  Outcome sweep(const time::State& from, double h, const Table& table);
  void find_forces(double t, double h, Index node);
  void find_all_forces(double t, double h);
  /// nodes_ := the motion under the polynomials through forces_.
  void move_nodes(const Table& table, const StepNodes::Matrix& coefficients);
  /// error_x_, error_v_: what the end would be without the value in the middle, less what it is.
  void estimate(const time::State& from, double h, const Table& table);
  std::optional<Index> node_at(const time::State& from, const time::State& to, double t) const;
  /// z at a place within an accepted step.
  void move_to(const time::State& from, const time::State& to, double place, Eigen::VectorXd& z) const;
  double force_change(const time::State& from, double h) const;
  /// The part of the step where a stop with a kinked law opens or closes; 1 where none does.
  double first_kink() const;
  /// How far the motion of the contacts between the nodes may be from the polynomial through them, relative to the
  /// scale of the displacements.
  double unresolved(const time::State& from, double h) const;
  const double* modal(const time::State& state) const { return state.memory.data() + memory_begin_; }

  LocalErrorControl control_;
  dynamics::DampedModes modes_;
  double tolerance_, rate_, event_precision_;
  std::vector<TurningLoad> turning_loads_;
  struct OtherLoad {
    const model::TimeFunction* in_time;
    Eigen::VectorXd shape;  ///< 2p
  };
  std::vector<OtherLoad> other_loads_;
  std::vector<Index> contact_dofs_;
  Eigen::ArrayXd reach_;  ///< of each mode: its largest displacement at a contact for |z| = 1
  double fastest_ = 0.0;  ///< of a mass at a contact on its closed stiffness, rad/s
  Vector mobility_;       ///< (M^-1)_dd of each DOF, 1/kg
  bool needs_velocity_ = false;
  Index memory_begin_;  ///< of z and the force polynomials in State::memory

  std::list<Table> tables_;
  // Of the step at hand.
  std::vector<Index> active_;
  Eigen::MatrixXd active_input_, active_displacement_, active_velocity_;
  Nodes load_values_;             ///< of loads that are no harmonics, at the nodes
  Eigen::MatrixXd free_, nodes_;  ///< 2p x 7: z at the nodes without and with contact forces
  Eigen::MatrixXd kept_nodes_, kept_polynomial_;
  Eigen::MatrixXd force_polynomial_, load_polynomial_;  ///< 2p x 7
  Nodes forces_, forces_before_;
  Eigen::MatrixXd moved_, moved_velocity_, coefficients_;
  Vector x_, v_, force_, error_x_, error_v_;
  double step_begin_ = 0.0, step_end_ = -1.0;
  mutable std::array<double, StepNodes::kCount> knots_{};
};

}  // namespace butee::integrators
