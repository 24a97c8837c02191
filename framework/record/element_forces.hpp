#pragma once

#include <optional>
#include <span>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/model/output_request.hpp"
#include "butee/record/contacts_on.hpp"

namespace butee::record {

/// Forces of single elements: section forces, stresses, spring forces and the reactions of supports.
///
/// Nodes act on an element with p = K x + C v + M a - f, C = mass_proportional M +
/// stiffness_proportional K + dashpots, f the consistent nodal forces of line loads. Accelerations
/// are those of the equation of motion at (t, x, v), so that every node is in balance to rounding
/// with any method: a reaction is the sum of p over the elements at a fixed DOF, minus the loads
/// and stops on it. Modal damping belongs to no element: it acts on nodes as an external force.
/// Checked in tests/unit/element_forces_test.cpp against statics, and against the balance of whole
/// structures.
class BUTEE_EXPORT ElementForces {
 public:
  /// `dynamics`, whose system must have a model, must outlive this object.
  explicit ElementForces(dynamics::Dynamics& dynamics);

  /// Adds a column; columns are numbered from 0.
  void add(model::Quantity quantity, model::NodeId node, const std::string& element);

  std::size_t size() const { return columns_.size(); }
  /// The free DOFs whose motion the columns need, ascending: those of their contacts alone, or all.
  std::vector<Index> dofs() const;

  /// The values at `t` (s) of a motion x, v, one for each column. x and v have an entry for every
  /// free DOF, of which those in dofs() are read.
  void evaluate(double t, ConstVectorRef x, ConstVectorRef v, std::span<double> values);

 private:
  /// factor motion(t) added to entry `place` of x, v or a (order 0, 1, 2) of a piece, if the base
  /// moves.
  struct BaseTerm {
    Index place;
    int order;
    model::BaseShare share;
  };
  /// sqrt((|N|/area + sigma)^2 + 3 (T/torsion_modulus)^2), with sigma = hypot(My, Mz)/modulus_z for
  /// a round section, else |My|/modulus_y + |Mz|/modulus_z.
  struct FibreStress {
    double area, modulus_y, modulus_z;
    double torsion_modulus;  ///< 0: not round
    double of(std::span<const double> forces) const;
  };
  /// A part of an element whose p is needed. Entry i of the matrices belongs to the DOF dofs[i],
  /// negative if it is fixed.
  struct Piece {
    std::vector<Index> dofs;
    Eigen::MatrixXd mass, damping, stiffness;
    Eigen::MatrixXd gyroscopic, circulatory;  ///< for a turning part, else 0 x 0
    Eigen::VectorXd x, v, a, p;
    std::vector<BaseTerm> base;
  };
  struct Share {
    std::size_t piece;
    Eigen::VectorXd weights;
  };
  struct LoadShare {
    const model::TimeFunction* in_time;
    double weight;
  };
  /// constant + sum of weights.p + sum of weight f(t) + part (sum of forces of contacts)
  struct Sum {
    std::vector<Share> shares;
    std::vector<LoadShare> loads;
    ContactsOn contacts;
    double part = 1.0;                                          ///< of the forces of `contacts`
    std::vector<Index> states;                                  ///< contacts whose `quantity` is added
    model::Quantity quantity = model::Quantity::contact_force;  ///< normal force, friction, slip speed or wear power
    double constant = 0.0;
  };
  /// A sum times a factor, or the von Mises stress of a beam's outer fibre from N, T, My and Mz.
  struct Column {
    std::vector<Sum> sums = std::vector<Sum>(1);
    double factor = 1.0;
    std::optional<FibreStress> stress{};
  };

  void add_section_force(model::Quantity quantity, model::NodeId node, const std::string& element, Column& column);
  /// Adds `part` of the forces of all contacts on the DOF.
  void add_contacts(model::NodalDof dof, double part, Sum& sum);
  /// Adds a quantity of the contacts in the plane, with dissipation or friction, at a node.
  void add_states(model::Quantity quantity, model::NodeId node, Sum& sum);
  void need(Index obstacle);
  double sum_of_states(const Sum& of) const;
  void add_springs(model::NodalDof dof, const std::string& element, Sum& sum);
  void add_reaction(model::NodalDof dof, Sum& sum);
  /// Adds sign p of every part of an element at the DOF.
  void add_pieces_at(std::size_t element, model::NodalDof dof, double sign, Sum& sum);
  std::size_t add_piece(std::span<const model::NodalDof> dofs, const model::ElementMatrices& matrices, bool turns);
  /// Adds -weights.f for the loads that act on a beam's part: line loads and loads on its mass.
  void add_loads_of_part(const model::Element* beam, const model::SectionCut& cut, const Eigen::VectorXd& weights,
                         Sum& sum);
  bool turns(std::size_t element) const;
  void evaluate_pieces(double t, ConstVectorRef x, ConstVectorRef v);
  double value_of(const Sum& sum, double t, ConstVectorRef x);
  double force_of_stop(Index stop, ConstVectorRef x);
  void evaluate_contacts(double t, ConstVectorRef x, ConstVectorRef v);

  dynamics::Dynamics& dynamics_;
  const model::Model& model_;
  std::vector<Piece> pieces_;
  std::vector<Column> columns_;
  bool has_mass_ = false;         ///< true if any piece has mass
  std::vector<Index> obstacles_;  ///< of all columns, each once, ascending
  std::vector<dynamics::ContactForces> contacts_;
  Vector a_;
};

}  // namespace butee::record
