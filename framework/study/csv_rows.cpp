#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <vector>

#include "butee/core/error.hpp"
#include "butee/record/csv_writer.hpp"
#include "butee/study/row_file.hpp"

namespace butee::study {
namespace {

class CsvSink final : public RowSink {
 public:
  CsvSink(const std::string& path, const Layout& layout) : layout_(layout), writer_(path, {csv_header(layout)}) {}
  void append(std::span<const std::byte> rows) override {
    for (; !rows.empty(); rows = rows.subspan(layout_.row_bytes()))
      writer_.line(csv_line(layout_, Row(layout_, rows.first(layout_.row_bytes()))));
    writer_.flush();
  }
  void close() override { writer_.close(); }

 private:
  const Layout& layout_;
  record::CsvWriter writer_;
};

class CsvSource final : public RowSource {
 public:
  CsvSource(const std::string& path, const Layout& layout)
      : path_(path), layout_(layout), file_(path, std::ios::binary) {
    std::string line;
    if (!file_) throw RunError(path + ": cannot be read");
    if (!std::getline(file_, line) || file_.eof()) return;  // Its writer was killed during the first line.
    if (line != csv_header(layout)) throw RunError(path + ": holds other columns than this study has");
    for (auto begin = file_.tellg(); std::getline(file_, line) && !file_.eof(); begin = file_.tellg())
      begins_.push_back(begin);
    file_.clear();
  }
  std::int64_t size() const override { return std::ssize(begins_); }
  bool read(std::int64_t index, std::span<std::byte> row) override {
    file_.seekg(begins_[static_cast<std::size_t>(index)]);
    std::string line;
    if (!std::getline(file_, line)) throw RunError(path_ + ": cannot be read");
    try {
      const Row read = from_csv(layout_, line);
      std::memcpy(row.data(), read.bytes().data(), row.size());
    } catch (const RunError&) {
      return false;
    }
    return true;
  }

 private:
  std::string path_;
  const Layout& layout_;
  std::ifstream file_;
  std::vector<std::streampos> begins_;
};

class CsvFormat final : public RowFormat {
 public:
  std::string name() const override { return "csv"; }
  std::string extension() const override { return ".csv"; }
  std::unique_ptr<RowSink> create(const std::string& path, const Layout& layout, const std::string&) override {
    return std::make_unique<CsvSink>(path, layout);
  }
  std::unique_ptr<RowSource> open(const std::string& path, const Layout& layout) override {
    return std::make_unique<CsvSource>(path, layout);
  }
};

}  // namespace

std::unique_ptr<RowFormat> csv_format() {
  return std::make_unique<CsvFormat>();
}

}  // namespace butee::study
