#pragma once

#include <optional>
#include <span>
#include <vector>

namespace butee::integrators {

/// Finds the first sign change of a polynomial in (0, 1). None is missed, except two that rounding does not
/// separate.
///
/// The polynomial is written in Bernstein form, whose coefficients bound it. Without a sign change
/// among the coefficients there is no root; with one sign change there is exactly one root;
/// otherwise the interval is halved (de Casteljau). Source: J. M. Lane and R. F. Riesenfeld, BIT 21
/// (1981) 112-117.
class PolynomialRoot {
 public:
  /// For polynomials up to degree `degree`.
  explicit PolynomialRoot(int degree);

  /// `coefficients` of 1, s, s^2, ...; the first nonzero one determines the sign at the start.
  std::optional<double> first(std::span<const double> coefficients);

 private:
  std::optional<double> search(std::size_t depth, double begin, double end);
  double refine(double begin, double end) const;
  double value(double s) const;

  std::vector<double> binomial_ratio_;  ///< C(j, k)/C(d, k), row j, column k
  std::size_t size_;
  std::vector<double> polynomial_;
  double start_ = 0.0;                          ///< a number of the sign that the polynomial has at the start
  double rounding_ = 0.0;                       ///< of coefficients in Bernstein form
  std::vector<std::vector<double>> bernstein_;  ///< coefficients for each depth of subdivision
};

}  // namespace butee::integrators
