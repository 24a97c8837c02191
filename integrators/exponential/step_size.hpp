#pragma once

#include "butee/core/types.hpp"
#include "integrators/exponential/error_indicators.hpp"

namespace butee::integrators {

/// The step sizes of a geometric grid, h = 2^(index/2) s, that follow from the errors of earlier steps. Steps with
/// contact have an index of their own; steps without contact are some indices longer. Both are a part of the state.
/// Constants: plugins/exponential/THEORY.md, section 8.3; tests: tests/unit/step_size_test.cpp.
class StepSizeControl {
 public:
  /// The result of an attempt at a step, for the control.
  struct Outcome {
    bool is_contact_free;
    StepError contact;           ///< of a step with contact
    double interpolation_error;  ///< of a step without contact, over its bound
  };

  /// The index of the first step with contact.
  explicit StepSizeControl(int first) : first_(first), index_(first) {}

  int first() const { return first_; }
  /// With contact.
  int contact_index() const { return index_; }
  /// For the next step.
  int next_index() const { return index_ + (is_contact_free_ ? longer_ : 0); }
  /// The index of a step without contact; the step ends before the next contact, after that time, s.
  int next_index(double time_to_contact) const;

  /// Takes over the outcome of an accepted step. `on_grid`: it was not shortened to end at a given time.
  void accept(const Outcome& outcome, bool on_grid);

  struct Retry {
    int index;
    bool was_contact;  ///< rejected for the error of its contacts
  };
  /// The index after a rejected step; `h` is the length of one that was shortened, s.
  Retry reject(const Outcome& outcome, int index, bool on_grid, double h);
  /// So short a step may mean that the motion has just begun, and scales are those of the first step.
  bool is_start_from_rest(int index) const { return index < first_ - kIndicesToRest; }
  /// No shorter step is tried.
  bool is_shortest(int index) const { return index <= first_ - kMostIndicesDown; }

  /// A step without contact whose interpolation error is so much of its bound may be so many indices longer: the error
  /// grows by eight with each.
  static int indices_up(double part);

  /// The control as numbers of a state.
  static constexpr Index kMemory = 3;
  struct Memory {
    double index, is_contact_free, longer;
  };
  Memory save() const {
    return {static_cast<double>(index_), is_contact_free_ ? 1.0 : 0.0, static_cast<double>(longer_)};
  }
  void load(const Memory& memory);
  /// The memory at a start.
  Memory start() const { return {static_cast<double>(first_), 0.0, static_cast<double>(kLonger)}; }

 private:
  /// The first step without contact is so many indices longer.
  static constexpr int kLonger = 2;
  static constexpr int kIndicesToRest = 10;
  static constexpr int kMostIndicesDown = 80;

  int first_, index_;
  bool is_contact_free_ = false;
  int longer_ = 0;
};

}  // namespace butee::integrators
