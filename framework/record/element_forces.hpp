#pragma once

#include <span>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/model/output_request.hpp"

namespace butee::record {

/// Forces of single elements: section forces, stresses, spring forces and the reactions of supports.
///
/// Nodes act on an element with p = K x + C v + M a - f, C = mass_proportional M + stiffness_proportional K + dashpots,
/// f the consistent nodal forces of line loads. Accelerations are those of the equation of motion at (t, x, v), so that
/// every node is in balance to rounding, whatever the method: a reaction is the sum of p over the elements at a fixed
/// DOF, less the loads and stops on it. Modal damping belongs to no element: it acts on nodes from outside. Checked in
/// tests/unit/element_forces_test.cpp against statics, and against the balance of whole structures.
class BUTEE_EXPORT ElementForces {
 public:
  /// `dynamics` must outlive it, and its system must have a model.
  explicit ElementForces(dynamics::Dynamics& dynamics);

  /// Adds a column; its number counts from 0.
  void add(model::Quantity quantity, model::NodeId node, const std::string& element);

  std::size_t size() const { return columns_.size(); }

  /// The values at `t` (s) of a motion x, v of all free DOFs, one for each column.
  void evaluate(double t, ConstVectorRef x, ConstVectorRef v, std::span<double> values);

 private:
  /// A part of an element whose p is needed. Entry i of the matrices belongs to the DOF dofs[i], negative where it does
  /// not move.
  struct Piece {
    std::vector<Index> dofs;
    Eigen::MatrixXd mass, damping, stiffness;
    Eigen::VectorXd x, v, a, p;
  };
  struct Share {
    std::size_t piece;
    Eigen::VectorXd weights;
  };
  struct LoadShare {
    const model::TimeFunction* in_time;
    double weight;
  };
  struct StopShare {
    Index stop;
    double sign;
  };
  /// factor (sum of weights.p + sum of weight f(t) + sum of sign F_c), or its magnitude.
  struct Column {
    std::vector<Share> shares;
    std::vector<LoadShare> loads;
    std::vector<StopShare> stops;
    std::vector<Index> obstacles;
    model::Quantity quantity = model::Quantity::contact_force;  ///< of obstacles
    Index dof = model::DofTable::kFixed;                        ///< that contact_force acts on
    double factor = 1.0;
    bool is_magnitude = false;
  };

  void add_section_force(model::Quantity quantity, model::NodeId node, const std::string& element, Column& column);
  /// The contacts in the plane, with dissipation or friction, at a node; its stops beside them for contact_force.
  void add_obstacles(model::Quantity quantity, model::NodeId node, Column& column);
  double sum_of_obstacles(const Column& column) const;
  void add_springs(model::NodalDof dof, const std::string& element, Column& column);
  void add_reaction(model::NodalDof dof, Column& column);
  void add_stops(model::NodeId node, Column& column);
  /// Adds sign p of every part of the element at the DOF.
  void add_pieces_at(const model::Element& element, model::NodalDof dof, double sign, Column& column);
  std::size_t add_piece(std::span<const model::NodalDof> dofs, const model::ElementMatrices& matrices);
  double force_of_stop(Index stop, ConstVectorRef x);

  dynamics::Dynamics& dynamics_;
  const model::Model& model_;
  std::vector<Piece> pieces_;
  std::vector<Column> columns_;
  bool has_mass_ = false;  ///< of any piece
  bool has_obstacles_ = false;
  std::vector<dynamics::ContactForces> contacts_;
  Vector a_;
};

}  // namespace butee::record
