#include "butee/dynamics/static_shapes.hpp"

#include <cmath>
#include <optional>

#include "butee/linalg/counters.hpp"
#include "butee/linalg/dense_pairs.hpp"
#include "butee/linalg/linear_solver.hpp"

namespace butee::dynamics {
namespace {

constexpr double kSpring = 1e-4;
/// Displacements whose squared remainder is below this, relative to the others of unit length, are
/// linearly dependent.
constexpr double kDependent = 1e-10;

/// Removes the modes from the columns; twice, to remove the rounding too.
void free_of(const Eigen::MatrixXd& modes, const Eigen::MatrixXd& weighted, Eigen::MatrixXd& columns) {
  for (int i = 0; i < 2; ++i) columns -= modes * (weighted.transpose() * columns);
}

/// A basis of the columns' span with X^T M X = 1.
std::optional<Eigen::MatrixXd> orthonormal(const SparseMatrix& mass, Eigen::MatrixXd columns) {
  for (Index j = 0; j < columns.cols(); ++j) {
    const double length = std::sqrt(columns.col(j).dot(mass * columns.col(j)));
    if (length > 0.0) columns.col(j) /= length;
  }
  const Eigen::MatrixXd gram = columns.transpose() * (mass * columns);
  const auto pairs = linalg::dense_pairs(gram);
  if (!pairs) return std::nullopt;
  Index first = 0;
  while (first < pairs->values.size() && !(pairs->values[first] > kDependent)) ++first;
  const Index kept = pairs->values.size() - first;
  const Eigen::MatrixXd turned = pairs->vectors.rightCols(kept);
  return columns * turned * pairs->values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace

Vector add_static_shapes(const model::System& system, const Eigen::MatrixXd& forces, Modes& modes) {
  const double last = modes.frequencies.maxCoeff(), spring = kSpring * last * last;
  SparseMatrix stiffness = system.stiffness;
  stiffness.coeffs() += spring * system.mass.coeffs();
  linalg::Counters counters;
  linalg::LinearSolver solver(stiffness, counters);
  if (!solver.factorize(stiffness)) return {};
  Eigen::MatrixXd moved = forces;
  for (Index j = 0; j < moved.cols(); ++j) solver.solve(moved.col(j));

  const Eigen::MatrixXd weighted = system.mass * modes.shapes;
  const Vector all = forces.cwiseProduct(moved).colwise().sum();
  free_of(modes.shapes, weighted, moved);
  const Vector left_out = forces.cwiseProduct(moved).colwise().sum();
  const auto basis = orthonormal(system.mass, std::move(moved));
  if (!basis) return {};
  Eigen::MatrixXd shapes = *basis;
  free_of(modes.shapes, weighted, shapes);
  const auto pairs = linalg::dense_pairs(shapes.transpose() * (system.stiffness * shapes),
                                         shapes.transpose() * (system.mass * shapes));
  if (!pairs) return {};

  const Index kept = modes.frequencies.size(), added = pairs->values.size();
  modes.frequencies.conservativeResize(kept + added);
  modes.frequencies.tail(added) = pairs->values.cwiseMax(0.0).cwiseSqrt();
  modes.shapes.conservativeResize(Eigen::NoChange, kept + added);
  modes.shapes.rightCols(added) = shapes * pairs->vectors;
  return all.binaryExpr(left_out, [](double moved_by_all, double moved_by_rest) {
    return moved_by_all > 0.0 ? moved_by_rest / moved_by_all : 0.0;  // a force on fixed nodes alone moves nothing
  });
}

}  // namespace butee::dynamics
