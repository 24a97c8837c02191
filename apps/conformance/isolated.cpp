#include "apps/conformance/isolated.hpp"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <butee/core/error.hpp>
#include <butee/core/text.hpp>

namespace butee::conformance {
namespace {

/// The exit status after a check that passed or failed; a module that ends the process itself gives another one.
constexpr int kFinished = 117, kFound = 118;

/// Writes the finding and ends the process without running destructors of static objects, which belong to the
/// parent.
[[noreturn]] void report_and_leave(int pipe, const std::function<Finding()>& work) {
  Finding finding{false, ""};
  try {
    finding = work();
  } catch (const std::exception& error) {
    finding.details = std::string("threw: ") + error.what();
  } catch (...) {
    finding.details = "threw an exception that is not a std::exception";
  }
  const char* rest = finding.details.data();
  for (std::size_t left = finding.details.size(); left > 0;) {
    const ssize_t written = write(pipe, rest, left);
    if (written <= 0) break;
    rest += written;
    left -= static_cast<std::size_t>(written);
  }
  _exit(finding.passed ? kFinished : kFound);
}

/// Reads until the end of the data or the deadline; false at the deadline.
bool read_all(int pipe, double time_limit, std::string& text) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::duration<double>(time_limit);
  for (;;) {
    const auto left = std::chrono::duration<double, std::milli>(deadline - Clock::now()).count();
    if (left <= 0.0) return false;
    pollfd waiting{pipe, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(left) + 1);
    if (ready < 0 && errno != EINTR) return true;
    if (ready <= 0) continue;
    char part[4096];
    const ssize_t got = read(pipe, part, sizeof(part));
    if (got <= 0) return true;
    text.append(part, static_cast<std::size_t>(got));
  }
}

}  // namespace

Finding run_isolated(const std::function<Finding()>& work, double time_limit) {
  int ends[2];
  if (pipe(ends) != 0) throw RunError("no pipe for a check: " + std::string(std::strerror(errno)));
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw RunError("no process for a check: " + std::string(std::strerror(errno)));
  if (child == 0) {
    close(ends[0]);
    report_and_leave(ends[1], work);
  }
  close(ends[1]);
  Finding finding{false, ""};
  const bool in_time = read_all(ends[0], time_limit, finding.details);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!in_time) return {false, "took more than " + to_short_text(time_limit) + " s"};
  if (WIFSIGNALED(status)) return {false, std::string("crashed: ") + strsignal(WTERMSIG(status))};
  finding.passed = WIFEXITED(status) && WEXITSTATUS(status) == kFinished;
  if (!finding.passed && finding.details.empty())
    finding.details = "ended the process with status " + std::to_string(WEXITSTATUS(status));
  return finding;
}

}  // namespace butee::conformance
