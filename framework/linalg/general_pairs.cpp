#include "butee/linalg/general_pairs.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

// LAPACK's driver for general matrices; Eigen's EigenSolver<MatrixXd> is as fast, but took 15 s to compile and gave up
// now and then where pairs lie close together.
extern "C" void dgeev_(const char* left, const char* right, const int* n, double* a, const int* stride, double* real,
                       double* imaginary, double* left_vectors, const int* left_stride, double* right_vectors,
                       const int* right_stride, double* work, const int* room, int* info);

namespace butee::linalg {
namespace {

/// The eigenvalues, and the vectors in LAPACK's form: of a complex pair the first column holds the real parts and the
/// second one the imaginary parts.
struct RealForm {
  Eigen::VectorXd real, imaginary;
  Eigen::MatrixXd vectors;
};

std::optional<RealForm> real_form(Eigen::MatrixXd matrix, bool with_vectors) {
  if (!matrix.allFinite()) return std::nullopt;
  const int n = static_cast<int>(matrix.rows()), one = 1;
  RealForm form{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::MatrixXd(with_vectors ? n : 0, with_vectors ? n : 0)};
  if (n == 0) return form;
  const char* const right = with_vectors ? "V" : "N";
  const int stride = with_vectors ? n : one;
  int info = 0;
  const auto solve = [&](double* work, int room) {
    dgeev_("N", right, &n, matrix.data(), &n, form.real.data(), form.imaginary.data(), nullptr, &one,
           form.vectors.data(), &stride, work, &room, &info);
  };
  double wanted = 0.0;
  solve(&wanted, -1);
  Eigen::VectorXd work(static_cast<Index>(wanted));
  solve(work.data(), static_cast<int>(work.size()));
  if (info != 0) return std::nullopt;
  return form;
}

Eigen::VectorXcd values_of(const RealForm& form) {
  Eigen::VectorXcd values(form.real.size());
  values.real() = form.real;
  values.imag() = form.imaginary;
  return values;
}

}  // namespace

std::optional<ComplexPairs> general_pairs(const Eigen::MatrixXd& matrix) {
  const std::optional<RealForm> form = real_form(matrix, true);
  if (!form) return std::nullopt;
  ComplexPairs pairs{values_of(*form), form->vectors.cast<std::complex<double>>()};
  for (Index k = 0; k < matrix.cols(); ++k)
    if (form->imaginary[k] > 0.0) {
      pairs.vectors.col(k).imag() = form->vectors.col(k + 1);
      pairs.vectors.col(k + 1) = pairs.vectors.col(k).conjugate();
    }
  return pairs;
}

std::optional<ExtendedComplexPairs> general_pairs(const ExtendedColumns& matrix) {
  const Eigen::EigenSolver<ExtendedColumns> solver(matrix);
  if (solver.info() != Eigen::Success) return std::nullopt;
  ExtendedComplexPairs pairs{solver.eigenvalues(), solver.eigenvectors(), {}};
  pairs.inverse = pairs.vectors.partialPivLu().inverse();
  return pairs;
}

std::optional<Eigen::VectorXcd> eigenvalues(const Eigen::MatrixXd& matrix) {
  const std::optional<RealForm> form = real_form(matrix, false);
  if (!form) return std::nullopt;
  return values_of(*form);
}

}  // namespace butee::linalg
