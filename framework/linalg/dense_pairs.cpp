#include "butee/linalg/dense_pairs.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace butee::linalg {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The Cholesky factor of a matrix that is zero far from its diagonal, and products with its inverse, row by row.
class NarrowFactor {
 public:
  explicit NarrowFactor(const SparseMatrix& matrix) : l_(matrix) {
    for (Index j = 0; j < matrix.outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
        width_ = std::max(width_, std::abs(entry.row() - entry.col()));
    for (Index i = 0; i < l_.rows(); ++i)
      for (Index j = first(i); j <= i; ++j) {
        const Index k = std::max(first(i), first(j)), count = j - k;
        const double rest = l_(i, j) - l_.row(i).segment(k, count).dot(l_.row(j).segment(k, count));
        if (i == j && !(rest > 0.0)) {
          is_positive_ = false;
          return;
        }
        l_(i, j) = i == j ? std::sqrt(rest) : rest / l_(j, j);
      }
  }

  bool is_positive() const { return is_positive_; }

  /// x := L^-1 x
  void solve(Rows& x) const {
    for (Index i = 0; i < x.rows(); ++i) {
      for (Index j = first(i); j < i; ++j) x.row(i) -= l_(i, j) * x.row(j);
      x.row(i) /= l_(i, i);
    }
  }

  /// x := L^-T x
  void solve_transposed(Rows& x) const {
    for (Index i = x.rows() - 1; i >= 0; --i) {
      x.row(i) /= l_(i, i);
      for (Index j = first(i); j < i; ++j) x.row(j) -= l_(i, j) * x.row(i);
    }
  }

 private:
  Index first(Index row) const { return std::max<Index>(0, row - width_); }

  Rows l_;  ///< L in its lower half
  Index width_ = 0;
  bool is_positive_ = true;
};

}  // namespace

std::optional<Pairs> dense_pairs(const SparseMatrix& stiffness, const SparseMatrix& mass) {
  const NarrowFactor factor(mass);
  if (!factor.is_positive()) return std::nullopt;
  Rows x(stiffness);
  factor.solve(x);
  x.transposeInPlace();
  factor.solve(x);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(x);
  if (solver.info() != Eigen::Success) return std::nullopt;
  x = solver.eigenvectors();
  factor.solve_transposed(x);
  return Pairs{solver.eigenvalues(), x};
}

std::optional<Pairs> dense_pairs(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return Pairs{solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<Vector> dense_values(const Eigen::MatrixXd& stiffness, const Eigen::MatrixXd& mass) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues();
}

std::optional<Pairs> dense_pairs(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return Pairs{solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix, false);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues();
}

ExtendedColumns extended_vectors(const ExtendedColumns& stiffness, const ExtendedColumns& mass) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<ExtendedColumns> solver(stiffness, mass);
  if (solver.info() != Eigen::Success) return {};
  return solver.eigenvectors();
}

}  // namespace butee::linalg
