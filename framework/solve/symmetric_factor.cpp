#include "butee/solve/symmetric_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include <suitesparse/cholmod.h>

#include "butee/core/error.hpp"
#include "butee/solve/symmetric_product.hpp"

namespace butee::solve {

struct SymmetricFactor::Implementation {
  explicit Implementation(Counters& shared) : counters(&shared) {
    cholmod_start(&common);
    common.print = 0;
    common.nmethods = 1;
  }
  ~Implementation() {
    cholmod_free_dense(&solution, &common);
    cholmod_free_dense(&forward, &common);
    cholmod_free_dense(&backward, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  bool has_positive_pivots() const;

  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  cholmod_dense *solution = nullptr, *forward = nullptr, *backward = nullptr;
  Counters* counters;
};

namespace {

/// Up to this bandwidth, that of chains of beams, the natural order has hardly any fill-in and spares a permutation.
constexpr Index kNarrowBand = 8;

/// CHOLMOD reads the upper triangle of the full matrix, which it takes as it is where nothing is permuted.
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
  if (factor->is_ll) return factor->minor >= factor->n;
  const auto* column = static_cast<const int*>(factor->p);
  const auto* values = static_cast<const double*>(factor->x);
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < factor->n; ++j) {
    const double pivot = values[column[j]];
    if (!(pivot > 0.0)) return false;
    smallest = std::min(smallest, pivot);
  }
  return std::isfinite(smallest);
}

void SymmetricFactor::solve(Eigen::Ref<Eigen::MatrixXd> b) {
  Implementation& own = *implementation_;
  cholmod_dense right{};
  right.nrow = static_cast<std::size_t>(b.rows());
  right.ncol = static_cast<std::size_t>(b.cols());
  right.d = static_cast<std::size_t>(b.outerStride());
  right.nzmax = right.d * right.ncol;
  right.x = b.data();
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  own.counters->solves += b.cols();
  cholmod_solve2(CHOLMOD_A, own.factor, &right, nullptr, &own.solution, nullptr, &own.forward, &own.backward,
                 &own.common);
  if (own.common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  b = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(own.solution->x), b.rows(), b.cols());
}

}  // namespace butee::solve
