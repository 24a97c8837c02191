#pragma once

#include <cstdint>
#include <string>

#include "butee/record/folder_lock.hpp"

namespace butee::record {

/// The folder of a run's results. A folder belongs to butee if its model.toml starts with butee's
/// mark; in such a folder only butee's own files are replaced. Any other folder that is not empty
/// is refused.
class BUTEE_EXPORT ResultFolder {
 public:
  explicit ResultFolder(std::string path) : path_(std::move(path)) {}

  /// Throws InputError if the folder does not belong to butee, or if another process is writing
  /// there. Writes nothing.
  void check() const;

  /// For results other than those of a run: throws as check() does, and if the folder holds the results of a run.
  void check_holds_no_run() const;

  /// Creates the folder and locks it for writing, until the lock is destroyed. Throws as check()
  /// does, and RunError.
  [[nodiscard]] FolderLock lock() const;

  /// Throws InputError if the folder is not a result folder of an earlier run.
  void check_is_ours() const;
  /// True if the run whose results are here was completed.
  bool is_complete() const;

  /// Removes files of an earlier run and writes model.toml. To be called after lock(). Throws
  /// RunError.
  void prepare(const std::string& model_text) const;

  /// Writes a whole file, first under a temporary name, then moved to its place. Throws RunError.
  void write(const std::string& name, const std::string& text) const;

  std::string file(const std::string& name) const;
  /// The content of a file, and its checksum; empty if there is none.
  std::string read(const std::string& name) const;
  std::uint64_t checksum_of(const std::string& name) const;
  const std::string& path() const { return path_; }

 private:
  void refuse_foreign() const;

  std::string path_;
};

}  // namespace butee::record
