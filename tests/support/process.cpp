#include "support/process.hpp"

#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <stdexcept>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace butee::test {

Process::Process(const std::vector<std::string>& arguments, const std::string& folder) : child_(fork()) {
  if (child_ < 0) throw std::runtime_error("cannot fork");
  if (child_ > 0) return;
  std::vector<char*> argv = {const_cast<char*>(BUTEE_TEST_PROGRAM)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
  if (chdir(folder.c_str()) == 0) execv(argv.front(), argv.data());
  _exit(127);
}

Process::~Process() {
  if (has_ended_) return;
  send(SIGKILL);
  wait();
}

bool Process::ends_within(std::chrono::microseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (!has_ended_ && std::chrono::steady_clock::now() < end) {
    has_ended_ = waitpid(child_, &status_, WNOHANG) == child_;
    if (!has_ended_) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return has_ended_;
}

void Process::send(int signal) const {
  kill(child_, signal);
}

int Process::wait() {
  if (!has_ended_) waitpid(child_, &status_, 0);
  has_ended_ = true;
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
}

}  // namespace butee::test
