#pragma once

#include <cstdint>
#include <optional>

#include "butee/time/simulation.hpp"

namespace butee::record {

/// The output instants: t = 0, interval, 2 interval, ..., end_time, counted from the start of the
/// run, or the end of every `every`-th accepted step.
class BUTEE_EXPORT OutputTimes {
 public:
  /// `every` is used if there is no `interval` (s).
  OutputTimes(std::optional<double> interval, std::int64_t every, double end_time);

  /// Calls `write(t)` for every instant due in the step; for t = 0, step.from.t, in the first step.
  template <class Write>
  void visit(const time::AcceptedStep& step, Write&& write) {
    if (rows_ == 0) {
      begin_ = step.from.t;
      count_row();
      write(step.from.t);
    }
    ++steps_;
    if (counts_steps()) {
      if (steps_ % every_ != 0 && step.to.t < end_time_) return;
      count_row();
      return write(step.to.t);
    }
    while (next_row_ <= step.to.t) {
      const double t = next_row_;
      count_row();
      write(t);
    }
  }

  /// False until the first step.
  bool begun() const { return rows_ > 0; }
  bool counts_steps() const { return every_ > 0; }
  /// The state on which later instants depend, for checkpoints.
  void save(ByteWriter& to) const;
  void restore(ByteReader& from);

  /// The first instant after `t`; infinite if steps are counted, and after the last instant.
  double next_instant(double t) const;

 private:
  double time_of_row() const;
  void count_row();

  double end_time_, interval_;
  std::int64_t every_;
  std::int64_t rows_ = 0, steps_ = 0;
  double begin_ = 0.0;  ///< s, start of the first step
  double next_row_ = 0.0;
};

}  // namespace butee::record
