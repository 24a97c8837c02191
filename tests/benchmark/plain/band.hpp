#pragma once

#include <array>
#include <vector>

namespace plain {

/// Half bandwidth: two DOFs a node, coupling between neighbouring nodes only.
inline constexpr int kHalfBandwidth = 3;

/// A vector padded with zeros on both sides, so that band loops need no special first and last rows.
template <typename Real>
class Vector {
 public:
  Vector() = default;
  explicit Vector(int size) : size_(size), data_(static_cast<std::size_t>(size + 2 * kHalfBandwidth), Real(0)) {}

  int size() const { return size_; }
  Real* data() { return data_.data() + kHalfBandwidth; }
  const Real* data() const { return data_.data() + kHalfBandwidth; }
  Real& operator[](int i) { return data()[i]; }
  Real operator[](int i) const { return data()[i]; }

 private:
  int size_ = 0;
  std::vector<Real> data_;
};

/// A symmetric matrix stored by diagonals: lower[k][i] = A(i, i - k).
template <typename Real>
struct Band {
  Band() = default;
  explicit Band(int size) {
    for (auto& diagonal : lower) diagonal = Vector<Real>(size);
  }

  int size() const { return lower[0].size(); }
  /// Adds to A(i, j) and, if i != j, to A(j, i).
  void add(int i, int j, Real value) {
    if (i >= j) lower[static_cast<std::size_t>(i - j)][i] += value;
  }
  /// (A x)_i, where x is the data of a padded vector.
  Real row_times(int i, const Real* x) const {
    const Real* d0 = lower[0].data();
    const Real* d1 = lower[1].data();
    const Real* d2 = lower[2].data();
    const Real* d3 = lower[3].data();
    return d0[i] * x[i] + (d1[i] * x[i - 1] + d1[i + 1] * x[i + 1]) + (d2[i] * x[i - 2] + d2[i + 2] * x[i + 2]) +
           (d3[i] * x[i - 3] + d3[i + 3] * x[i + 3]);
  }

  std::array<Vector<Real>, kHalfBandwidth + 1> lower;
};

/// A = L D L^T without pivoting, for positive definite band matrices.
template <typename Real>
class BandFactor {
 public:
  void compute(const Band<Real>& a) {
    const int n = a.size();
    rows_.resize(static_cast<std::size_t>(n + 2 * kHalfBandwidth));
    Row* row = rows_.data() + kHalfBandwidth;
    for (int i = 0; i < n; ++i) {
      const Real c3 = a.lower[3][i];
      const Real c2 = a.lower[2][i] - c3 * row[i - 2].l1;
      const Real c1 = a.lower[1][i] - c3 * row[i - 1].l2 - c2 * row[i - 1].l1;
      const Real l3 = c3 * row[i - 3].inverse;
      const Real l2 = c2 * row[i - 2].inverse;
      const Real l1 = c1 * row[i - 1].inverse;
      row[i] = {l1, l2, l3, 1 / (a.lower[0][i] - c3 * l3 - c2 * l2 - c1 * l1)};
    }
  }

  /// b := A^-1 b
  void solve(Vector<Real>& b) const {
    const int n = b.size();
    const Row* row = rows_.data() + kHalfBandwidth;
    Real* x = b.data();
    Real x1 = 0, x2 = 0, x3 = 0;
    for (int i = 0; i < n; ++i) {
      const Real xi = ((x[i] - row[i].l3 * x3) - row[i].l2 * x2) - row[i].l1 * x1;
      x3 = x2, x2 = x1, x1 = xi;
      x[i] = xi;
    }
    x1 = x2 = x3 = 0;
    for (int i = n - 1; i >= 0; --i) {
      const Real xi = ((x[i] * row[i].inverse - row[i + 3].l3 * x3) - row[i + 2].l2 * x2) - row[i + 1].l1 * x1;
      x3 = x2, x2 = x1, x1 = xi;
      x[i] = xi;
    }
  }

 private:
  struct Row {
    Real l1 = 0, l2 = 0, l3 = 0, inverse = 0;
  };
  std::vector<Row> rows_;
};

}  // namespace plain
