#include "butee/study/sequences.hpp"

#include <array>
#include <numeric>
#include <span>

#include "butee/core/error.hpp"

namespace butee::study {
namespace {

constexpr unsigned kBits = 32;

/// A dimension after the first: the degree of its polynomial, the inner coefficients as bits, the
/// first m_i.
struct Entry {
  unsigned degree, coefficients;
  std::array<std::uint32_t, 7> initial;
};

constexpr std::array<Entry, Sobol::kMostDimensions - 1> kTable = {{{1, 0, {1}},
                                                                   {2, 1, {1, 3}},
                                                                   {3, 1, {1, 3, 1}},
                                                                   {3, 2, {1, 1, 1}},
                                                                   {4, 1, {1, 1, 3, 3}},
                                                                   {4, 4, {1, 3, 5, 13}},
                                                                   {5, 2, {1, 1, 5, 5, 17}},
                                                                   {5, 4, {1, 1, 5, 5, 5}},
                                                                   {5, 7, {1, 1, 7, 11, 19}},
                                                                   {5, 11, {1, 1, 5, 1, 1}},
                                                                   {5, 13, {1, 1, 1, 3, 11}},
                                                                   {5, 14, {1, 3, 5, 5, 31}},
                                                                   {6, 1, {1, 3, 3, 9, 7, 49}},
                                                                   {6, 13, {1, 1, 1, 15, 21, 21}},
                                                                   {6, 16, {1, 3, 1, 13, 27, 49}},
                                                                   {6, 19, {1, 1, 1, 15, 7, 5}},
                                                                   {6, 22, {1, 3, 1, 15, 13, 25}},
                                                                   {6, 25, {1, 1, 5, 5, 19, 61}},
                                                                   {7, 1, {1, 3, 7, 11, 23, 15, 103}},
                                                                   {7, 4, {1, 3, 7, 13, 13, 15, 69}}}};

std::vector<std::uint32_t> directions_of(std::size_t dimension) {
  std::vector<std::uint32_t> v(kBits);
  if (dimension == 0) {
    for (unsigned i = 0; i < kBits; ++i) v[i] = 1U << (kBits - 1 - i);
    return v;
  }
  const Entry& entry = kTable[dimension - 1];
  const unsigned s = entry.degree;
  for (unsigned i = 0; i < s; ++i) v[i] = entry.initial[i] << (kBits - 1 - i);
  for (unsigned i = s; i < kBits; ++i) {
    v[i] = v[i - s] ^ (v[i - s] >> s);
    for (unsigned k = 1; k < s; ++k)
      if (((entry.coefficients >> (s - 1 - k)) & 1U) != 0) v[i] ^= v[i - k];
  }
  return v;
}

/// SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014, doi:10.1145/2714064.2660195), as a hash of its counter.
std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15U;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31U);
}

std::uint64_t random_at(std::uint64_t seed, std::size_t dimension, std::uint64_t index) {
  return mix(mix(mix(seed) ^ dimension) ^ index);
}

/// The high bits as a number in [0, 1).
double fraction(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1p-53;
}

}  // namespace

Sobol::Sobol(std::size_t dimensions, std::optional<std::uint64_t> seed) : shifts_(dimensions, 0) {
  require(dimensions <= kMostDimensions, "Sobol's sequence has direction numbers for 21 dimensions here");
  for (std::size_t d = 0; d < dimensions; ++d) {
    directions_.push_back(directions_of(d));
    if (seed) shifts_[d] = static_cast<std::uint32_t>(random_at(*seed, d, 0) >> 32U);
  }
}

double Sobol::at(std::uint64_t index, std::size_t dimension) const {
  const std::uint64_t gray = index ^ (index >> 1U);
  std::uint32_t x = shifts_[dimension];
  for (unsigned bit = 0; bit < kBits; ++bit)
    if (((gray >> bit) & 1U) != 0) x ^= directions_[dimension][bit];
  return static_cast<double>(x) * 0x1p-32;
}

LatinHypercube::LatinHypercube(std::uint32_t count, std::size_t dimensions, std::uint64_t seed)
    : count_(count), seed_(seed), places_(dimensions) {
  for (std::size_t d = 0; d < dimensions; ++d) {
    places_[d].resize(count);
    std::iota(places_[d].begin(), places_[d].end(), 0U);
    for (std::uint32_t i = count; i > 1; --i) {
      const auto j = static_cast<std::uint32_t>(fraction(random_at(seed, 2 * d, i)) * i);
      std::swap(places_[d][i - 1], places_[d][j]);
    }
  }
}

double LatinHypercube::at(std::uint64_t index, std::size_t dimension) const {
  const double within = fraction(random_at(seed_, 2 * dimension + 1, index));
  return (static_cast<double>(places_[dimension][index]) + within) / static_cast<double>(count_);
}

}  // namespace butee::study
