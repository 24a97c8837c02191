#include "butee/record/folder_lock.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"

namespace butee::record {
namespace {

/// Number of reads, a millisecond apart, while waiting for the number of a process that has just
/// taken the lock.
constexpr int kLooks = 100;

struct flock whole_file() {
  struct flock range {};
  range.l_type = F_WRLCK;
  range.l_whence = SEEK_SET;
  return range;
}

/// 0 if the file contains none.
pid_t process_in(int descriptor) {
  std::array<char, 32> text{};
  const ssize_t size = pread(descriptor, text.data(), text.size(), 0);
  pid_t process = 0;
  if (size > 0) std::from_chars(text.data(), text.data() + size, process);
  return process;
}

/// The process that holds the lock; 0 if its number is not available. The number of a killed
/// process remains until the next one writes its own.
pid_t holder_of(int descriptor) {
  pid_t process = 0;
  for (int look = 0; look < kLooks; ++look) {
    process = process_in(descriptor);
    if (process > 0 && (kill(process, 0) == 0 || errno == EPERM)) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return process;
}

[[noreturn]] void refuse(const std::string& folder, pid_t holder) {
  throw InputError(folder + ": " + (holder > 0 ? "process " + std::to_string(holder) : "another process") +
                   " is writing its results there; wait until it has ended, or choose another folder with -o");
}

/// Whether the path still refers to the open file: the previous holder of the lock may have removed
/// it.
bool is_at(const std::string& path, int descriptor) {
  struct stat there {
  }, ours{};
  return stat(path.c_str(), &there) == 0 && fstat(descriptor, &ours) == 0 && there.st_dev == ours.st_dev &&
         there.st_ino == ours.st_ino;
}

std::string path_in(const std::string& folder) {
  return (std::filesystem::path(folder) / FolderLock::kName).string();
}

}  // namespace

FolderLock::FolderLock(const std::string& folder) : path_(path_in(folder)) {
  do {
    file_ = std::make_unique<File>(path_, O_RDWR | O_CREAT);
    struct flock range = whole_file();
    if (fcntl(file_->descriptor(), F_OFD_SETLK, &range) == 0) continue;
    if (errno == EAGAIN || errno == EACCES) refuse(folder, holder_of(file_->descriptor()));
    log::warning(folder + ": cannot be locked (" + std::strerror(errno) +
                 "); make sure that no other run writes into it at the same time");
    return;
  } while (!is_at(path_, file_->descriptor()));
  // On a full disk the lock still holds: a refusal then names no process.
  const std::string process = std::to_string(getpid()) + "\n";
  if (ftruncate(file_->descriptor(), 0) == 0) file_->write(std::as_bytes(std::span(process)));
}

FolderLock::~FolderLock() {
  if (file_ && is_at(path_, file_->descriptor())) unlink(path_.c_str());
}

void FolderLock::check(const std::string& folder) {
  const int descriptor = open(path_in(folder).c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  struct flock range = whole_file();
  const bool is_taken = fcntl(descriptor, F_OFD_GETLK, &range) == 0 && range.l_type != F_UNLCK;
  const pid_t holder = is_taken ? holder_of(descriptor) : 0;
  close(descriptor);
  if (is_taken) refuse(folder, holder);
}

}  // namespace butee::record
