#pragma once

#include <array>

#include <butee/export.hpp>

#include "butee/core/types.hpp"

namespace butee::linalg {

/// The forces of one instant, or of a block of rows; load, contact and damping are null if absent.
struct ForceTerms {
  const double* load;     ///< F
  const double* contact;  ///< F_c
  const double* inertia;  ///< M a
  const double* damping;  ///< C v
  const double* elastic;  ///< K x
};

/// The residual of the equation of motion, accumulated by blocks of rows.
class BUTEE_EXPORT ForceBalance {
 public:
  /// residual := F + F_c - M a - C v - K x, `count` rows, in one pass.
  void add(const ForceTerms& terms, Index count, double* residual);

  /// |residual| of all rows (2-norm)
  double residual() const;
  /// |F| + |F_c| + |M a| + |C v| + |K x| of all rows (2-norms)
  double scale() const;

 private:
  std::array<double, 5> squares_{};
  double residual_square_ = 0.0;
};

}  // namespace butee::linalg
