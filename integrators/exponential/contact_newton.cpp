#include "integrators/exponential/contact_newton.hpp"

namespace butee::integrators {

ContactNewton::Matrix ContactNewton::inverse(const std::array<double, 7>& closed, const PathCoupling& coupling) const {
  // d(c_2, c_3, c_4) / d(end, speed, middle) of the path
  static constexpr double kShape[3][3] = {{-5.0, 1.0, 16.0}, {14.0, -3.0, -32.0}, {-8.0, 2.0, 16.0}};
  double a[3][3];
  for (std::size_t k = 0; k < 3; ++k) {
    double moved[3], power[3];  // changes of c_2, c_3, c_4 and of the force integrals due to f_k
    for (std::size_t m = 0; m < 3; ++m)
      moved[m] = kShape[m][0] * coupling[0][k] + kShape[m][1] * coupling[1][k] + kShape[m][2] * coupling[2][k];
    for (std::size_t j = 0; j < 3; ++j)
      power[j] = stiffness_ * (closed[j + 2] * moved[0] + closed[j + 3] * moved[1] + closed[j + 4] * moved[2]);
    const ForceMoments moments = moments_from_powers(power[0], power[1], power[2]);
    for (std::size_t j = 0; j < 3; ++j) a[j][k] = moments[j];
    a[k][k] += 1.0;
  }
  // Inverse by the adjugate.
  const double c0 = a[1][1] * a[2][2] - a[1][2] * a[2][1], c1 = a[1][2] * a[2][0] - a[1][0] * a[2][2],
               c2 = a[1][0] * a[2][1] - a[1][1] * a[2][0];
  const double r = 1.0 / (a[0][0] * c0 + a[0][1] * c1 + a[0][2] * c2);
  return {r * c0, r * (a[0][2] * a[2][1] - a[0][1] * a[2][2]), r * (a[0][1] * a[1][2] - a[0][2] * a[1][1]),
          r * c1, r * (a[0][0] * a[2][2] - a[0][2] * a[2][0]), r * (a[0][2] * a[1][0] - a[0][0] * a[1][2]),
          r * c2, r * (a[0][1] * a[2][0] - a[0][0] * a[2][1]), r * (a[0][0] * a[1][1] - a[0][1] * a[1][0])};
}

ContactNewton::Matrix ContactNewton::closed_inverse(const PathCoupling& coupling) const {
  return inverse({1.0, 1.0 / 2, 1.0 / 3, 1.0 / 4, 1.0 / 5, 1.0 / 6, 1.0 / 7}, coupling);
}

}  // namespace butee::integrators
