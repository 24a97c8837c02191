#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <butee/export.hpp>

namespace butee::study {

/// Sobol's sequence in up to kMostDimensions dimensions, in the order of Gray codes, on [0, 1).
///
/// Primitive polynomials and initial direction numbers of S. Joe and F. Y. Kuo, SIAM J. Sci.
/// Comput. 30 (2008) 2635-2654, doi:10.1137/070709359 (their file new-joe-kuo-6.21201). With a seed
/// every dimension gets a digital shift (exclusive or with a random number), which preserves the
/// net. Checked against scipy.stats.qmc and by the numbers of points in elementary intervals in
/// tests/unit/sequences_test.cpp.
class BUTEE_EXPORT Sobol {
 public:
  static constexpr std::size_t kMostDimensions = 21;

  /// Throws LogicError for more dimensions.
  explicit Sobol(std::size_t dimensions, std::optional<std::uint64_t> seed = std::nullopt);

  /// Coordinate `dimension` of point `index` < 2^32.
  double at(std::uint64_t index, std::size_t dimension) const;

 private:
  std::vector<std::vector<std::uint32_t>> directions_;
  std::vector<std::uint32_t> shifts_;
};

/// A Latin hypercube: `count` points; in every dimension each of `count` equal intervals contains
/// one point, at a random position in it. The same for the same seed, on every machine.
class BUTEE_EXPORT LatinHypercube {
 public:
  LatinHypercube(std::uint32_t count, std::size_t dimensions, std::uint64_t seed);
  double at(std::uint64_t index, std::size_t dimension) const;

 private:
  std::uint32_t count_;
  std::uint64_t seed_;
  std::vector<std::vector<std::uint32_t>> places_;
};

}  // namespace butee::study
