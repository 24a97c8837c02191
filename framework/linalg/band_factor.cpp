#include "butee/linalg/band_factor.hpp"

#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "butee/core/error.hpp"
#include "butee/linalg/kernel/band_solve.hpp"

namespace butee::linalg {

/// The elimination from one end: rows are counted from that end.
class BandFactor::Chain {
 public:
  Chain(Index steps, Index band)
      : steps_(steps), band_(band), row_(static_cast<std::size_t>((steps + band) * (band + 1))) {}

  /// Entry (i, i + k). Before elimination: that of A or, beyond the last step, of the change of the
  /// middle block. After it: D for k = 0, else L(i + k, i).
  double& at(Index i, Index k) { return row_[static_cast<std::size_t>(i * (band_ + 1) + k)]; }
  double at(Index i, Index k) const { return row_[static_cast<std::size_t>(i * (band_ + 1) + k)]; }

  bool eliminate() {
    std::array<double, kWidestBand + 1> above{};
    for (Index i = 0; i < steps_; ++i) {
      const double pivot = at(i, 0);
      if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
      for (Index k = 1; k <= band_; ++k) {
        above[static_cast<std::size_t>(k)] = at(i, k);
        at(i, k) /= pivot;
      }
      for (Index k = 1; k <= band_; ++k)
        for (Index p = k; p <= band_; ++p) at(i + k, p - k) -= at(i, k) * above[static_cast<std::size_t>(p)];
    }
    return true;
  }

 private:
  Index steps_, band_;
  std::vector<double> row_;
};

BandFactor::BandFactor(Index size, Index band) : size_(size), band_(band), steps_((size - band) / 2) {
  require(fits(size, band), "a band too wide for the matrix");
  solve_ = kernel::band_solve(band, false);
  solve_less_ = kernel::band_solve(band, true);
  const auto chunks = [](Index rows) { return (rows + kernel::kFactorRows - 1) / kernel::kFactorRows; };
  forward_ = ChunkTable(2 * band * kernel::kFactorRows, chunks(steps_ + band));
  backward_ = ChunkTable(2 * (band + 1) * kernel::kFactorRows, chunks(steps_));
}

bool BandFactor::factorize(const SparseMatrix& matrix) {
  Chain top(steps_, band_), bottom(steps_, band_);
  const Index begin = steps_, count = size_ - 2 * steps_;
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(count, count);
  for (Index j = 0; j < matrix.cols(); ++j)
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      const Index i = entry.row();
      if (i > j) continue;
      if (i < begin)
        top.at(i, j - i) = entry.value();
      else if (j >= begin + count)
        bottom.at(size_ - 1 - j, j - i) = entry.value();
      else
        middle(i - begin, j - begin) = middle(j - begin, i - begin) = entry.value();
    }
  if (!top.eliminate() || !bottom.eliminate()) return false;
  for (Index i = 0; i < band_; ++i)
    for (Index k = 0; i + k < band_; ++k) {
      middle(i, i + k) += top.at(steps_ + i, k);
      if (k > 0) middle(i + k, i) += top.at(steps_ + i, k);
      middle(count - 1 - i, count - 1 - i - k) += bottom.at(steps_ + i, k);
      if (k > 0) middle(count - 1 - i - k, count - 1 - i) += bottom.at(steps_ + i, k);
    }
  return store(top, bottom, middle);
}

bool BandFactor::store(const Chain& top, const Chain& bottom, const Eigen::MatrixXd& middle) {
  double *forward = forward_.write(), *backward = backward_.write();
  const auto put = [](double* to, double from_top, double from_bottom) {
    to[0] = from_top;
    to[1] = from_bottom;
  };
  for (Index s = 0; s < steps_; ++s) {
    double* back = backward + 2 * (band_ + 1) * s;
    put(back, 1.0 / top.at(s, 0), 1.0 / bottom.at(s, 0));
    for (Index k = 1; k <= band_; ++k) {
      put(back + 2 * k, top.at(s, k), bottom.at(s, k));
      put(forward + 2 * ((s + k) * band_ + k - 1), top.at(s, k), bottom.at(s, k));
    }
  }
  forward_.share();
  backward_.share();
  const Eigen::LLT<Eigen::MatrixXd> cholesky(middle);
  if (cholesky.info() != Eigen::Success) return false;
  const Eigen::MatrixXd inverse = cholesky.solve(Eigen::MatrixXd::Identity(middle.rows(), middle.cols()));
  middle_inverse_.assign(inverse.data(), inverse.data() + inverse.size());
  return inverse.allFinite();
}

void BandFactor::solve(double* b) const {
  solve_({size_, steps_, forward_, backward_, middle_inverse_.data()}, b, {});
}

void BandFactor::solve_less(double* b, double factor, const double* v) const {
  solve_less_({size_, steps_, forward_, backward_, middle_inverse_.data()}, b, {factor, v});
}

}  // namespace butee::linalg
