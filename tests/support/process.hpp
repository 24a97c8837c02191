#pragma once

#include <chrono>
#include <string>
#include <sys/types.h>
#include <vector>

namespace butee::test {

/// `butee` under way, to be disturbed. Its output goes nowhere.
class Process {
 public:
  Process(const std::vector<std::string>& arguments, const std::string& folder);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// True where it ended within so long.
  bool ends_within(std::chrono::microseconds time);
  void send(int signal) const;
  /// The exit status, or minus the signal that ended it.
  int wait();

 private:
  pid_t child_;
  bool has_ended_ = false;
  int status_ = 0;
};

}  // namespace butee::test
