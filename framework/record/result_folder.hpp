#pragma once

#include <cstdint>
#include <string>

#include "butee/record/folder_lock.hpp"

namespace butee::record {

/// The folder of a run's results. A folder is ours where its model.toml starts with our mark; of such a folder our own
/// files are replaced and nothing else is touched. Any other folder that is not empty is refused.
class BUTEE_EXPORT ResultFolder {
 public:
  explicit ResultFolder(std::string path) : path_(std::move(path)) {}

  /// Throws InputError where the folder is not ours to write, or where another process is writing there. Writes
  /// nothing.
  void check() const;

  /// Makes the folder and takes the right to write there, until the lock's end. Throws as check() does, and RunError.
  [[nodiscard]] FolderLock lock() const;

  /// Throws InputError where the folder is not one of ours, with results of an earlier run.
  void check_is_ours() const;
  /// True where the run whose results are here was completed.
  bool is_complete() const;

  /// Takes away our files of an earlier run and writes model.toml. After lock(). Throws RunError.
  void prepare(const std::string& model_text) const;

  /// Writes a whole file, first beside its place, then in one move. Throws RunError.
  void write(const std::string& name, const std::string& text) const;

  std::string file(const std::string& name) const;
  /// What a file holds, and its checksum; of nothing where there is none.
  std::string read(const std::string& name) const;
  std::uint64_t checksum_of(const std::string& name) const;
  const std::string& path() const { return path_; }

 private:
  void refuse_foreign() const;

  std::string path_;
};

}  // namespace butee::record
