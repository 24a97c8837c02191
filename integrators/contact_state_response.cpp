#include <algorithm>
#include <cmath>

#include "integrators/contact_state_flow.hpp"

namespace butee::integrators {
namespace {

using LongComplex = std::complex<long double>;

/// A load closer than this to a block, relative to its frequency, is in resonance; otherwise its
/// closed-form response loses at most four of 16 digits.
constexpr double kResonance = 1e-4;
/// Largest phase angle of a piece with a response in resonance, rad.
constexpr double kLongest = 100.0;

}  // namespace

void ContactStateFlow::find_extras(double end_time) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Block& block = blocks_[b];
    const auto is_slow = [&](double rate) { return rate * end_time < 0.5; };
    if (block.kind == Kind::mode)
      block.slow[0] = block.square == 0.0 || is_slow(std::sqrt(block.square) + 2.0 * block.decay);
    if (block.kind == Kind::reals)
      for (std::size_t i = 0; i < 2; ++i) block.slow[i] = is_slow(-block.rates[i]);
    if (block.kind == Kind::pair) block.slow.fill(is_slow(block.rate));
    for (Index j = 0; j < system_.harmonic_count(); ++j) {
      const double omega = system_.frequencies[static_cast<std::size_t>(j)];
      const bool resonates =
          block.oscillates() && std::hypot(block.decay, omega - block.frequency) < kResonance * block.frequency;
      if (resonates || ((block.slow[0] || block.slow[1]) && is_slow(omega) && is_slow(block.rate)))
        block.resonant.push_back(j);
      if (resonates) longest_ = std::min(longest_, kLongest / block.frequency);
    }
    if (!block.slow[0] && !block.slow[1] && block.resonant.empty()) continue;
    block.extra = static_cast<Index>(with_extras_.size());
    with_extras_.push_back(b);
    grows_ = true;
  }
}

void ContactStateFlow::find_response() {
  const Index harmonics = system_.harmonic_count();
  const LongMatrix of_dofs = forcing_.leftCols(n_), by_cosine = of_dofs * system_.cosine,
                   by_sine = of_dofs * system_.sine;
  harmonic_c_ = by_cosine.cast<double>();
  harmonic_s_ = by_sine.cast<double>();
  cosine_ = sine_ = LongMatrix::Zero(n_, harmonics);
  std::array<LongMatrix, 3> response;
  response.fill(LongMatrix::Zero(n_, forcing_.cols()));
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const auto k = static_cast<Index>(2 * b);
    const LongVector r0 = right_.col(k), r1 = right_.col(k + 1);
    const long double d = block.decay, square = block.square;
    for (Index j = 0; j < harmonics; ++j) {
      if (std::find(block.resonant.begin(), block.resonant.end(), j) != block.resonant.end()) continue;
      const long double omega = system_.frequencies[static_cast<std::size_t>(j)];
      const long double c0 = by_cosine(k, j), s0 = by_sine(k, j), c1 = by_cosine(k + 1, j), s1 = by_sine(k + 1, j);
      if (block.kind == Kind::mode) {
        const long double root = std::sqrt(square), stiff = (root - omega) * (root + omega), drag = 2.0L * d * omega;
        const long double size = stiff * stiff + drag * drag;
        cosine_.col(j) += r0 * ((stiff * c0 - drag * s0) / size);
        sine_.col(j) += r0 * ((drag * c0 + stiff * s0) / size);
      } else if (block.kind == Kind::pair) {
        const LongComplex lambda(-d, block.frequency), i_omega(0.0L, omega), i(0.0L, 1.0L), gc(c0, c1), gs(s0, s1);
        const LongComplex ahead = 0.5L * (gc - i * gs) / (i_omega - lambda),
                          back = 0.5L * (gc + i * gs) / (-i_omega - lambda);
        const LongComplex of_cosine = ahead + back, of_sine = i * (ahead - back);
        cosine_.col(j) += r0 * of_cosine.real() + r1 * of_cosine.imag();
        sine_.col(j) += r0 * of_sine.real() + r1 * of_sine.imag();
      } else {
        for (Index i = 0; i < 2; ++i) {
          const long double rate = block.rates[static_cast<std::size_t>(i)], size = rate * rate + omega * omega;
          const long double c = i == 0 ? c0 : c1, s = i == 0 ? s0 : s1;
          cosine_.col(j) -= right_.col(k + i) * ((rate * c + omega * s) / size);
          sine_.col(j) += right_.col(k + i) * ((omega * c - rate * s) / size);
        }
      }
    }
    if (block.kind == Kind::mode && !block.slow[0]) {
      const LongMatrix each = r0 * forcing_.row(k);
      response[0] += each / square;
      response[1] -= each * (2.0L * d / (square * square));
      response[2] += each * (4.0L * d * d / (square * square * square) - 1.0L / (square * square));
    } else if (block.kind == Kind::pair && !block.slow[0]) {
      const LongComplex inverse = 1.0L / LongComplex(-d, block.frequency);
      LongComplex factor = -inverse;
      for (LongMatrix& each : response) {
        // Re and Im of factor (l_re + i l_im) f
        each += r0 * (factor.real() * forcing_.row(k) - factor.imag() * forcing_.row(k + 1)) +
                r1 * (factor.real() * forcing_.row(k + 1) + factor.imag() * forcing_.row(k));
        factor *= inverse;
      }
    } else if (block.kind == Kind::reals) {
      for (Index i = 0; i < 2; ++i) {
        if (block.slow[static_cast<std::size_t>(i)]) continue;
        const long double inverse = 1.0L / static_cast<long double>(block.rates[static_cast<std::size_t>(i)]);
        long double factor = -inverse;
        for (LongMatrix& each : response) {
          each += factor * right_.col(k + i) * forcing_.row(k + i);
          factor *= inverse;
        }
      }
    }
  }
  for (std::size_t k = 0; k < 3; ++k) parabola_[k] = response[k].cast<double>();
}

