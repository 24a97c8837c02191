#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace butee::app::check {

/// The course of a quantity that grows over a run, such as the number of steps, from which its final value is foretold.
class Pace {
 public:
  explicit Pace(double begin) : begin_(begin) {}

  /// The value at an instant (s, ascending). The memory is bounded.
  void add(double t, double value);

  /// The value at `end`, s: in proportion to the time, where a rest at the slowest and one at the fastest eighth's pace
  /// come within a factor of kUneven of that. Nothing before a first mark.
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
