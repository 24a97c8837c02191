#pragma once

#include <functional>
#include <string>

#include "butee/study/study.hpp"

namespace butee::study {

/// Points that come one by one, such as from another program, and rows that go back in the order of the points.
struct Stream {
  std::function<bool(std::string& line)> next;           ///< a line of CSV; false at the end. By the calling thread
  std::function<void(const std::string& line)> respond;  ///< a row as CSV, or the header. By any thread, one at a time
  std::function<bool()> goes_on;                         ///< asked after steps, by all threads; may be empty
};

/// The columns of a study whose points come as texts: values stand in the rows as they were given.
BUTEE_EXPORT Layout streamed_layout(const Study& study);

/// Answers lines of points, a value for each axis of `study`, until they end. A line that is no point has a row that
/// says so. The number of rows without results.
BUTEE_EXPORT std::int64_t answer(const Study& study, const Layout& layout, int threads, const Stream& stream);

}  // namespace butee::study
