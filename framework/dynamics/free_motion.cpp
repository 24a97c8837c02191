#include "butee/dynamics/free_motion.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/SparseCholesky>

#include "butee/linalg/dense_pairs.hpp"

namespace butee::dynamics {
namespace {

/// DOFs that move less than this fraction of the largest are not named.
constexpr double kTakesPart = 0.3;
constexpr std::size_t kNamed = 4;

Vector softest(const SparseMatrix& scaled) {
  if (scaled.rows() <= linalg::kDense) {
    const auto pairs = linalg::dense_pairs(Eigen::MatrixXd(scaled));
    return pairs ? Vector(pairs->vectors.col(0)) : Vector::Ones(scaled.rows());
  }
  // With the smallest pivot d_p, L^T y = e_p gives y^T A y = d_p.
  const Eigen::SimplicialLDLT<SparseMatrix> factor(scaled);
  if (factor.info() != Eigen::Success) return Vector::Ones(scaled.rows());
  Index p = 0;
  factor.vectorD().minCoeff(&p);
  Vector y = Vector::Unit(scaled.rows(), p);
  factor.matrixU().solveInPlace(y);
  return factor.permutationPinv() * y;
}

}  // namespace

std::string describe_motion(ConstVectorRef shape, const model::DofTable& dofs) {
  const auto& free = dofs.free();
  double largest[2] = {0.0, 0.0};
  const auto kind = [&](Index i) { return is_rotation(free[static_cast<std::size_t>(i)].kind) ? 1 : 0; };
  for (Index i = 0; i < shape.size(); ++i) largest[kind(i)] = std::max(largest[kind(i)], std::abs(shape[i]));
  const int wanted = largest[0] > 1e-6 * largest[1] ? 0 : 1;
  std::vector<Index> moving;
  for (Index i = 0; i < shape.size(); ++i)
    if (kind(i) == wanted && std::abs(shape[i]) >= kTakesPart * largest[wanted]) moving.push_back(i);
  std::stable_sort(moving.begin(), moving.end(),
                   [&](Index a, Index b) { return std::abs(shape[a]) > 1.001 * std::abs(shape[b]); });
  std::string text;
  for (std::size_t i = 0; i < std::min(moving.size(), kNamed); ++i) {
    if (i > 0) text += ", ";
    text += dofs.name(free[static_cast<std::size_t>(moving[i])]);
  }
  if (moving.size() > kNamed) text += " and " + std::to_string(moving.size() - kNamed) + " more";
  return text;
}

std::string describe_softest_motion(const SparseMatrix& matrix, const model::DofTable& dofs) {
  Vector scale(matrix.rows());
  for (Index i = 0; i < scale.size(); ++i) {
    const double diagonal = std::abs(matrix.coeff(i, i));
    scale[i] = diagonal > 0.0 && std::isfinite(diagonal) ? 1.0 / std::sqrt(diagonal) : 1.0;
  }
  const SparseMatrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  Vector shape = softest(scaled);
  // Not a common motion of several DOFs: one of them alone has too little mass or stiffness to be
  // represented.
  if (constexpr double kDistinct = 1e-6; shape.dot(scaled * shape) > kDistinct * shape.squaredNorm()) {
    Index largest = 0;
    scale.maxCoeff(&largest);
    shape = Vector::Unit(matrix.rows(), largest);
  } else {
    shape = shape.cwiseProduct(scale);
  }
  if (!shape.allFinite()) shape.setOnes();
  return describe_motion(shape, dofs);
}

}  // namespace butee::dynamics
