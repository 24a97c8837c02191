#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "butee/record/file.hpp"

namespace butee::record {

/// Writes rows of numbers with 17 significant digits, always whole lines. A number that is not finite is left empty.
class BUTEE_EXPORT CsvWriter {
 public:
  /// Creates the file and writes the header. Throws RunError where that fails, as every other function does.
  CsvWriter(const std::string& path, const std::vector<std::string>& columns);
  /// Goes on with a file that is there.
  explicit CsvWriter(const std::string& path);

  void row(std::span<const double> values);
  /// A line already formatted, without its end.
  void line(const std::string& text);
  /// Hands everything to the operating system.
  void flush();
  /// Flushes and closes; a write error cannot hide behind it.
  void close();

  /// Bytes written so far, flushed or not.
  std::uint64_t position() const { return position_; }
  /// Takes away everything behind a position of before.
  void go_back(std::uint64_t position);
  /// Flushes, and waits until the device has it.
  void sync();

  double seconds() const { return seconds_; }

 private:
  [[noreturn]] void fail() const;

  /// After so many bytes of the buffer nothing more could be written: leaves whole lines, and fails.
  [[noreturn]] void give_up(std::size_t done);

  std::string path_, buffer_;
  File file_;
  std::uint64_t flushed_ = 0, position_ = 0;
  double seconds_ = 0.0;
};

/// 17 significant digits, "" where not finite.
BUTEE_EXPORT void append_number(std::string& text, double value);

}  // namespace butee::record
