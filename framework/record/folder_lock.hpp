#pragma once

#include <memory>
#include <string>

#include "butee/record/file.hpp"

namespace butee::record {

/// The right to write into a result folder, which one process at a time has.
///
/// A lock on the open file DIR/.butee-lock, which holds the number of the process. The kernel releases it when the
/// process ends, also by a kill; the file that is then left over blocks nobody. File systems without locks are warned
/// of.
class BUTEE_EXPORT FolderLock {
 public:
  /// Takes the lock of a folder that exists. Throws InputError where another process has it, RunError where the folder
  /// cannot be written.
  explicit FolderLock(const std::string& folder);
  /// Takes the file away.
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept = default;
  FolderLock& operator=(FolderLock&&) = delete;

  /// Throws InputError where another process has the lock. Writes nothing.
  static void check(const std::string& folder);

  /// The name of the file in the folder.
  static constexpr const char* kName = ".butee-lock";

 private:
  std::string path_;
  std::unique_ptr<File> file_;
};

}  // namespace butee::record
