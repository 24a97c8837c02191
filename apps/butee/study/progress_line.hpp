#pragma once

#include <chrono>
#include <string>

#include <butee/study/perform.hpp>

namespace butee::app::studies {

/// "47 s", "12 min", "3.4 h"
std::string time_span(double seconds);

/// Progress of a study on standard error: on a terminal one line updated in place, otherwise a line every ten
/// seconds.
class ProgressLine {
 public:
  explicit ProgressLine(bool is_wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void report(const study::Progress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  bool is_wanted_, is_terminal_, is_on_screen_ = false;
  Clock::time_point begin_, drawn_;
};

}  // namespace butee::app::studies
