#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace butee::app::check {

/// History of a quantity that grows over a run, such as the number of steps, used to predict its final value.
class Pace {
 public:
  explicit Pace(double begin) : begin_(begin) {}

  /// Adds the value at the instant t, s, in ascending order. Memory is bounded.
  void add(double t, double value);

  /// The predicted value at `end`, s, extrapolated in proportion to time. Empty before the first sample, and
  /// if continuing at the slowest or fastest pace of any eighth of the trial would change the prediction by
  /// more than the factor kUneven.
  std::optional<double> foretell(double end) const;

  static constexpr double kUneven = 1.3;

 private:
  struct Mark {
    double t, value;
  };
  /// The value at an instant, by linear interpolation.
  double at(double t) const;

  double begin_;
  Mark last_{0.0, 0.0};
  std::vector<Mark> marks_;
  std::size_t since_last_ = 0, stride_ = 1;
};

}  // namespace butee::app::check
