#include "butee/record/csv_writer.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::record {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 18;

}  // namespace

void append_number(std::string& text, double value) {
  if (!std::isfinite(value)) return;
  std::array<char, 40> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 17).ptr;
  text.append(digits.data(), end);
}

CsvWriter::CsvWriter(const std::string& path, const std::vector<std::string>& columns)
    : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) throw RunError(path + ": cannot be written: " + std::strerror(errno));
  line(join(columns, ","));
  flush();
}

void CsvWriter::row(std::span<const double> values) {
  const auto begin = std::chrono::steady_clock::now();
  bool first = true;
  for (const double value : values) {
    if (!first) buffer_ += ',';
    first = false;
    append_number(buffer_, value);
  }
  buffer_ += '\n';
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (buffer_.size() > kBufferSize) flush();
}

void CsvWriter::line(const std::string& text) {
  buffer_ += text;
  buffer_ += '\n';
  if (buffer_.size() > kBufferSize) flush();
}

void CsvWriter::flush() {
  const auto begin = std::chrono::steady_clock::now();
  const bool ok =
      std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) == buffer_.size() && std::fflush(file_.get()) == 0;
  buffer_.clear();
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!ok) throw RunError(path_ + ": cannot be written: " + std::strerror(errno));
}

void CsvWriter::close() {
  if (!file_) return;
  flush();
  if (std::fclose(file_.release()) != 0) throw RunError(path_ + ": cannot be written: " + std::strerror(errno));
}

}  // namespace butee::record
