#include "butee/record/file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>
#include <utility>

#include "butee/core/error.hpp"

namespace butee::record {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what = "written") {
  throw RunError(path + ": cannot be " + what + ": " + std::strerror(errno));
}

/// A rename is permanent only after its folder has been synchronised to the device; errors of file
/// systems without this function are ignored.
void sync_folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace

File::File(const std::string& path, int flags) : descriptor_(open(path.c_str(), flags | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) fail(path, (flags & O_ACCMODE) == O_RDONLY ? "read" : "written");
}

File::~File() {
  if (is_open()) ::close(descriptor_);
}

std::size_t File::write(std::span<const std::byte> bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t written = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written == 0) errno = ENOSPC;
    if (written <= 0) break;
    done += static_cast<std::size_t>(written);
  }
  return done;
}

bool File::close() {
  return ::close(std::exchange(descriptor_, -1)) == 0;
}

void write_whole(const std::string& path, std::span<const std::byte> bytes) {
  const std::string draft = path + ".part";
  try {
    File file(draft, O_WRONLY | O_CREAT | O_TRUNC);
    if (file.write(bytes) < bytes.size() || fsync(file.descriptor()) != 0 || !file.close()) fail(path);
    if (std::rename(draft.c_str(), path.c_str()) != 0) fail(path);
  } catch (const RunError&) {
    std::remove(draft.c_str());
    throw;
  }
  sync_folder_of(path);
}

void put_in_place(const std::string& draft, const std::string& path) {
  File file(draft, O_WRONLY);
  if (fsync(file.descriptor()) != 0 || !file.close()) fail(draft);
  if (std::rename(draft.c_str(), path.c_str()) != 0) fail(path);
  sync_folder_of(path);
}

}  // namespace butee::record
