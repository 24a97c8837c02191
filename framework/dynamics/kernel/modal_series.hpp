#pragma once

#include <array>
#include <complex>
#include <span>

#include "butee/linalg/kernel/dense.hpp"

namespace butee::dynamics::kernel {

using linalg::kernel::kChunk;

/// Terms of the Taylor series of a propagator: with (omega + delta + Omega) h up to 1/2 the first
/// omitted term is below rounding.
inline constexpr int kTerms = 16;

/// 1 / ((k + 1)(k + 2))
inline constexpr auto kDivisors = [] {
  std::array<double, kTerms> all{};
  for (int k = 0; k < kTerms; ++k) all[static_cast<std::size_t>(k)] = 1.0 / static_cast<double>((k + 1) * (k + 2));
  return all;
}();

using Values = std::array<double, kChunk>;

/// A harmonic load: the series of e^(i Omega t) in t/h, and the modal forces cosine cos(Omega t) + sine sin(Omega t).
struct HarmonicSeries {
  std::array<std::complex<double>, kTerms> turn;
  Values cosine, sine;
};

/// For a chunk of modes.
struct ModalSeries {
  double h;
  Values frequency, decay;  ///< omega and delta, 1/s
};

/// Writes the columns of a ModalPropagator, one Values each: free motion, forces P_0, P_1, P_2, harmonics.
using SumSeries = void (*)(const ModalSeries&, std::span<const HarmonicSeries>, Values* columns);

/// For the chosen instruction set.
SumSeries sum_series();

}  // namespace butee::dynamics::kernel
