#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "butee/record/file.hpp"

namespace butee::record {

/// Writes rows of numbers with 17 significant digits, always whole lines. The cell of a number that
/// is not finite is empty.
class BUTEE_EXPORT CsvWriter {
 public:
  /// Creates the file and writes the header. Throws RunError on failure, as every other function
  /// does.
  CsvWriter(const std::string& path, const std::vector<std::string>& columns);
  /// Appends to an existing file.
  explicit CsvWriter(const std::string& path);

  void row(std::span<const double> values);
  /// Writes a formatted line, given without its end.
  void line(const std::string& text);
  /// Passes all data to the operating system.
  void flush();
  /// Flushes and closes; reports a write error.
  void close();

  /// Bytes written so far, flushed or not.
  std::uint64_t position() const { return position_; }
  /// Removes everything after an earlier position.
  void go_back(std::uint64_t position);
  /// Flushes, and waits until the data are on the device.
  void sync();

  double seconds() const { return seconds_; }

 private:
  [[noreturn]] void fail() const;

  /// To be called if only the first `done` bytes of the buffer could be written: keeps whole lines,
  /// and fails.
  [[noreturn]] void give_up(std::size_t done);

  std::string path_, buffer_;
  File file_;
  std::uint64_t flushed_ = 0, position_ = 0;
  double seconds_ = 0.0;
};

/// 17 significant digits, "" if not finite.
BUTEE_EXPORT void append_number(std::string& text, double value);

}  // namespace butee::record
