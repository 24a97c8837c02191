#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <butee/export.hpp>

namespace butee::record {

/// A file of the operating system, open as long as this lives.
class BUTEE_EXPORT File {
 public:
  /// `flags` as of open(2). Throws RunError where it cannot be opened.
  File(const std::string& path, int flags);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  int descriptor() const { return descriptor_; }
  bool is_open() const { return descriptor_ >= 0; }
  /// The number of bytes written; where that is not all of them errno says why.
  std::size_t write(std::span<const std::byte> bytes);
  /// False where that fails, as errno says.
  bool close();

 private:
  int descriptor_;
};

/// Puts a whole file in its place at once: whoever looks, at any moment and after a crash too, finds the earlier file
/// or this one. Throws RunError, and then leaves the earlier one alone.
BUTEE_EXPORT void write_whole(const std::string& path, std::span<const std::byte> bytes);

}  // namespace butee::record
