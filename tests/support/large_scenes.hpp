#pragma once

#include <string>

namespace butee::test {

/// The pipe of the paper's beams, pinned at both ends, with a given even number of elements of 1 m. A force
/// drives its middle at 10 Hz against a stop within the first 2 ms. NM1 at 1e-4 s, other methods by an
/// override.
std::string long_beam(int elements);

/// 16 beams such as long_beam(), side by side and with equal loads. Springs of 1e5 N/m join every 10th node
/// of a beam with that of the next beam.
std::string tied_beams(int elements);
inline constexpr int kTiedBeams = 16;

/// Number of free DOFs of one beam.
constexpr int dofs_of_beam(int elements) {
  return 2 * elements;
}

/// Number of elements of a beam for which a scene has about `dofs` DOFs.
constexpr int elements_of_long_beam(int dofs) {
  return dofs / 2;
}
constexpr int elements_of_tied_beams(int dofs) {
  return 2 * ((dofs + 2 * kTiedBeams) / (4 * kTiedBeams));
}

}  // namespace butee::test