ContactStateFlow::Rows ContactStateFlow::rows_of(const LongMatrix& forms) const {
  const LongMatrix all = forms * right_;
  Rows rows;
  for (Table& table : rows.of) table.resize(forms.rows(), all.cols());
  rows.size.resize(forms.rows(), static_cast<Index>(blocks_.size()));
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const Block& block = blocks_[b];
    const auto k = static_cast<Index>(2 * b);
    for (Index i = 0; i < forms.rows(); ++i) {
      const long double r0 = all(i, k), r1 = all(i, k + 1), d = block.decay, square = block.square;
      const auto set = [&](std::size_t order, long double first, long double second) {
        rows.of[order](i, k) = static_cast<double>(first);
        rows.of[order](i, k + 1) = static_cast<double>(second);
      };
      rows.size(i, static_cast<Index>(b)) = static_cast<double>(std::sqrt(r0 * r0 + r1 * r1));
      if (block.kind == Kind::mode) {
        set(0, r0, 0.0L);
        set(1, 0.0L, r0);
        set(2, -square * r0, -2.0L * d * r0);
        set(3, 2.0L * d * square * r0, (4.0L * d * d - square) * r0);
      } else if (block.kind == Kind::pair) {
        LongComplex form(r0, -r1);  // r0 Re z + r1 Im z = Re (form z)
        for (std::size_t order = 0; order < 4; ++order, form *= LongComplex(-d, block.frequency))
          set(order, form.real(), -form.imag());
      } else {
        long double first = r0, second = r1;
        for (std::size_t order = 0; order < 4; ++order, first *= block.rates[0], second *= block.rates[1])
          set(order, first, second);
      }
    }
  }
  rows.cosine = (forms * cosine_).cast<double>();
  rows.sine = (forms * sine_).cast<double>();
  rows.swing = (rows.cosine.array().square() + rows.sine.array().square()).sqrt().matrix();
  return rows;
}

}  // namespace butee::integrators
