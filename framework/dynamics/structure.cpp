#include "butee/dynamics/structure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace butee::dynamics {
namespace {

using model::DofTable;
using model::ElementMatrices;
using model::NodalDof;
using Triplet = Eigen::Triplet<long double>;

/// Sums the matrices and the inertia forces of a translation of all nodes.
class SumSink final : public model::MatrixSink {
 public:
  explicit SumSink(const DofTable& dofs) : dofs_(dofs), carried_(Vector::Zero(dofs.free_count())) {}

  void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override {
    for (std::size_t j = 0; j < dofs.size(); ++j)
      for (std::size_t i = 0; i < dofs.size(); ++i) {
        const auto p = static_cast<Index>(i), q = static_cast<Index>(j);
        add_entry(dofs[i], dofs[j], matrices.mass(p, q), matrices.stiffness(p, q));
      }
  }

  linalg::ExtendedMatrix build(std::vector<Triplet>& triplets) const {
    linalg::ExtendedMatrix matrix(dofs_.free_count(), dofs_.free_count());
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    triplets = {};
    return matrix;
  }

  std::vector<Triplet> mass, stiffness;
  const Vector& carried() const { return carried_; }
  double total_mass() const { return total_mass_; }

 private:
  void add_entry(NodalDof row_dof, NodalDof column_dof, double m, double k) {
    const Index row = dofs_.index(row_dof), column = dofs_.index(column_dof);
    if (column_dof.kind == DofKind::u) {
      if (row_dof.kind == DofKind::u) total_mass_ += m;
      if (row >= 0) carried_[row] += m;
    }
    if (row < 0 || column < 0) return;
    mass.emplace_back(static_cast<int>(row), static_cast<int>(column), m);
    stiffness.emplace_back(static_cast<int>(row), static_cast<int>(column), k);
  }

  const DofTable& dofs_;
  Vector carried_;
  double total_mass_ = 0.0;
};

/// Adds each element's K_e x_e.
class ForceSink final : public model::MatrixSink {
 public:
  ForceSink(const DofTable& dofs, const Eigen::MatrixXd& x, bool with_rounding, Structure::Elastic& result)
      : dofs_(dofs), x_(x), with_rounding_(with_rounding), result_(result) {}

  void add(std::span<const NodalDof> dofs, const ElementMatrices& matrices) override {
    if (matrices.stiffness.isZero(0.0)) return;
    stiffness_ = matrices.stiffness.cast<long double>();
    gather(dofs);
    strained_ = own_;
    for (const DofKind kind : {DofKind::ux, DofKind::uy, DofKind::uz}) {
      if (!is_free_to_translate(dofs, kind, matrices.stiffness)) continue;
      std::size_t first = 0;
      while (dofs[first].kind != kind) ++first;
      for (std::size_t i = 0; i < dofs.size(); ++i)
        if (dofs[i].kind == kind) strained_.row(static_cast<Index>(i)) -= own_.row(static_cast<Index>(first));
    }
    forces_.noalias() = stiffness_.lazyProduct(strained_);
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (const Index row = dofs_.index(dofs[i]); row >= 0)
        result_.forces.row(row) += forces_.row(static_cast<Index>(i));
    if (with_rounding_) add_rounding();
  }

 private:
  void gather(std::span<const NodalDof> dofs) {
    own_.setZero(static_cast<Index>(dofs.size()), x_.cols());
    for (std::size_t i = 0; i < dofs.size(); ++i)
      if (const Index row = dofs_.index(dofs[i]); row >= 0)
        own_.row(static_cast<Index>(i)) = x_.row(row).cast<long double>();
  }

  /// True if this holds to the last bit, as for the framework's two-node elements.
  static bool is_free_to_translate(std::span<const NodalDof> dofs, DofKind kind, const Eigen::MatrixXd& stiffness) {
    int count = 0;
    for (const NodalDof& dof : dofs) count += dof.kind == kind ? 1 : 0;
    if (count < 2) return false;
    for (Index i = 0; i < stiffness.rows(); ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < dofs.size(); ++j)
        if (dofs[j].kind == kind) sum += stiffness(i, static_cast<Index>(j));
      if (sum != 0.0) return false;
    }
    return true;
  }

  /// Adds the effect of rounding in the element's matrix, in x, and in their product.
  void add_rounding() {
    constexpr long double kUnit = std::numeric_limits<double>::epsilon();
    stiffness_ = stiffness_.cwiseAbs().eval();
    own_ = own_.cwiseAbs().eval();
    strained_ = strained_.cwiseAbs().eval();
    for (Index j = 0; j < x_.cols(); ++j) {
      const long double bending = strained_.col(j).dot(stiffness_.lazyProduct(strained_.col(j)));
      const long double largest = own_.col(j).dot(stiffness_.lazyProduct(own_.col(j)));
      const long double moved = own_.col(j).dot(forces_.col(j).cwiseAbs());
      result_.rounding[j] += static_cast<double>(kUnit * (bending + 2.0L * moved + kUnit * largest));
    }
  }

  const DofTable& dofs_;
  const Eigen::MatrixXd& x_;
  bool with_rounding_;
  Structure::Elastic& result_;
  linalg::ExtendedColumns stiffness_, own_, strained_, forces_;
};

}  // namespace

Structure::Structure(const model::Model& model, const DofTable& dofs, std::vector<ClosedStop> closed)
    : model_(model), dofs_(dofs), closed_(std::move(closed)) {
  SumSink sink(dofs);
  visit(sink);
  mass_ = sink.build(sink.mass);
  stiffness_ = sink.build(sink.stiffness);
  carried_ = sink.carried();
  total_mass_ = sink.total_mass();
}

std::optional<Structure> Structure::of(const model::System& system, const SparseMatrix& stiffness) {
  constexpr double kSame = 1e-13;
  if (system.model == nullptr) return std::nullopt;
  std::optional<Structure> structure(std::in_place, *system.model, system.dofs);
  const SparseMatrix difference = structure->stiffness().cast<double>() - stiffness;
  const Vector diagonal = stiffness.diagonal().cwiseAbs();
  for (Index column = 0; column < difference.outerSize(); ++column)
    for (SparseMatrix::InnerIterator entry(difference, column); entry; ++entry)
      if (std::abs(entry.value()) > kSame * std::max(diagonal[entry.row()], diagonal[column])) return std::nullopt;
  return structure;
}

void Structure::visit(model::MatrixSink& sink) const {
  for (const auto& element : model_.elements) element->assemble(sink);
  for (const ClosedStop& stop : closed_) {
    const bool grounded = stop.b == ClosedStop::kGround;
    ElementMatrices matrices(grounded ? 1 : 2);
    matrices.stiffness.setConstant(-stop.stiffness);
    matrices.stiffness.diagonal().setConstant(stop.stiffness);
    const std::array<NodalDof, 2> dofs = {NodalDof{stop.a, stop.dof}, NodalDof{stop.b, stop.dof}};
    sink.add(std::span(dofs).first(grounded ? 1 : 2), matrices);
  }
}

Structure::Elastic Structure::elastic(const Eigen::MatrixXd& x, bool with_rounding) const {
  Elastic result{linalg::ExtendedColumns::Zero(x.rows(), x.cols()), Vector::Zero(x.cols())};
  ForceSink sink(dofs_, x, with_rounding, result);
  visit(sink);
  return result;
}

}  // namespace butee::dynamics
