#pragma once

#include <array>
#include <cstddef>

#include "integrators/exponential/force_moments.hpp"

namespace butee::integrators {

/// Newton's method for the force moments f of one stop, f = projection(path + coupling f); the stop
/// is a spring over fixed parts of the step. Checked in tests/unit/contact_newton_test.cpp.
class ContactNewton {
 public:
  using Matrix = std::array<double, 9>;  ///< 3 x 3, row by row

  explicit ContactNewton(double stiffness) : stiffness_(stiffness) {}

  /// (1 - d projection / d f)^-1
  Matrix inverse(const std::array<double, 7>& closed, const PathCoupling& coupling) const;
  /// The same for a stop that is closed throughout the step.
  Matrix closed_inverse(const PathCoupling& coupling) const;
  /// The correction of f from `old`.
  ForceMoments correction(const Matrix& inverse, const ForceMoments& projected, const ForceMoments& old) const {
    ForceMoments r{};
    for (std::size_t k = 0; k < 3; ++k) r[k] = projected[k] - old[k];
    return {inverse[0] * r[0] + inverse[1] * r[1] + inverse[2] * r[2],
            inverse[3] * r[0] + inverse[4] * r[1] + inverse[5] * r[2],
            inverse[6] * r[0] + inverse[7] * r[1] + inverse[8] * r[2]};
  }

 private:
  double stiffness_;
};

}  // namespace butee::integrators
