#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <butee/export.hpp>

namespace butee::record {

/// A file of the operating system, open during the lifetime of this object.
class BUTEE_EXPORT File {
 public:
  /// `flags` as for open(2). Throws RunError if it cannot be opened.
  File(const std::string& path, int flags);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  int descriptor() const { return descriptor_; }
  bool is_open() const { return descriptor_ >= 0; }
  /// The number of bytes written; if not all were written, errno gives the reason.
  std::size_t write(std::span<const std::byte> bytes);
  /// False on failure, with errno set.
  bool close();

 private:
  int descriptor_;
};

/// Replaces a whole file atomically: readers find the earlier file or this one at any time, also
/// after a crash. Throws RunError and then leaves the earlier file unchanged.
BUTEE_EXPORT void write_whole(const std::string& path, std::span<const std::byte> bytes);

/// Renames a complete file, so that after a crash either name holds all of it. Throws RunError.
BUTEE_EXPORT void put_in_place(const std::string& draft, const std::string& path);

}  // namespace butee::record
