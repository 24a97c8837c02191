#include "butee/solve/band_factor.hpp"

#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "butee/core/error.hpp"

namespace butee::solve {

/// The elimination from one end: rows are counted from that end.
class BandFactor::Chain {
 public:
  Chain(Index steps, Index band)
      : steps_(steps), band_(band), row_(static_cast<std::size_t>((steps + band) * (band + 1))) {}

  /// Entry (i, i + k): before elimination of A or, beyond the last step, of the change of the middle; after it D for
  /// k = 0, else L(i + k, i).
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

struct BandFactor::View {
  Index size, steps;
  const ChunkTable &forward, &backward;
  const double* middle_inverse;

  /// What forward has for the row that step s eliminates.
  template <Index band>
  const double* forward_of(Index s) const {
    return forward[s / kRows] + 2 * band * (s % kRows);
  }

  /// Calls row(s, entries) for all steps, from the ends to the middle.
  template <Index band, class Row>
  void go_forward(const Row& row) const {
    Index s = 0;
    for (Index chunk = 0; s + kRows <= steps; ++chunk) {
      const double* entries = forward[chunk];
      for (Index i = 0; i < kRows; ++i, ++s, entries += 2 * band) row(s, entries);
    }
    for (; s < steps; ++s) row(s, forward_of<band>(s));
  }

  /// And back.
  template <Index band, class Row>
  void go_back(const Row& row) const {
    constexpr Index kEntries = 2 * (band + 1);
    Index s = steps - 1;
    for (; s >= 0 && s % kRows != kRows - 1; --s) row(s, backward[s / kRows] + kEntries * (s % kRows));
    for (Index chunk = s / kRows; s >= 0; --chunk) {
      const double* entries = backward[chunk] + kEntries * (kRows - 1);
      for (Index i = 0; i < kRows; ++i, --s, entries -= kEntries) row(s, entries);
    }
  }
};

namespace {

/// One entry from the top and one from the bottom.
using Pair = double __attribute__((vector_size(16)));

inline Pair pair_at(const double* pairs, Index i) {
  return Pair{pairs[2 * i], pairs[2 * i + 1]};
}

template <std::size_t band>
using Recent = std::array<Pair, band>;

/// value - sum over k of entries[k] recent[k - 1], the nearest last: only it waits for the row before.
template <std::size_t band>
inline void subtract(const double* entries, const Recent<band>& recent, Pair& value) {
  for (std::size_t k = band; k > 0; --k) value -= pair_at(entries, static_cast<Index>(k) - 1) * recent[k - 1];
}

template <std::size_t band>
inline void push(const Pair& value, Recent<band>& recent) {
  for (std::size_t k = band - 1; k > 0; --k) recent[k] = recent[k - 1];
  recent[0] = value;
}

/// Takes the ends' part out of the middle's right side and solves there.
template <std::size_t band, class View>
void solve_middle(const View& f, const Recent<band>& last, double* x) {
  constexpr auto kBand = static_cast<Index>(band);
  const Index begin = f.steps, end = f.size - f.steps, count = end - begin;
  Recent<band> recent = last;
  for (Index t = 0; t < kBand; ++t) {
    Pair change{};
    subtract<band>(f.template forward_of<kBand>(begin + t), recent, change);
    x[begin + t] += change[0];
    x[end - 1 - t] += change[1];
    push(Pair{}, recent);
  }
  std::array<double, band + 1> solved{};
  for (Index i = 0; i < count; ++i)
    for (Index j = 0; j < count; ++j)
      solved[static_cast<std::size_t>(i)] += f.middle_inverse[i * count + j] * x[begin + j];
  for (Index i = 0; i < count; ++i) x[begin + i] = solved[static_cast<std::size_t>(i)];
}

/// What is taken from a solution: factor v.
struct Subtrahend {
  double factor;
  const double* v;
};

template <std::size_t band, bool subtracts, class View>
void solve_twisted(const View& f, double* x, [[maybe_unused]] const Subtrahend& less) {
  constexpr auto kBand = static_cast<Index>(band);
  double* mirrored = x + f.size - 1;
  Recent<band> recent{};
  f.template go_forward<kBand>([&](Index s, const double* entries) {
    Pair value{x[s], mirrored[-s]};
    subtract<band>(entries, recent, value);
    x[s] = value[0];
    mirrored[-s] = value[1];
    push(value, recent);
  });
  solve_middle<band>(f, recent, x);
  for (Index k = 0; k < kBand; ++k) recent[static_cast<std::size_t>(k)] = Pair{x[f.steps + k], mirrored[-f.steps - k]};
  if constexpr (subtracts)
    for (Index i = f.steps; i < f.size - f.steps; ++i) x[i] -= less.factor * less.v[i];
  f.template go_back<kBand>([&](Index s, const double* entries) {
    Pair value = Pair{x[s], mirrored[-s]} * pair_at(entries, 0);
    subtract<band>(entries + 2, recent, value);
    push(value, recent);
    if constexpr (subtracts) value -= less.factor * Pair{less.v[s], less.v[f.size - 1 - s]};
    x[s] = value[0];
    mirrored[-s] = value[1];
  });
}

template <class View>
using Kernel = void (*)(const View&, double*, const Subtrahend&);

template <class View, bool subtracts, std::size_t... bands>
constexpr std::array<Kernel<View>, sizeof...(bands)> kernels(std::index_sequence<bands...>) {
  return {&solve_twisted<bands + 1, subtracts, View>...};
}

template <bool subtracts, class View>
void solve_any(Index band, const View& factor, double* x, const Subtrahend& less) {
  static constexpr auto kKernels =
      kernels<View, subtracts>(std::make_index_sequence<static_cast<std::size_t>(BandFactor::kWidestBand)>{});
  kKernels[static_cast<std::size_t>(band - 1)](factor, x, less);
}

}  // namespace

BandFactor::BandFactor(Index size, Index band) : size_(size), band_(band), steps_((size - band) / 2) {
  require(fits(size, band), "a band too wide for the matrix");
  const auto chunks = [](Index rows) { return (rows + kRows - 1) / kRows; };
  forward_ = ChunkTable(2 * band * kRows, chunks(steps_ + band));
  backward_ = ChunkTable(2 * (band + 1) * kRows, chunks(steps_));
}

BandFactor::View BandFactor::view() const {
  return {size_, steps_, forward_, backward_, middle_inverse_.data()};
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
  solve_any<false>(band_, view(), b, {});
}

void BandFactor::solve_less(double* b, double factor, const double* v) const {
  solve_any<true>(band_, view(), b, {factor, v});
}

}  // namespace butee::solve
