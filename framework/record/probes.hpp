#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "butee/model/base_motion.hpp"
#include "butee/record/accelerations.hpp"
#include "butee/record/element_forces.hpp"
#include "butee/time/simulation.hpp"

namespace butee::record {

/// Evaluates the probes of a run, reading only the DOFs and stops that they need. Forces of
/// elements need all DOFs, forces of contacts those of their nodes.
class BUTEE_EXPORT Probes {
 public:
  /// `dynamics` must outlive this object.
  Probes(const std::vector<model::ProbeRequest>& requests, dynamics::Dynamics& dynamics);
  Probes(const Probes&) = delete;
  Probes& operator=(const Probes&) = delete;

  /// One name for each column: "mid.u".
  const std::vector<std::string>& columns() const { return columns_; }

  /// The dense output that is read: DenseOutput::interpolate(), or trace(), which is cheaper and as
  /// good as the method's own view of its contacts.
  enum class View { output, contacts };

  /// Samples the step at these instants, ascending; take(i, ...) then gives the values at the i-th.
  void sample(const time::AcceptedStep& step, std::span<const double> times, View view = View::output);
  void take(std::size_t instant, std::span<double> values);

  /// The values at `t` in the step, one for each column.
  void evaluate(const time::AcceptedStep& step, double t, std::span<double> values, View view = View::output) {
    sample(step, {&t, 1}, view);
    take(0, values);
  }
  /// The free DOF that a motion or contact force of a node belongs to; negative if it is held or absent.
  static Index dof_of(model::Quantity quantity, model::NodeId node, const dynamics::Dynamics& dynamics);
  /// True if a quantity of a node is measured in another frame than x: in space, or relative to a moving base. `model`
  /// may be null.
  static bool has_base_share(const model::Model* model, const model::DofTable& dofs, model::NodeId node,
                             model::Quantity quantity);
  /// The values in a state.
  void evaluate(const time::State& state, std::span<double> values);

 private:
  /// The source of a column's value: entry `slot` of an instant's samples (x_, v_, a_ or forces_),
  /// or, if there are no samples, the stops [first, last).
  struct Column {
    const std::vector<double>* samples;
    std::size_t slot;
    std::size_t first_stop, last_stop;
    bool is_element_force = false;
    std::vector<model::BaseShare> base{};
  };
  /// One stop on a probed node: slots of its two ends, and the sign of its force there.
  struct ProbedStop {
    Index stop;
    std::size_t slot_a, slot_b;
    double sign;
  };

  static constexpr std::size_t kFixed = static_cast<std::size_t>(-1);

  Column element_force(model::Quantity quantity, const model::ProbeRequest& request);
  std::size_t slot(Index dof);
  void add_stops(Index dof);
  const std::vector<double>* samples_of(model::Quantity quantity) const;
  double contact_force(const Column& column, const double* x);
  void make_room(std::size_t instants);
  void copy(const time::State& state, std::size_t instant);
  void sample_forces(const time::AcceptedStep& step, std::span<const double> times, View view);
  void evaluate_forces(double t, ConstVectorRef x, ConstVectorRef v, std::size_t instant);

  dynamics::Dynamics& dynamics_;
  Accelerations accelerations_;
  std::vector<std::string> columns_;
  std::vector<Column> sources_;
  std::vector<ProbedStop> stops_;
  std::vector<Index> dofs_;
  std::vector<double> x_, v_, a_;
  bool needs_v_ = false, needs_a_ = false, has_base_shares_ = false;
  std::vector<double> times_;                      ///< instants, if base shares need them
  std::unique_ptr<ElementForces> element_forces_;  ///< null if no probe needs one
  std::vector<Index> force_dofs_;                  ///< ElementForces::dofs()
  std::vector<double> force_x_, force_v_;          ///< their motion at several instants
  Vector all_x_, all_v_;                           ///< of all DOFs at one instant, zero apart from force_dofs_
  std::vector<double> forces_;
};

}  // namespace butee::record
