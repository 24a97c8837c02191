#include "interruption.hpp"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace butee::app {
namespace {

/// Signals within this time of the first are the same request: `timeout` signals the program and then its group.
constexpr std::int64_t kSameRequest = 500;  // ms

volatile std::sig_atomic_t noted = 0;
std::atomic<std::int64_t> noted_at = 0;  // ms

extern "C" void note(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t at = std::int64_t{1000} * now.tv_sec + now.tv_nsec / 1000000;
  if (noted == 0) {
    noted_at = at;
    noted = signal;
  } else if (at - noted_at > kSameRequest) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

void watch_for_interruption() {
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const char* interruption() {
  return noted == 0 ? nullptr : noted == SIGINT ? "SIGINT" : "SIGTERM";
}

}  // namespace butee::app
