#include "butee/linalg/force_balance.hpp"

#include <cmath>

#include "butee/linalg/kernel/force_sums.hpp"

namespace butee::linalg {

void ForceBalance::add(const ForceTerms& terms, Index count, double* residual) {
  kernel::add_forces()(terms, count, residual, squares_, residual_square_);
}

double ForceBalance::residual() const {
  return std::sqrt(residual_square_);
}

double ForceBalance::scale() const {
  double sum = 0.0;
  for (const double square : squares_) sum += std::sqrt(square);
  return sum;
}

}  // namespace butee::linalg
