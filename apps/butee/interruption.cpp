#include "interruption.hpp"

#include <csignal>

namespace butee::app {
namespace {

volatile std::sig_atomic_t noted = 0;

extern "C" void note(int signal) {
  noted = signal;
}

}  // namespace

void watch_for_interruption() {
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const char* interruption() {
  return noted == 0 ? nullptr : noted == SIGINT ? "SIGINT" : "SIGTERM";
}

}  // namespace butee::app
