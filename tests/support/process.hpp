#pragma once

#include <chrono>
#include <string>
#include <sys/types.h>
#include <vector>

namespace butee::test {

/// A running `butee` process, to be disturbed by a test. Its output is discarded.
class Process {
 public:
  Process(const std::vector<std::string>& arguments, const std::string& folder);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// True if it ended within `time`.
  bool ends_within(std::chrono::microseconds time);
  void send(int signal) const;
  /// The exit status, or minus the number of the signal that ended it.
  int wait();

 private:
  pid_t child_;
  bool has_ended_ = false;
  int status_ = 0;
};

}  // namespace butee::test
