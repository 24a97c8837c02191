#pragma once

#include <optional>
#include <span>
#include <vector>

namespace butee::integrators {

/// Finds the first sign change of a polynomial in (0, 1], without missing any.
///
/// The polynomial is written in Bernstein form, whose coefficients bound it: without a sign change among them it has no
/// root, with one exactly one; otherwise the interval is halved (de Casteljau). Source: J. M. Lane and R. F.
/// Riesenfeld, BIT 21 (1981) 112-117.
class PolynomialRoot {
 public:
  /// For polynomials of degree `degree` and less.
  explicit PolynomialRoot(int degree);

  /// `coefficients` of 1, s, s^2, ...; the first that is not zero tells the sign at the start.
  std::optional<double> first(std::span<const double> coefficients);

 private:
  std::optional<double> search(std::size_t depth, double begin, double end);
  double refine(double begin, double end) const;
  double value(double s) const;

  std::vector<double> binomial_ratio_;  ///< C(j, k)/C(d, k) by rows j
  std::size_t size_;
  std::vector<double> polynomial_;
  std::vector<std::vector<double>> bernstein_;  ///< by depth
};

}  // namespace butee::integrators
