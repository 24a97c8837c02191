#pragma once

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "butee/core/types.hpp"

namespace butee::integrators {

/// Anderson's acceleration of a fixed-point iteration x := g(x).
///
/// With the residuals r = g(x) - x of the last iterates, the next iterate is the combination of the
/// g(x) whose combined residual has the smallest norm. On linear problems this is as fast as GMRES,
/// so that it converges also where plain iteration converges slowly or not at all. The least-squares
/// problem is solved by its normal equations, slightly regularised. Source: D. G. Anderson, J. ACM
/// 12 (1965) 547-560, doi 10.1145/321296.321305; H. F. Walker and P. Ni, SIAM J. Numer. Anal. 49
/// (2011) 1715-1735, doi 10.1137/10078356X. Checked in tests/unit/sweep_acceleration_test.cpp.
class SweepAcceleration {
 public:
  static constexpr Index kMostDifferences = 8;

  /// Forgets all iterates; the next ones have `size` numbers.
  void begin(Index size) {
    if (x_.size() != size) {
      for (Eigen::MatrixXd* all : {&differences_x_, &differences_r_}) all->resize(size, kMostDifferences);
      for (Eigen::VectorXd* one : {&x_, &r_, &last_x_, &last_r_}) one->resize(size);
    }
    count_ = 0;
    is_first_ = true;
  }

  /// Replaces g = g(x) by the next iterate. `weights` scale the residual in the norm.
  template <class Array>
  void accelerate(const Array& x, Array& g, const Array& weights) {
    const Index size = x.size();
    const Eigen::Map<const Eigen::ArrayXd> from(x.data(), size), scale(weights.data(), size);
    Eigen::Map<Eigen::ArrayXd> next(g.data(), size);
    x_ = from;
    r_ = (next - from) * scale;
    if (!is_first_) {
      const Index place = count_ % kMostDifferences;
      differences_x_.col(place) = x_ - last_x_;
      differences_r_.col(place) = r_ - last_r_;
      ++count_;
      const Index used = std::min(count_, kMostDifferences);
      const auto dx = differences_x_.leftCols(used), dr = differences_r_.leftCols(used);
      Small matrix = dr.transpose().lazyProduct(dr);
      matrix.diagonal().array() *= 1.0 + kRegularisation;
      const SmallVector right = dr.transpose().lazyProduct(r_), factors = matrix.ldlt().solve(right);
      if (factors.allFinite())
        for (Index k = 0; k < used; ++k) next -= factors[k] * (dx.col(k).array() + dr.col(k).array() / scale);
    }
    last_x_ = x_;
    last_r_ = r_;
    is_first_ = false;
  }

 private:
  static constexpr double kRegularisation = 1e-13;
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostDifferences, kMostDifferences>;
  using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostDifferences, 1>;

  Eigen::MatrixXd differences_x_, differences_r_;
  Eigen::VectorXd x_, r_, last_x_, last_r_;
  Index count_ = 0;  ///< differences taken since begin()
  bool is_first_ = true;
};

}  // namespace butee::integrators
