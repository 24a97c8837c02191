#pragma once

#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <butee/export.hpp>

namespace butee::record {

/// Writes rows of numbers with 17 significant digits, always whole lines. A number that is not finite is left empty.
class BUTEE_EXPORT CsvWriter {
 public:
  /// Creates the file and writes the header. Throws RunError where that fails, as every other function does.
  CsvWriter(const std::string& path, const std::vector<std::string>& columns);

  void row(std::span<const double> values);
  /// A line already formatted, without its end.
  void line(const std::string& text);
  /// Hands everything to the operating system.
  void flush();
  /// Flushes and closes; a write error cannot hide behind it.
  void close();

  double seconds() const { return seconds_; }

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_, buffer_;
  std::unique_ptr<std::FILE, Closer> file_;
  double seconds_ = 0.0;
};

/// 17 significant digits, "" where not finite.
BUTEE_EXPORT void append_number(std::string& text, double value);

}  // namespace butee::record
