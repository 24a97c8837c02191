#pragma once

#include <functional>
#include <string>

#include "butee/study/study.hpp"

namespace butee::study {

/// Points that arrive one by one, for example from another program, and rows that are returned in
/// the order of the points.
struct Stream {
  /// A line of CSV; false at the end, or if `is_wanted`, called about ten times a second while it
  /// waits, is false. Called by the calling thread.
  std::function<bool(std::string& line, const std::function<bool()>& is_wanted)> next;
  /// A row as CSV, or the header. Called by any thread, one at a time.
  std::function<void(const std::string& line)> respond;
  /// Called after steps, by all threads; may be empty.
  std::function<bool()> goes_on;
};

/// The columns of a study whose points arrive as texts: rows contain the values as given.
BUTEE_EXPORT Layout streamed_layout(const Study& study);

/// Answers lines of points, with a value for each axis of `study`, until they end. A line that is
/// not a valid point gets a row with the reason. Returns the number of rows without results.
BUTEE_EXPORT std::int64_t answer(const Study& study, const Layout& layout, int threads, const Stream& stream);

}  // namespace butee::study
