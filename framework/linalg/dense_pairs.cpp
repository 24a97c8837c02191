#include "butee/linalg/dense_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <Eigen/Eigenvalues>

namespace butee::linalg {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The Cholesky factor of a matrix that is zero far from its diagonal, and products with its
/// inverse, row by row.
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

/// The connected part of each row, numbered from 0: rows joined by a nonzero entry share one.
std::vector<Index> parts_of(const SparseMatrix& stiffness, const SparseMatrix& mass, Index& count) {
  std::vector<Index> root(static_cast<std::size_t>(mass.rows()));
  std::iota(root.begin(), root.end(), Index{0});
  const auto find = [&root](Index i) {
    while (root[static_cast<std::size_t>(i)] != i)
      i = root[static_cast<std::size_t>(i)] = root[static_cast<std::size_t>(root[static_cast<std::size_t>(i)])];
    return i;
  };
  for (const SparseMatrix* matrix : {&stiffness, &mass})
    for (Index j = 0; j < matrix->outerSize(); ++j)
      for (SparseMatrix::InnerIterator entry(*matrix, j); entry; ++entry) {
        if (entry.value() == 0.0) continue;
        const Index a = find(entry.row()), b = find(entry.col());
        root[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
      }
  // The root is the first row of its part.
  count = 0;
  std::vector<Index> part(root.size());
  for (std::size_t i = 0; i < root.size(); ++i) {
    const Index first = find(static_cast<Index>(i));
    part[i] = first == static_cast<Index>(i) ? count++ : part[static_cast<std::size_t>(first)];
  }
  return part;
}

std::optional<Pairs> pairs_of_part(const SparseMatrix& stiffness, const SparseMatrix& mass) {
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

/// Each vector is nonzero in only one part, so that rounding does not mix parts with equal values.
std::optional<Pairs> pairs_of_parts(const SparseMatrix& stiffness, const SparseMatrix& mass,
                                    const std::vector<Index>& part, Index count) {
  const Index size = mass.rows();
  Pairs all{Vector(size), Eigen::MatrixXd::Zero(size, size)};
  Index filled = 0;
  for (Index k = 0; k < count; ++k) {
    std::vector<Index> rows;
    for (Index i = 0; i < size; ++i)
      if (part[static_cast<std::size_t>(i)] == k) rows.push_back(i);
    const auto of_part = static_cast<Index>(rows.size());
    std::vector<Eigen::Triplet<double>> taken;
    for (Index j = 0; j < of_part; ++j) taken.emplace_back(rows[static_cast<std::size_t>(j)], j, 1.0);
    SparseMatrix take(size, of_part);
    take.setFromTriplets(taken.begin(), taken.end());
    const auto pairs = pairs_of_part(take.transpose() * stiffness * take, take.transpose() * mass * take);
    if (!pairs) return std::nullopt;
    all.values.segment(filled, of_part) = pairs->values;
    all.vectors(rows, Eigen::seqN(filled, of_part)) = pairs->vectors;
    filled += of_part;
  }
  std::vector<Index> order(static_cast<std::size_t>(size));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return all.values[a] < all.values[b]; });
  return Pairs{all.values(order), all.vectors(Eigen::all, order)};
}

}  // namespace

std::optional<Pairs> dense_pairs(const SparseMatrix& stiffness, const SparseMatrix& mass) {
  Index count = 0;
  const std::vector<Index> part = parts_of(stiffness, mass, count);
  if (count > 1) return pairs_of_parts(stiffness, mass, part, count);
  return pairs_of_part(stiffness, mass);
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

std::optional<ExtendedPairs> extended_pairs(const ExtendedColumns& stiffness, const ExtendedColumns& mass) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<ExtendedColumns> solver(stiffness, mass);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return ExtendedPairs{solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace butee::linalg
