#include "butee/record/output_times.hpp"

#include <limits>

namespace butee::record {
namespace {

/// An output time within this fraction of an interval of end_time is taken as end_time.
constexpr double kSameInstant = 1e-9;

}  // namespace

OutputTimes::OutputTimes(std::optional<double> interval, std::int64_t every, double end_time)
    : end_time_(end_time), interval_(interval.value_or(0.0)), every_(interval ? 0 : every) {}

double OutputTimes::time_of_row() const {
  const double t = begin_ + static_cast<double>(rows_) * interval_;
  if (t < end_time_ - kSameInstant * interval_) return t;
  const double before = begin_ + static_cast<double>(rows_ - 1) * interval_;
  return before < end_time_ - kSameInstant * interval_ ? end_time_ : std::numeric_limits<double>::infinity();
}

void OutputTimes::count_row() {
  ++rows_;
  if (every_ == 0) next_row_ = time_of_row();
}

void OutputTimes::save(ByteWriter& to) const {
  to.put(rows_);
  to.put(steps_);
  to.put(next_row_);
  to.put(begin_);
}

void OutputTimes::restore(ByteReader& from) {
  from.take(rows_);
  from.take(steps_);
  from.take(next_row_);
  from.take(begin_);
}

double OutputTimes::next_instant(double t) const {
  if (every_ > 0) return std::numeric_limits<double>::infinity();
  // Before the first step the row at its beginning is still due.
  const double begin = begun() ? begin_ : t;
  double next = begun() ? next_row_ : t;
  for (std::int64_t row = rows_; next <= t; ++row) next = begin + static_cast<double>(row) * interval_;
  return next;
}

}  // namespace butee::record
