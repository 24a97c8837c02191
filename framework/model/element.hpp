#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "butee/model/dofs.hpp"

namespace butee::model {

/// Matrices on a few DOFs: mass (kg, kg m, kg m2; symmetric), damping (N s/m ...), stiffness (N/m, N, N m).
struct ElementMatrices {
  explicit ElementMatrices(Index size) : mass(Eigen::MatrixXd::Zero(size, size)), damping(mass), stiffness(mass) {}

  Eigen::MatrixXd mass, damping, stiffness;
  /// The matrices of a part that turns at Omega rad/s; a sink asks for them with turns(), and they
  /// are 0 x 0 if there are none. The forces on the element are -Omega gyroscopic v (kg m2,
  /// skew-symmetric) and, for damping that turns with the part, -rotating_damping (v - Omega e_x x
  /// u), with the cross product applied to displacements and to rotations.
  Eigen::MatrixXd gyroscopic{}, rotating_damping{};
};

/// Receives the contributions of elements to the global matrices.
class BUTEE_EXPORT MatrixSink {
 public:
  virtual ~MatrixSink() = default;
  /// `matrices` have the size of `dofs`. Their damping is added to Rayleigh damping: dashpots.
  virtual void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) = 0;
  /// True if the element turns about x, so that its gyroscopic matrix and rotating damping are
  /// needed.
  virtual bool turns() const { return false; }
};

/// One end of a part of a beam; a part lies between two neighbouring nodes.
///
/// The nodes act on the part with p = K x + C v + M a - f, where f are the consistent nodal forces
/// of line loads. The section forces are `resultants` p: the force and the moment that the side of
/// larger x exerts on the side of smaller x, along and about the axes of the beam. In the plane,
/// Vy = V = -E I d3u/dx3 and Mz = M = E I d2u/dx2.
struct SectionCut {
  explicit SectionCut(std::vector<NodalDof> of)
      : dofs(std::move(of)),
        matrices(static_cast<Index>(dofs.size())),
        line_loads(Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(matrices.mass.rows(), 3)),
        resultants(decltype(resultants)::Zero(6, matrices.mass.rows())) {}

  std::vector<NodalDof> dofs;                           ///< of the part
  ElementMatrices matrices;                             ///< of the part
  Eigen::Matrix<double, Eigen::Dynamic, 3> line_loads;  ///< f of line loads of 1 N/m along x, y and z
  /// Rows N, Vy, Vz, T, My, Mz from p; zero if the beam has no such force.
  Eigen::Matrix<double, 6, Eigen::Dynamic> resultants;
  std::optional<double> modulus;    ///< m3: Mz over the stress of the outer fibre, if the section defines that fibre
  std::optional<double> modulus_y;  ///< m3: the same for My
  /// m3: T over the shear stress of the outer fibre; only for round sections, whose modulus is the
  /// same all around.
  std::optional<double> torsion_modulus;
  double area = 0.0;     ///< m2
  double preload = 0.0;  ///< N, the initial axial force; N contains it in addition to its row of `resultants`
};

/// A linear structural element of the scene: a whole beam, a lumped mass, a spring.
class BUTEE_EXPORT Element {
 public:
  virtual ~Element() = default;

  /// Claims the DOFs that it uses and states which of them it gives mass to.
  virtual void claim(DofTable& dofs) const = 0;

  /// Claims further DOFs of its nodes that other elements use; called after every element's
  /// claim().
  virtual void claim_shared(DofTable& dofs) const { (void)dofs; }

  /// Adds its matrices.
  virtual void assemble(MatrixSink& sink) const = 0;

  /// Adds the consistent nodal loads of a line load of 1 N/m along a displacement and returns true;
  /// false if the element has no length or no such displacement.
  virtual bool add_line_load(std::vector<NodalValue>& loads, DofKind along = DofKind::uy) const {
    (void)loads, (void)along;
    return false;
  }

  /// Whether the element turns about x with [rotation]: possible for beams along x and discs;
  /// always for rotating damping.
  enum class Turning { never, possible, always };
  virtual Turning turning() const { return Turning::never; }
  /// Why an element that may turn cannot turn here, or "".
  virtual std::string turning_problem() const { return ""; }

  /// The nodes of a beam in the order of its parts: part i lies between nodes i and i + 1. Empty for other elements.
  virtual std::vector<NodeId> axis() const { return {}; }

  /// The end of part `part` of a beam, or its beginning; empty for other elements.
  virtual std::optional<SectionCut> cut(Index part, bool at_end) const {
    (void)part, (void)at_end;
    return std::nullopt;
  }

  /// The initial axial forces of the parts of a beam, N, tension positive; empty for other
  /// elements.
  virtual std::vector<double> preload() const { return {}; }
  /// Replaces the initial axial forces, one number for each part.
  virtual void set_preload(std::vector<double> forces) { (void)forces; }
  /// True if the initial axial forces must be those of the static position under gravity.
  virtual bool takes_preload_of_gravity() const { return false; }

  /// True if the forces of the element on its nodes are spring forces.
  virtual bool is_spring() const { return false; }
};

}  // namespace butee::model
