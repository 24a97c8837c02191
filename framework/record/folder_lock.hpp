#pragma once

#include <memory>
#include <string>

#include "butee/record/file.hpp"

namespace butee::record {

/// The right to write into a result folder, held by one process at a time.
///
/// A lock on the open file DIR/.butee-lock, which contains the number of the process. The kernel
/// releases it when the process ends, also by a kill; a file left over blocks no other process.
/// File systems without locks cause a warning.
class BUTEE_EXPORT FolderLock {
 public:
  /// Locks an existing folder. Throws InputError if another process holds the lock, RunError if the
  /// folder cannot be written.
  explicit FolderLock(const std::string& folder);
  /// Removes the file.
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept = default;
  FolderLock& operator=(FolderLock&&) = delete;

  /// Throws InputError if another process holds the lock. Writes nothing.
  static void check(const std::string& folder);

  /// The name of the lock file in the folder.
  static constexpr const char* kName = ".butee-lock";

 private:
  std::string path_;
  std::unique_ptr<File> file_;
};

}  // namespace butee::record
