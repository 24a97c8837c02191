#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "butee/dynamics/dynamics.hpp"
#include "butee/dynamics/modal_system.hpp"
#include "integrators/exponential/breakpoints.hpp"

namespace butee::integrators {

/// The parameters of a system with one DOF, one stop and harmonic loads.
struct SingleMode {
  double shape, stop_shape;     ///< displacement of the DOF and of the stop per modal coordinate
  double square, decay;         ///< omega^2, 1/s^2; delta, 1/s
  double load_frequency = 0.0;  ///< highest frequency of a load, rad/s
  const std::vector<dynamics::ModalHarmonic>& harmonics;

  explicit SingleMode(const dynamics::ModalSystem& modal)
      : shape(modal.shapes()(0, 0)),
        stop_shape(modal.stop_shapes().matrix()(0, 0)),
        square(modal.frequencies()[0] * modal.frequencies()[0]),
        decay(modal.decay()[0]),
        harmonics(modal.harmonics()) {
    for (const dynamics::ModalHarmonic& harmonic : harmonics)
      load_frequency = std::max(load_frequency, harmonic.angular_frequency);
  }
};

/// cos and sin of the harmonic loads at the breakpoints of a macro step. Each follows from the
/// previous one by a rotation, which loses the last digit; they are therefore recomputed after
/// kMostTurns rotations.
class LoadPhases {
 public:
  static constexpr int kMostTurns = 32;

  /// For up to `most` steps. `harmonics` must outlive it.
  LoadPhases(std::span<const dynamics::ModalHarmonic> harmonics, std::size_t most) : harmonics_(harmonics) {
    phases_.resize((most + 1) * harmonics.size());
  }

  std::span<const Phase> at(std::size_t breakpoint) const {
    return {phases_.data() + breakpoint * harmonics_.size(), harmonics_.size()};
  }
  /// Number of entries in a state: the number of rotations since the last computation, then cos and
  /// sin of each load.
  Index memory_size() const { return 1 + 2 * static_cast<Index>(harmonics_.size()); }
  /// Initial memory: the phases are to be computed.
  void start(double* memory) const {
    memory[0] = kMostTurns;
    std::fill(memory + 1, memory + memory_size(), 0.0);
  }
  /// Sets the phases of the first breakpoint, at t.
  void load(double t, const double* memory) {
    turns_ = static_cast<int>(memory[0]);
    if (turns_ == kMostTurns) return compute(0, t);
    for (std::size_t j = 0; j < harmonics_.size(); ++j) phases_[j] = {memory[1 + 2 * j], memory[2 + 2 * j]};
  }
  void save(std::size_t breakpoint, double* memory) const {
    memory[0] = turns_;
    const std::span<const Phase> last = at(breakpoint);
    for (std::size_t j = 0; j < harmonics_.size(); ++j) {
      memory[1 + 2 * j] = last[j].cosine;
      memory[2 + 2 * j] = last[j].sine;
    }
  }
  /// Sets the phases of a breakpoint at t from the previous one by the rotation turn_of(load).
  template <class TurnOf>
  void turn(std::size_t breakpoint, double t, TurnOf turn_of) {
    if (++turns_ == kMostTurns) return compute(breakpoint, t);
    Phase* to = phases_.data() + breakpoint * harmonics_.size();
    const Phase* from = to - harmonics_.size();
    for (std::size_t j = 0; j < harmonics_.size(); ++j) {
      const auto [c, s] = turn_of(j);
      to[j] = {c * from[j].cosine - s * from[j].sine, s * from[j].cosine + c * from[j].sine};
    }
  }

 private:
  void compute(std::size_t breakpoint, double t) {
    turns_ = 0;
    Phase* phase = phases_.data() + breakpoint * harmonics_.size();
    for (const dynamics::ModalHarmonic& harmonic : harmonics_) {
      const double angle = harmonic.angular_frequency * t;
      *phase++ = {std::cos(angle), std::sin(angle)};
    }
  }

  std::span<const dynamics::ModalHarmonic> harmonics_;
  std::vector<Phase> phases_;
  int turns_ = 0;
};

}  // namespace butee::integrators
