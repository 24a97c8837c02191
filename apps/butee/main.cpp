#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <new>
#include <unistd.h>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/core/text.hpp>

#include "program.hpp"

namespace {

using namespace butee::app;

/// Opens a read-only /dev/null for each closed standard stream. Otherwise the next opened file would get the
/// stream's number and receive its messages.
void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) < 0) return;
}

/// Keeps freed memory for the next matrix or step. By default the C library returns large pieces to the system at once;
/// mapping and clearing their pages anew takes up to a tenth of a short run.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kKept = 256 << 20;
  mallopt(M_MMAP_THRESHOLD, kKept);
  mallopt(M_TRIM_THRESHOLD, kKept);
#endif
}

/// errno of a failed write to standard output; 0 on success.
int output_error() {
  errno = 0;
  if (std::fflush(stdout) != 0) return errno;
  if (std::ferror(stdout) == 0) return 0;
  // An earlier write failed and errno is lost; another write fails for the same reason.
  errno = 0;
  return write(STDOUT_FILENO, "\n", 1) < 0 ? errno : EIO;
}

/// A failed write to standard output is a failure, unless the reader closed the pipe.
int flushed(int status) {
  const int error = output_error();
  if (error == 0 || error == EPIPE) return status;
  butee::log::error(std::string("standard output: cannot be written: ") + std::strerror(error));
  return status == kDone ? kFailed : status;
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  occupy_standard_streams();
  // A reader that closes the pipe early, such as head, does not stop the run.
  std::signal(SIGPIPE, SIG_IGN);
  // Exceeding the file size limit then makes the write fail with a message.
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
    butee::log::error("a module threw an exception that is not a std::exception");
  }
  return kFailed;
}
