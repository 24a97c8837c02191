#include "integrators/polynomial_root.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace butee::integrators {
namespace {

/// Sign changes that intervals of 2^-50 do not separate count as a touch, not as a crossing.
constexpr std::size_t kDeepest = 50;
constexpr int kBisections = 60;
/// Values below this part of the largest coefficient are rounding.
constexpr double kRoundingOfCoefficients = 4.0 * std::numeric_limits<double>::epsilon();

/// Those of `before` and the values; values of at most `rounding` count as 0.
int sign_changes(double before, const std::vector<double>& values, double rounding) {
  int changes = 0;
  double last = before;
  for (const double value : values) {
    if (!(std::abs(value) > rounding)) continue;
    if (std::signbit(last) != std::signbit(value)) ++changes;
    last = value;
  }
  return changes;
}

}  // namespace

PolynomialRoot::PolynomialRoot(int degree) : size_(static_cast<std::size_t>(degree) + 1) {
  binomial_ratio_.assign(size_ * size_, 0.0);
  for (std::size_t j = 0; j < size_; ++j) {
    double ratio = 1.0;
    for (std::size_t k = 0; k <= j; ++k) {
      binomial_ratio_[j * size_ + k] = ratio;
      ratio *= static_cast<double>(j - k) / static_cast<double>(size_ - 1 - k);
    }
  }
  bernstein_.assign(kDeepest + 2, std::vector<double>(size_));
}

std::optional<double> PolynomialRoot::first(std::span<const double> coefficients) {
  std::size_t begin = 0;
  while (begin < coefficients.size() && coefficients[begin] == 0.0) ++begin;
  if (begin == coefficients.size()) return std::nullopt;
  polynomial_.assign(coefficients.begin() + static_cast<std::ptrdiff_t>(begin), coefficients.end());
  polynomial_.resize(size_, 0.0);
  double largest = 0.0;
  for (std::size_t j = 0; j < size_; ++j) {
    double sum = 0.0;
    for (std::size_t k = 0; k <= j; ++k) sum += binomial_ratio_[j * size_ + k] * polynomial_[k];
    bernstein_[0][j] = sum;
    largest = std::max(largest, std::abs(sum));
  }
  rounding_ = kRoundingOfCoefficients * largest;
  start_ = polynomial_[0];
  return search(0, 0.0, 1.0);
}

std::optional<double> PolynomialRoot::search(std::size_t depth, double begin, double end) {
  std::vector<double>& here = bernstein_[depth];
  // The sign before `begin` is that of the start.
  const int changes = sign_changes(start_, here, rounding_);
  const auto after =
      std::find_if(here.begin(), here.end(), [this](double value) { return std::abs(value) > rounding_; });
  if (begin > 0.0 && after != here.end() && std::signbit(*after) != std::signbit(start_)) return begin;
  if (changes == 0) return std::nullopt;
  if (changes == 1) return refine(begin, end);
  if (depth == kDeepest) return std::nullopt;
  const double middle = 0.5 * (begin + end);
  // The first half is stored one level deeper; the second one stays at this level.
  std::vector<double>& left = bernstein_[depth + 1];
  for (std::size_t k = 0; k < size_; ++k) {
    left[k] = here[0];
    for (std::size_t j = 0; j + 1 < size_ - k; ++j) here[j] = 0.5 * (here[j] + here[j + 1]);
  }
  if (const auto root = search(depth + 1, begin, middle)) return root;
  bernstein_[depth + 1] = here;
  return search(depth + 1, middle, end);
}

double PolynomialRoot::refine(double begin, double end) const {
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (begin + end);
    ((value(middle) > 0.0) == (start_ > 0.0) ? begin : end) = middle;
  }
  return end;
}

double PolynomialRoot::value(double s) const {
  double sum = 0.0;
  for (std::size_t k = polynomial_.size(); k > 0; --k) sum = sum * s + polynomial_[k - 1];
  return sum;
}

}  // namespace butee::integrators
