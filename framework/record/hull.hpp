#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace butee::record {

/// A polynomial of degree up to 5 on [0, 1] by its Bernstein coefficients, whose least and greatest bound it.
class Hull {
 public:
  /// As many as `coefficients`; the first and the last are the values at 0 and 1.
  template <std::size_t Count>
  explicit Hull(const std::array<double, Count>& coefficients) : degree_(Count - 1) {
    static_assert(Count >= 2 && Count <= 6);
    std::copy(coefficients.begin(), coefficients.end(), c_.begin());
  }

  double first() const { return c_[0]; }
  double last() const { return c_[degree_]; }
  std::pair<double, double> bounds() const {
    double least = c_[0], greatest = c_[0];
    for (std::size_t i = 1; i <= degree_; ++i) {
      least = std::min(least, c_[i]);
      greatest = std::max(greatest, c_[i]);
    }
    return {least, greatest};
  }
  /// De Casteljau's rule at 1/2; this becomes the first half.
  Hull split() {
    Hull second = *this;
    for (std::size_t round = 1; round <= degree_; ++round) {
      for (std::size_t i = 0; i + round <= degree_; ++i) second.c_[i] = 0.5 * (second.c_[i] + second.c_[i + 1]);
      c_[round] = second.c_[0];
    }
    return second;
  }
  /// The derivative, times h.
  Hull derivative() const {
    Hull slope = *this;
    slope.degree_ = degree_ - 1;
    for (std::size_t i = 0; i < degree_; ++i) slope.c_[i] = static_cast<double>(degree_) * (c_[i + 1] - c_[i]);
    return slope;
  }
  Hull times(double factor) const {
    Hull product = *this;
    for (double& c : product.c_) c *= factor;
    return product;
  }

 private:
  std::array<double, 6> c_{};
  std::size_t degree_;
};

}  // namespace butee::record
