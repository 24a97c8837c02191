#pragma once

#include <array>

#include "butee/model/types.hpp"

namespace butee::elements {

/// A linear structure given by its matrices on named degrees of freedom:
///
///     M a + (C + Omega G) v + K x = f
///
/// M is symmetric; K and C need not be; G (kg m2 ..., skew-symmetric) is used if the structure
/// turns. The mass must not be negative; a row without mass on its diagonal gives none to its DOF.
/// Checked in tests/verification/matrices_test.cpp.
class Matrices final : public model::Element {
 public:
  /// The matrices have one row for each of `dofs`; damping and gyroscopic may be 0 x 0.
  Matrices(std::vector<model::NodalDof> dofs, const SparseMatrix& mass, const SparseMatrix& stiffness,
           const SparseMatrix& damping, const SparseMatrix& gyroscopic);

  void claim(model::DofTable& dofs) const override;
  /// Adds entry by entry, so that the pattern is that of the files.
  void assemble(model::MatrixSink& sink) const override;
  Turning turning() const override { return has_gyroscopic_ ? Turning::possible : Turning::never; }

 private:
  /// Entries (row, column) and (column, row) of the four matrices; column <= row.
  struct Pair {
    Index row, column;
    std::array<std::array<double, 2>, 4> values{};
  };
  void add(const Pair& pair, bool turns, model::MatrixSink& sink) const;

  std::vector<model::NodalDof> dofs_;
  std::vector<bool> has_mass_;
  std::vector<Pair> pairs_;
  bool has_gyroscopic_;
};

model::ElementType matrices_type();

}  // namespace butee::elements
