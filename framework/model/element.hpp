#pragma once

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
};

}  // namespace butee::model
