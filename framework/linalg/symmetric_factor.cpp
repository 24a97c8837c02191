#include "butee/linalg/symmetric_factor.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include <suitesparse/cholmod.h>

#include "butee/core/error.hpp"
#include "butee/linalg/symmetric_product.hpp"

namespace butee::linalg {

struct SymmetricFactor::Implementation {
  explicit Implementation(Counters& shared) : counters(&shared) {
    cholmod_start(&common);
    common.print = 0;
    common.nmethods = 1;
    common.supernodal = CHOLMOD_SIMPLICIAL;
  }
  ~Implementation() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  bool has_positive_pivots() const;
  /// x := (L D L^T)^-1 x
  void substitute(double* x) const;

  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  Vector permuted;  ///< empty without permutation
  Counters* counters;
};

namespace {

/// Up to this bandwidth, as for chains of beams, the natural order has hardly any fill-in and needs
/// no permutation.
constexpr Index kNarrowBand = 8;

/// CHOLMOD reads the upper triangle of the full matrix, unchanged if there is no permutation.
cholmod_sparse view(const SparseMatrix& matrix) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(matrix.rows());
  view.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  view.p = const_cast<int*>(matrix.outerIndexPtr());
  view.i = const_cast<int*>(matrix.innerIndexPtr());
  view.x = const_cast<double*>(matrix.valuePtr());
  view.stype = 1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

}  // namespace

SymmetricFactor::SymmetricFactor(const SparseMatrix& matrix, Counters& counters)
    : implementation_(std::make_unique<Implementation>(counters)) {
  require(matrix.rows() == matrix.cols() && matrix.isCompressed(), "a factorization takes a compressed square matrix");
  const bool narrow = bandwidth(matrix) <= kNarrowBand;
  implementation_->common.method[0].ordering = narrow ? CHOLMOD_NATURAL : CHOLMOD_AMD;
  implementation_->common.postorder = narrow ? 0 : 1;
  cholmod_sparse a = view(matrix);
  implementation_->factor = cholmod_analyze(&a, &implementation_->common);
  if (implementation_->factor == nullptr) throw std::bad_alloc();
  if (!narrow) implementation_->permuted.resize(matrix.rows());
}

SymmetricFactor::~SymmetricFactor() = default;
SymmetricFactor::SymmetricFactor(SymmetricFactor&&) noexcept = default;
SymmetricFactor& SymmetricFactor::operator=(SymmetricFactor&&) noexcept = default;

bool SymmetricFactor::factorize(const SparseMatrix& matrix) {
  cholmod_sparse a = view(matrix);
  ++implementation_->counters->factorizations;
  cholmod_factorize(&a, implementation_->factor, &implementation_->common);
  if (implementation_->common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  return implementation_->common.status == CHOLMOD_OK && implementation_->has_positive_pivots();
}

bool SymmetricFactor::Implementation::has_positive_pivots() const {
  const auto* start = static_cast<const int*>(factor->p);
  const auto* values = static_cast<const double*>(factor->x);
  for (std::size_t j = 0; j < factor->n; ++j)
    if (!(values[start[j]] > 0.0) || !std::isfinite(values[start[j]])) return false;
  return true;
}

void SymmetricFactor::solve(VectorRef b) {
  ++implementation_->counters->solves;
  if (implementation_->permuted.size() == 0) return implementation_->substitute(b.data());
  const auto* order = static_cast<const int*>(implementation_->factor->Perm);
  Vector& permuted = implementation_->permuted;
  for (Index i = 0; i < b.size(); ++i) permuted[i] = b[order[i]];
  implementation_->substitute(permuted.data());
  for (Index i = 0; i < b.size(); ++i) b[order[i]] = permuted[i];
}

void SymmetricFactor::Implementation::substitute(double* x) const {
  const auto* start = static_cast<const int*>(factor->p);
  const auto* count = static_cast<const int*>(factor->nz);
  const auto* row = static_cast<const int*>(factor->i);
  const auto* value = static_cast<const double*>(factor->x);
  const auto n = static_cast<int>(factor->n);
  // Each column holds its pivot D(j, j) first, then L(i, j) for the rows i > j.
  for (int j = 0; j < n; ++j)
    for (int p = start[j] + 1; p < start[j] + count[j]; ++p) x[row[p]] -= value[p] * x[j];
  for (int j = n - 1; j >= 0; --j) {
    double sum = x[j] / value[start[j]];
    for (int p = start[j] + 1; p < start[j] + count[j]; ++p) sum -= value[p] * x[row[p]];
    x[j] = sum;
  }
}

}  // namespace butee::linalg
