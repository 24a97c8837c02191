#include "butee/solve/frequencies.hpp"

#include <Spectra/MatOp/SparseCholesky.h>
#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/MatOp/SymShiftInvert.h>
#include <Spectra/SymGEigsShiftSolver.h>
#include <Spectra/SymGEigsSolver.h>
#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "butee/solve/contact.hpp"

namespace butee::solve {
namespace {

constexpr Index kDense = 200;
/// Of the eigenvectors; a Ritz value is accurate to its square, where the highest eigenvalues of a long beam lie too
/// close for more.
constexpr double kLanczosTolerance = 1e-4;
constexpr int kLanczosVectors = 30;
constexpr int kLanczosRestarts = 200;

using Product = Spectra::SparseSymMatProd<double>;

double frequency(double eigenvalue) {
  return std::sqrt(std::max(eigenvalue, 0.0));
}

std::optional<double> highest_eigenvalue(const SparseMatrix& stiffness, const SparseMatrix& mass) {
  Product product(stiffness);
  Spectra::SparseCholesky<double> cholesky(mass);
  Spectra::SymGEigsSolver<Product, Spectra::SparseCholesky<double>, Spectra::GEigsMode::Cholesky> solver(
      product, cholesky, 1, kLanczosVectors);
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, kLanczosRestarts, kLanczosTolerance);
  if (solver.info() != Spectra::CompInfo::Successful) return std::nullopt;
  return solver.eigenvalues()[0];
}

/// A shift a little below zero keeps the matrix regular where the structure can move as a rigid body.
std::optional<double> lowest_eigenvalue(const SparseMatrix& stiffness, const SparseMatrix& mass, double highest) {
  using Operation = Spectra::SymShiftInvert<double, Eigen::Sparse, Eigen::Sparse>;
  const double shift = -1e-12 * highest;
  Operation operation(stiffness, mass);
  Product product(mass);
  Spectra::SymGEigsShiftSolver<Operation, Product, Spectra::GEigsMode::ShiftInvert> solver(operation, product, 1,
                                                                                           kLanczosVectors, shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, kLanczosRestarts, kLanczosTolerance);
  if (solver.info() != Spectra::CompInfo::Successful) return std::nullopt;
  return solver.eigenvalues()[0];
}

}  // namespace

SparseMatrix stiffness_with_stops(const model::System& system, StopState stops) {
  SparseMatrix stiffness = system.stiffness;
  if (stops == StopState::open) return stiffness;
  Counters counters;
  const Contact contact(system, counters);
  const Vector closed = contact.closed_stiffness();
  for (Index i = 0; i < contact.size(); ++i) {
    const Index a = contact.dof_a(i), b = contact.dof_b(i);
    if (a >= 0) stiffness.coeffRef(a, a) += closed[i];
    if (b >= 0) stiffness.coeffRef(b, b) += closed[i];
    if (a < 0 || b < 0) continue;
    stiffness.coeffRef(a, b) -= closed[i];
    stiffness.coeffRef(b, a) -= closed[i];
  }
  return stiffness;
}

std::optional<FrequencyRange> frequency_range(const model::System& system, StopState stops) {
  const SparseMatrix stiffness = stiffness_with_stops(system, stops);
  if (system.size() <= kDense) {
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(
        Eigen::MatrixXd(stiffness), Eigen::MatrixXd(system.mass), Eigen::EigenvaluesOnly);
    if (solver.info() != Eigen::Success) return std::nullopt;
    return FrequencyRange{frequency(solver.eigenvalues().minCoeff()), frequency(solver.eigenvalues().maxCoeff())};
  }
  const auto highest = highest_eigenvalue(stiffness, system.mass);
  if (!highest) return std::nullopt;
  const auto lowest = lowest_eigenvalue(stiffness, system.mass, *highest);
  if (!lowest) return std::nullopt;
  return FrequencyRange{frequency(*lowest), frequency(*highest)};
}

}  // namespace butee::solve
