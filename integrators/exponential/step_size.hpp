#pragma once

#include "butee/core/types.hpp"
#include "integrators/exponential/error_indicators.hpp"

namespace butee::integrators {

/// Selects step sizes h = 2^(index/2) s of a geometric grid from the errors of earlier steps. Steps
/// with contact have their own index; that of steps without contact is larger by an offset. Both
/// are a part of the state. Constants: plugins/exponential/THEORY.md, section 8.3; tests:
/// tests/unit/step_size_test.cpp.
class StepSizeControl {
 public:
  /// The result of an attempt at a step, for the control.
  struct Outcome {
    bool is_contact_free;
    StepError contact;           ///< of a step with contact
    double interpolation_error;  ///< ratio of error to bound of a step without contact
  };

  /// `first`: index of the first step with contact.
  explicit StepSizeControl(int first) : first_(first), index_(first) {}

  int first() const { return first_; }
  /// The index of steps with contact.
  int contact_index() const { return index_; }
  /// The index of the next step.
  int next_index() const { return index_ + (is_contact_free_ ? longer_ : 0); }
  /// The index of the next step without contact, limited so that the step ends before the next
  /// contact; `time_to_contact` in s.
  int next_index(double time_to_contact) const;

  /// Processes the outcome of an accepted step. `on_grid`: the step was not shortened to end at a
  /// given time.
  void accept(const Outcome& outcome, bool on_grid);

  struct Retry {
    int index;
    bool was_contact;  ///< rejected for the error of its contacts
  };
  /// The index after a rejected step; `h` is its length, s, if it was shortened.
  Retry reject(const Outcome& outcome, int index, bool on_grid, double h);
  /// True if the step is so short that the motion may have just begun; the scales are then those of
  /// a step of the first index.
  bool is_start_from_rest(int index) const { return index < first_ - kIndicesToRest; }
  /// True if no shorter step is attempted.
  bool is_shortest(int index) const { return index <= first_ - kMostIndicesDown; }

  /// The number of indices by which a step without contact may become longer if its interpolation
  /// error is the fraction `part` of its bound; the error grows by a factor of eight per index.
  static int indices_up(double part);

  /// The control's entries in a state.
  static constexpr Index kMemory = 3;
  struct Memory {
    double index, is_contact_free, longer;
  };
  Memory save() const {
    return {static_cast<double>(index_), is_contact_free_ ? 1.0 : 0.0, static_cast<double>(longer_)};
  }
  void load(const Memory& memory);
  /// The initial memory.
  Memory start() const { return {static_cast<double>(first_), 0.0, static_cast<double>(kLonger)}; }

 private:
  /// Number of indices by which the first step without contact is longer.
  static constexpr int kLonger = 2;
  static constexpr int kIndicesToRest = 10;
  static constexpr int kMostIndicesDown = 80;

  int first_, index_;
  bool is_contact_free_ = false;
  int longer_ = 0;
};

}  // namespace butee::integrators
