#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <new>
#include <unistd.h>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>

#include "program.hpp"

namespace {

using namespace butee::app;

/// A standard stream that is closed gives its number to the next file that is opened, into which messages would go:
/// here it becomes a file that takes none.
void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) < 0) return;
}

/// Why standard output took no more; 0 where it took everything.
int output_error() {
  errno = 0;
  if (std::fflush(stdout) != 0) return errno;
  if (std::ferror(stdout) == 0) return 0;
  // The write that failed was an earlier one, and its reason is forgotten: another one fails for the same.
  errno = 0;
  return write(STDOUT_FILENO, "\n", 1) < 0 ? errno : EIO;
}

/// Output that could not be printed is a failure, unless nobody wanted to read it.
int flushed(int status) {
  const int error = output_error();
  if (error == 0 || error == EPIPE) return status;
  butee::log::error(std::string("standard output: cannot be written: ") + std::strerror(error));
  return status == kDone ? kFailed : status;
}

}  // namespace

int main(int argc, char** argv) {
  occupy_standard_streams();
  // A reader of our output that closes early, such as head, ends the output and not the run.
  std::signal(SIGPIPE, SIG_IGN);
  // A file that grows beyond its limit is a file that cannot be written, with a message.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return flushed(parse_and_run(argc, argv));
  } catch (const butee::InputError& error) {
    std::fprintf(stderr, "%s\n", butee::printable(error.what(), true).c_str());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    butee::log::error("out of memory");
  } catch (const std::exception& error) {
    butee::log::error(error.what());
  } catch (...) {
    butee::log::error("a module threw something that is no exception of the standard library");
  }
  return kFailed;
}
