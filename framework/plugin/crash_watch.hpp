#pragma once

#include <array>
#include <csignal>
#include <mutex>
#include <string>

namespace butee::plugin {

/// As long as it lives, a crash of the process is preceded by a line on standard error that says which module was being
/// loaded. Code of a module that crashes cannot be stopped from within the process; the crash itself takes its course.
/// Signal handlers belong to the process: while one thread loads a module, others wait.
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
