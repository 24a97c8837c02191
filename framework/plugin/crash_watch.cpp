#include "butee/plugin/crash_watch.hpp"

#include <algorithm>
#include <cstring>
#include <unistd.h>

namespace butee::plugin {
namespace {

/// The text that the handler writes; the handler must not allocate memory.
std::array<char, 4096> line{};

extern "C" void tell(int signal) {
  const ssize_t written = write(STDERR_FILENO, line.data(), std::strlen(line.data()));
  (void)written;
  std::raise(signal);  // The default handler has been restored.
}

}  // namespace

std::recursive_mutex& CrashWatch::mutex() {
  static std::recursive_mutex one;
  return one;
}

CrashWatch::CrashWatch(const std::string& module) : alone_(mutex()) {
  const std::string text = "butee: error: " + module + ": crashed the program while it was loaded\n";
  line.fill('\0');
  std::copy_n(text.begin(), std::min(text.size(), line.size() - 1), line.begin());
  struct sigaction action {};
  action.sa_handler = tell;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

CrashWatch::~CrashWatch() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

}  // namespace butee::plugin
