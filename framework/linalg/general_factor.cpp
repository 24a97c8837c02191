#include "butee/linalg/general_factor.hpp"

#include <limits>
#include <new>

#include <suitesparse/klu.h>

#include "butee/core/error.hpp"

namespace butee::linalg {

struct GeneralFactor::Implementation {
  explicit Implementation(Counters& shared) : counters(&shared) { klu_defaults(&common); }
  ~Implementation() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  klu_common common{};
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
  Counters* counters;
};

GeneralFactor::GeneralFactor(const SparseMatrix& matrix, Counters& counters)
    : implementation_(std::make_unique<Implementation>(counters)) {
  require(matrix.rows() == matrix.cols() && matrix.isCompressed(), "a factorization takes a compressed square matrix");
  auto& self = *implementation_;
  self.symbolic = klu_analyze(static_cast<int>(matrix.rows()), const_cast<int*>(matrix.outerIndexPtr()),
                              const_cast<int*>(matrix.innerIndexPtr()), &self.common);
  if (self.symbolic == nullptr) throw std::bad_alloc();
}

GeneralFactor::~GeneralFactor() = default;
GeneralFactor::GeneralFactor(GeneralFactor&&) noexcept = default;
GeneralFactor& GeneralFactor::operator=(GeneralFactor&&) noexcept = default;

bool GeneralFactor::factorize(const SparseMatrix& matrix) {
  auto& self = *implementation_;
  ++self.counters->factorizations;
  klu_free_numeric(&self.numeric, &self.common);
  self.numeric = klu_factor(const_cast<int*>(matrix.outerIndexPtr()), const_cast<int*>(matrix.innerIndexPtr()),
                            const_cast<double*>(matrix.valuePtr()), self.symbolic, &self.common);
  if (self.common.status == KLU_OUT_OF_MEMORY) throw std::bad_alloc();
  if (self.numeric == nullptr || self.common.status != KLU_OK) return false;
  return klu_rcond(self.symbolic, self.numeric, &self.common) != 0 &&
         self.common.rcond > std::numeric_limits<double>::epsilon();
}

void GeneralFactor::solve(VectorRef b) {
  auto& self = *implementation_;
  ++self.counters->solves;
  klu_solve(self.symbolic, self.numeric, static_cast<int>(b.size()), 1, b.data(), &self.common);
}

}  // namespace butee::linalg
