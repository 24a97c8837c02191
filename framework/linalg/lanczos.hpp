#pragma once

#include <memory>
#include <optional>

#include "butee/linalg/dense_pairs.hpp"

namespace butee::linalg {

/// y := R x for a symmetric matrix R given by its action.
class SymmetricMap {
 public:
  virtual ~SymmetricMap() = default;
  virtual void apply(const double* x, double* y) const = 0;
};

struct LanczosLimits {
  Index vectors = 0;       ///< kept at the same time
  Index restarts = 0;      ///< at most
  double tolerance = 0.0;  ///< of the residuals, relative
};

/// The `count` pairs R G x = nu x whose nu are largest in magnitude, X^T G X = 1, with G symmetric
/// positive semidefinite, by Lanczos' method with restarts (Spectra); nothing if it did not
/// converge. Private to the framework.
///
/// R = (K - s M)^-1 and G = M give the eigenvalues lambda = s + 1 / nu of K x = lambda M x near the
/// shift s; R = M^-1 and G = K give the highest, lambda = nu.
std::optional<Pairs> largest_pairs(const SymmetricMap& map, const SparseMatrix& metric, Index count,
                                   const LanczosLimits& limits);

/// K - shift M as L D L^T in extended precision, for shift-invert iterations. Private to the framework.
class ShiftedFactor {
 public:
  /// The matrices must outlive this object.
  ShiftedFactor(const ExtendedMatrix& stiffness, const ExtendedMatrix& mass);
  ~ShiftedFactor();
  ShiftedFactor(const ShiftedFactor&) = delete;
  ShiftedFactor& operator=(const ShiftedFactor&) = delete;

  /// False if a pivot is zero.
  [[nodiscard]] bool factorize(long double shift);
  /// The number of eigenvalues below the shift, by Sylvester's law of inertia.
  Index negative_pivots() const;
  /// x := (K - shift M)^-1 b
  void solve(const double* b, double* x) const;
  ExtendedColumns solve(const ExtendedColumns& b) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The `count` lowest eigenvectors of K, M outside the span of `found` (M-orthonormal, may have no
/// column) by Lanczos' method with restarts (Spectra) on scale (K - shift M)^-1 M, whose factor is
/// given; a scale near |lambda - shift| keeps the eigenvalues near 1. `tolerance` bounds the
/// relative residuals. Nothing if it did not converge.
std::optional<Eigen::MatrixXd> lanczos(const ShiftedFactor& factor, const SparseMatrix& mass, double scale, Index count,
                                       double tolerance, const Eigen::MatrixXd& found);

/// The number of vectors that lanczos() keeps for `count` pairs of a system of `size`.
Index lanczos_vectors(Index count, Index size);

}  // namespace butee::linalg
