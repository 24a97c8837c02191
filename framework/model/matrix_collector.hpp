#pragma once

#include <vector>

#include "butee/model/system.hpp"

namespace butee::model {

/// Returns why the matrices of an element on `dofs` cannot be assembled, or "": another size, entries that are not
/// finite, stiffness or damping on DOFs that do not exist, a mass that is not symmetric, or gyroscopic moments that do
/// work.
std::string complaint_about(const ElementMatrices& matrices, std::span<const NodalDof> dofs, const DofTable& table);

/// Collects M, K, D, G and W of elements, with one common sequence of places, so that all have the
/// same pattern. Private to the framework.
class MatrixCollector final : public MatrixSink {
 public:
  MatrixCollector(const DofTable& dofs, double rotating_damping) : dofs_(dofs), rotating_damping_(rotating_damping) {}

  void begin_element(bool turns) { turns_ = turns; }
  bool turns() const override { return turns_; }
  void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override;
  /// A place that all matrices have, even if no element does.
  void add_place(Index row, Index column) { add_entry(static_cast<int>(row), static_cast<int>(column), 0.0, 0.0, 0.0); }
  /// Sets the matrices of a system and whether they are symmetric.
  void build(System& system);

 private:
  using Triplet = Eigen::Triplet<double>;

  /// The values of one matrix at the common places, from the first nonzero value on.
  class Entries {
   public:
    void add(const std::vector<Triplet>& places, int i, int j, double value) {
      if (value != 0.0 && !is_used_) {
        is_used_ = true;
        for (const Triplet& place : places) triplets_.emplace_back(place.row(), place.col(), 0.0);
      }
      if (is_used_) triplets_.emplace_back(i, j, value);
    }
    SparseMatrix build(Index n);

   private:
    std::vector<Triplet> triplets_;
    bool is_used_ = false;
  };

  template <class Visit>
  void visit(std::span<const NodalDof> dofs, Visit entry) const;
  void add_turning(std::span<const NodalDof> dofs, const ElementMatrices& matrices);
  void add_entry(int i, int j, double m, double k, double c, double g = 0.0, double w = 0.0) {
    dashpots_.add(mass_, i, j, c);
    gyroscopic_.add(mass_, i, j, g);
    circulatory_.add(mass_, i, j, w);
    mass_.emplace_back(i, j, m);
    stiffness_.emplace_back(i, j, k);
  }

  const DofTable& dofs_;
  double rotating_damping_;
  bool turns_ = false, stiffness_is_symmetric_ = true, damping_is_symmetric_ = true;
  std::vector<Triplet> mass_, stiffness_;
  Entries dashpots_, gyroscopic_, circulatory_;
};

}  // namespace butee::model
