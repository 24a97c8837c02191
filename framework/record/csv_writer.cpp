#include "butee/record/csv_writer.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

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
    : path_(path), file_(path, O_WRONLY | O_CREAT | O_TRUNC) {
  line(join(columns, ","));
  flush();
}

CsvWriter::CsvWriter(const std::string& path) : path_(path), file_(path, O_WRONLY) {
  const off_t end = lseek(file_.descriptor(), 0, SEEK_END);
  if (end < 0) fail();
  flushed_ = position_ = static_cast<std::uint64_t>(end);
}

void CsvWriter::fail() const {
  throw RunError(path_ + ": cannot be written: " + std::strerror(errno));
}

void CsvWriter::row(std::span<const double> values) {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t before = buffer_.size();
  bool first = true;
  for (const double value : values) {
    if (!first) buffer_ += ',';
    first = false;
    append_number(buffer_, value);
  }
  buffer_ += '\n';
  position_ += buffer_.size() - before;
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (buffer_.size() > kBufferSize) flush();
}

void CsvWriter::line(const std::string& text) {
  buffer_ += text;
  buffer_ += '\n';
  position_ += text.size() + 1;
  if (buffer_.size() > kBufferSize) flush();
}

void CsvWriter::flush() {
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t done = file_.write(std::as_bytes(std::span(buffer_)));
  if (done < buffer_.size()) give_up(done);
  flushed_ += done;
  buffer_.clear();
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void CsvWriter::give_up(std::size_t done) {
  const int reason = errno;
  const std::size_t whole = done > 0 ? buffer_.rfind('\n', done - 1) + 1 : 0;
  // A target that cannot be truncated, such as a device, has no file content to keep.
  const auto end = static_cast<off_t>(flushed_ + whole);
  if (ftruncate(file_.descriptor(), end) == 0 && lseek(file_.descriptor(), end, SEEK_SET) == end)
    position_ = flushed_ += whole;
  buffer_.clear();
  errno = reason;
  fail();
}

void CsvWriter::sync() {
  flush();
  const auto begin = std::chrono::steady_clock::now();
  if (fdatasync(file_.descriptor()) != 0) fail();
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void CsvWriter::go_back(std::uint64_t position) {
  flush();
  if (position > position_)
    throw RunError(path_ + ": has lost rows that belong to the checkpoint; run the scene again");
  const auto size = static_cast<off_t>(position);
  if (ftruncate(file_.descriptor(), size) != 0 || lseek(file_.descriptor(), size, SEEK_SET) != size) fail();
  flushed_ = position_ = position;
}

void CsvWriter::close() {
  if (!file_.is_open()) return;
  flush();
  if (!file_.close()) fail();
}

}  // namespace butee::record
