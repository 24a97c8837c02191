#include "butee/linalg/lanczos.hpp"

#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymGEigsShiftSolver.h>
#include <algorithm>
#include <utility>

#include <Eigen/SparseCholesky>

namespace butee::linalg {

struct ShiftedFactor::Implementation {
  const ExtendedMatrix& stiffness;
  const ExtendedMatrix& mass;
  Eigen::SimplicialLDLT<ExtendedMatrix> factor;
  bool analysed = false;
};

ShiftedFactor::ShiftedFactor(const ExtendedMatrix& stiffness, const ExtendedMatrix& mass)
    : implementation_(new Implementation{stiffness, mass, {}, false}) {}

ShiftedFactor::~ShiftedFactor() = default;

bool ShiftedFactor::factorize(long double shift) {
  auto& [stiffness, mass, factor, analysed] = *implementation_;
  const ExtendedMatrix shifted = stiffness - shift * mass;
  if (!analysed) factor.analyzePattern(shifted);
  analysed = true;
  factor.factorize(shifted);
  return factor.info() == Eigen::Success;
}

Index ShiftedFactor::negative_pivots() const {
  return (implementation_->factor.vectorD().array() < 0.0L).count();
}

void ShiftedFactor::solve(const double* b, double* x) const {
  using Column = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  const Index n = implementation_->mass.rows();
  const Column right = Eigen::Map<const Vector>(b, n).cast<long double>();
  Eigen::Map<Vector>(x, n) = Column(implementation_->factor.solve(right)).cast<double>();
}

ExtendedColumns ShiftedFactor::solve(const ExtendedColumns& b) const {
  return implementation_->factor.solve(b);
}

namespace {

constexpr Index kRestarts = 300;
constexpr Index kSpareVectors = 20;

/// The operation for Spectra's iteration.
class Operation {
 public:
  using Scalar = double;

  Operation(const SymmetricMap& map, Index size) : map_(map), size_(size) {}

  Index rows() const { return size_; }
  Index cols() const { return size_; }
  void set_shift(double) {}
  void perform_op(const double* x, double* y) const { map_.apply(x, y); }

 private:
  const SymmetricMap& map_;
  Index size_;
};

/// y := scale P (K - shift M)^-1 x, where P projects out the vectors already found.
class Deflated final : public SymmetricMap {
 public:
  Deflated(const ShiftedFactor& factor, const SparseMatrix& mass, double scale, const Eigen::MatrixXd& found)
      : factor_(factor), scale_(scale), found_(found), weighted_(mass * found) {}

  void apply(const double* x, double* y) const override {
    factor_.solve(x, y);
    Eigen::Map<Vector> result(y, weighted_.rows());
    result *= scale_;
    for (int i = 0; i < 2 && found_.cols() > 0; ++i) result -= found_ * (weighted_.transpose() * result);
  }

 private:
  const ShiftedFactor& factor_;
  double scale_;
  const Eigen::MatrixXd& found_;
  Eigen::MatrixXd weighted_;
};

}  // namespace

Index lanczos_vectors(Index count, Index size) {
  return std::min(size, 2 * count + kSpareVectors);
}

std::optional<Pairs> largest_pairs(const SymmetricMap& map, const SparseMatrix& metric, Index count,
                                   const LanczosLimits& limits) {
  using Product = Spectra::SparseSymMatProd<double>;
  Operation operation(map, metric.rows());
  Product product(metric);
  Spectra::SymGEigsShiftSolver<Operation, Product, Spectra::GEigsMode::ShiftInvert> solver(operation, product, count,
                                                                                           limits.vectors, 0.0);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, limits.restarts, limits.tolerance);
  if (solver.info() != Spectra::CompInfo::Successful) return std::nullopt;
  return Pairs{solver.eigenvalues().cwiseInverse(), solver.eigenvectors()};
}

std::optional<Eigen::MatrixXd> lanczos(const ShiftedFactor& factor, const SparseMatrix& mass, double scale, Index count,
                                       double tolerance, const Eigen::MatrixXd& found) {
  const Deflated map(factor, mass, scale, found);
  auto pairs = largest_pairs(map, mass, count, {lanczos_vectors(count, mass.rows()), kRestarts, tolerance});
  if (!pairs) return std::nullopt;
  return std::move(pairs->vectors);
}

}  // namespace butee::linalg
