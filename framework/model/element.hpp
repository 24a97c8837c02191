#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "butee/model/dofs.hpp"

namespace butee::model {

/// Symmetric matrices on a few DOFs: mass (kg, kg m, kg m2), damping (N s/m ...), stiffness (N/m, N, N m).
struct ElementMatrices {
  explicit ElementMatrices(Index size) : mass(Eigen::MatrixXd::Zero(size, size)), damping(mass), stiffness(mass) {}

  Eigen::MatrixXd mass, damping, stiffness;
};

/// Takes what elements add to the global matrices.
class BUTEE_EXPORT MatrixSink {
 public:
  virtual ~MatrixSink() = default;
  /// `matrices` are of the size of `dofs`. Their damping is what comes on top of Rayleigh damping: dashpots.
  virtual void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) = 0;
};

/// One end of a part of a beam, a part being the stretch between two neighbouring nodes.
///
/// The nodes act on the part with p = K x + C v + M a - f, where f are the consistent nodal forces of line loads. The
/// section forces are `resultants` p: the force and the moment that the side of larger x exerts on the side of smaller
/// x, along and about the axes of the beam. In the plane, Vy = V = -E I d3u/dx3 and Mz = M = E I d2u/dx2.
struct SectionCut {
  explicit SectionCut(std::vector<NodalDof> of)
      : dofs(std::move(of)),
        matrices(static_cast<Index>(dofs.size())),
        line_load(Eigen::VectorXd::Zero(matrices.mass.rows())),
        resultants(decltype(resultants)::Zero(6, matrices.mass.rows())) {}

  std::vector<NodalDof> dofs;  ///< of the part
  ElementMatrices matrices;    ///< of the part
  Eigen::VectorXd line_load;   ///< f of a line load of 1 N/m
  /// Rows N, Vy, Vz, T, My, Mz from p; zero where the beam has no such force.
  Eigen::Matrix<double, 6, Eigen::Dynamic> resultants;
  std::optional<double> modulus;  ///< m3: Mz over the stress of the outer fibre, where the section knows that fibre
};

/// A linear structural element of the model file: a whole beam, a lumped mass, a spring.
class BUTEE_EXPORT Element {
 public:
  virtual ~Element() = default;

  /// Claims the DOFs that it uses and says which of them it gives mass to.
  virtual void claim(DofTable& dofs) const = 0;

  /// Adds its matrices.
  virtual void assemble(MatrixSink& sink) const = 0;

  /// Adds the consistent nodal loads of a line load of 1 N/m and returns true, or false where it has no length.
  virtual bool add_line_load(std::vector<NodalValue>& loads) const {
    (void)loads;
    return false;
  }

  /// The nodes of a beam in the order of its parts: part i lies between nodes i and i + 1. Empty for other elements.
  virtual std::vector<NodeId> axis() const { return {}; }

  /// The end of part `part` of a beam, or its beginning; nothing for other elements.
  virtual std::optional<SectionCut> cut(Index part, bool at_end) const {
    (void)part, (void)at_end;
    return std::nullopt;
  }

  /// True where the forces of the element on its nodes are spring forces.
  virtual bool is_spring() const { return false; }
};

}  // namespace butee::model
