#pragma once

#include <array>
#include <csignal>
#include <mutex>
#include <string>

namespace butee::plugin {

/// During its lifetime, if the process crashes, it first writes a line to standard error that names
/// the module being loaded. A crash in a module's code cannot be prevented from within the process;
/// it then takes its normal course. Signal handlers belong to the process: while one thread loads a
/// module, other threads wait.
class CrashWatch {
 public:
  explicit CrashWatch(const std::string& module);
  ~CrashWatch();
  CrashWatch(const CrashWatch&) = delete;
  CrashWatch& operator=(const CrashWatch&) = delete;

 private:
  static std::recursive_mutex& mutex();
  static constexpr std::array kSignals = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};

  std::lock_guard<std::recursive_mutex> alone_;
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace butee::plugin
