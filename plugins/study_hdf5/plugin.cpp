#include <algorithm>
#include <cstring>
#include <filesystem>

#include <butee/core/bytes.hpp>
#include <butee/core/error.hpp>
#include <butee/plugin/entry.hpp>
#include <butee/study/row_file.hpp>

#include "../hdf5/handle.hpp"

namespace butee::plugins::study_hdf5 {
namespace {

using hdf5::check;
using hdf5::Handle;
using study::Column;
using study::Layout;

constexpr const char *kRows = "rows", *kChecksum = "row_checksum", *kMadeBy = "butee study 1";
constexpr hsize_t kChunkBytes = hsize_t{1} << 16U, kMostRowsInChunk = 4096;
constexpr std::size_t kBlockBytes = std::size_t{1} << 18U;

Handle type_of(const Column& column) {
  if (column.type == Column::Type::text) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a type of text");
    check(H5Tset_size(type, column.length), "make a type of text");
    check(H5Tset_strpad(type, H5T_STR_NULLPAD), "make a type of text");
    check(H5Tset_cset(type, H5T_CSET_UTF8), "make a type of text");
    return type;
  }
  const hid_t plain = column.type == Column::Type::integer ? H5T_STD_I64LE : H5T_IEEE_F64LE;
  if (column.length == 1) return {H5Tcopy(plain), H5Tclose, "make a type"};
  const hsize_t length = column.length;
  return {H5Tarray_create2(plain, 1, &length), H5Tclose, "make a type of an array"};
}

/// The type of a row in the file: the bytes of the row, then their checksum; packed.
Handle row_type(const Layout& layout) {
  Handle type(H5Tcreate(H5T_COMPOUND, layout.row_bytes() + 8), H5Tclose, "make a type of rows");
  for (std::size_t i = 0; i < layout.columns().size(); ++i) {
    const Column& column = layout.columns()[i];
    check(H5Tinsert(type, column.name.c_str(), layout.offset(i), type_of(column)), "make a column " + column.name);
  }
  check(H5Tinsert(type, kChecksum, layout.row_bytes(), H5T_STD_U64LE), "make a column");
  return type;
}

std::string joined(const Layout& layout, std::string Column::*text) {
  std::string all;
  for (const Column& column : layout.columns()) all += (all.empty() ? "" : "\n") + (column.*text);
  return all;
}

class Sink final : public study::RowSink {
 public:
  Sink(const std::string& path, const Layout& layout, const std::string& title)
      : path_(path), row_bytes_(layout.row_bytes()), type_(row_type(layout)) {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "set up a file");
    check(H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "set up a file");
#if H5_VERSION_GE(1, 10, 7)
    // Other programs may read while rows are added.
    check(H5Pset_file_locking(access, false, true), "set up a file");
#endif
    file_ = Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "make " + path);
    const hsize_t none = 0, any = H5S_UNLIMITED;
    const hsize_t chunk = std::clamp<hsize_t>(kChunkBytes / (row_bytes_ + 8), 1, kMostRowsInChunk);
    const Handle space(H5Screate_simple(1, &none, &any), H5Sclose, "make " + path);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make " + path);
    check(H5Pset_chunk(creation, 1, &chunk), "make " + path);
    set_ = Handle(H5Dcreate2(file_, kRows, type_, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose, "make " + path);
    hdf5::write_attribute(file_, "made_by", kMadeBy);
    hdf5::write_attribute(file_, "title", title);
    // One line for each column: its unit, "1" for pure numbers, empty if it is not known.
    hdf5::write_attribute(set_, "columns", joined(layout, &Column::name));
    hdf5::write_attribute(set_, "units", joined(layout, &Column::unit));
    check(H5Fstart_swmr_write(file_), "let others read " + path);
  }

  void append(std::span<const std::byte> rows) override {
    try {
      add(rows);
    } catch (const RunError&) {
      // The file stays as a killed writer would leave it, with all rows that were flushed. Closing
      // it would write a part of the rest, and readers would refuse it.
      set_.abandon();
      file_.abandon();
      throw;
    }
  }

  void close() override {
    const bool is_set_closed = set_.reset();
    if (!file_.reset() || !is_set_closed) throw RunError("HDF5 cannot close " + path_);
  }

 private:
  void add(std::span<const std::byte> rows) {
    hdf5::be_silent();  // HDF5 has this setting per thread.
    const hsize_t count = rows.size() / row_bytes_, before = size_, after = size_ + count;
    packed_.resize(count * (row_bytes_ + 8));
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = rows.subspan(i * row_bytes_, row_bytes_);
      const std::uint64_t sum = checksum(row);
      std::byte* to = packed_.data() + i * (row_bytes_ + 8);
      std::memcpy(to, row.data(), row_bytes_);
      std::memcpy(to + row_bytes_, &sum, 8);
    }
    check(H5Dset_extent(set_, &after), "extend " + path_);
    const Handle space(H5Dget_space(set_), H5Sclose, "extend " + path_);
    const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose, "extend " + path_);
    check(H5Sselect_hyperslab(space, H5S_SELECT_SET, &before, nullptr, &count, nullptr), "extend " + path_);
    check(H5Dwrite(set_, type_, memory, space, H5P_DEFAULT, packed_.data()), "write " + path_);
    check(H5Dflush(set_), "write " + path_);
    size_ = after;
  }

  std::string path_;
  std::size_t row_bytes_;
  Handle type_, file_, set_;
  hsize_t size_ = 0;
  std::vector<std::byte> packed_;
};

class Source final : public study::RowSource {
 public:
  Source(const std::string& path, const Layout& layout)
      : path_(path), row_bytes_(layout.row_bytes()), type_(row_type(layout)) {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "set up a file");
#if H5_VERSION_GE(1, 10, 7)
    check(H5Pset_file_locking(access, false, true), "set up a file");
#endif
    // If the writer was killed, the file is still marked as being written.
    hid_t id = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access);
    if (id < 0) id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
    std::error_code error;
    if (id < 0 && std::filesystem::file_size(path, error) == 0) return;  // The writer was killed at its start.
    file_ = Handle(id, H5Fclose, "open " + path);
    if (H5Lexists(file_, kRows, H5P_DEFAULT) <= 0) return;
    set_ = Handle(H5Dopen2(file_, kRows, H5P_DEFAULT), H5Dclose, "read " + path);
    if (hdf5::read_attribute(set_, "columns") != joined(layout, &Column::name)) {
      if (H5Aexists(set_, "columns") <= 0) return;
      throw RunError(path + ": holds other columns than this study has");
    }
    const Handle type(H5Dget_type(set_), H5Tclose, "read " + path);
    if (H5Tget_size(type) != row_bytes_ + 8) throw RunError(path + ": holds other columns than this study has");
    const hdf5::Sizes size = hdf5::size_of(set_);
    size_ = size.empty() ? 0 : static_cast<std::int64_t>(size.front());
  }

  std::int64_t size() const override {
    return size_;
  }

  bool read(std::int64_t index, std::span<std::byte> row) override {
    if ((index < first_ || index >= first_ + count_) && !load(index)) return false;
    const std::byte* from = block_.data() + static_cast<std::size_t>(index - first_) * (row_bytes_ + 8);
    std::uint64_t sum = 0;
    std::memcpy(row.data(), from, row_bytes_);
    std::memcpy(&sum, from + row_bytes_, 8);
    return sum == checksum(row);
  }

 private:
  /// Reads the rows from `index` on into memory, or that one only if the others cannot be read.
  bool load(std::int64_t index) {
    const auto most = static_cast<std::int64_t>(std::max<std::size_t>(1, kBlockBytes / (row_bytes_ + 8)));
    for (const std::int64_t count : {std::min(most, size_ - index), std::int64_t{1}}) {
      block_.resize(static_cast<std::size_t>(count) * (row_bytes_ + 8));
      first_ = index;
      count_ = read_block(static_cast<hsize_t>(index), static_cast<hsize_t>(count)) ? count : 0;
      if (count_ > 0) return true;
    }
    return false;
  }

  bool read_block(hsize_t first, hsize_t count) {
    const Handle space(H5Dget_space(set_), H5Sclose, "read " + path_);
    const Handle memory(H5Screate_simple(1, &count, nullptr), H5Sclose, "read " + path_);
    check(H5Sselect_hyperslab(space, H5S_SELECT_SET, &first, nullptr, &count, nullptr), "read " + path_);
    return H5Dread(set_, type_, memory, space, H5P_DEFAULT, block_.data()) >= 0;
  }

  std::string path_;
  std::size_t row_bytes_;
  Handle type_, file_, set_;
  std::int64_t size_ = 0, first_ = 0, count_ = 0;
  std::vector<std::byte> block_;
};

class Format final : public study::RowFormat {
 public:
  Format() {
    // HDF5 1.10 crashes at the end of the process if it could not write a file completely.
    H5dont_atexit();
    hdf5::be_silent();
  }
  std::string name() const override { return "hdf5"; }
  std::string extension() const override { return ".h5"; }
  std::unique_ptr<study::RowSink> create(const std::string& path, const Layout& layout,
                                         const std::string& title) override {
    return std::make_unique<Sink>(path, layout, title);
  }
  std::unique_ptr<study::RowSource> open(const std::string& path, const Layout& layout) override {
    return std::make_unique<Source>(path, layout);
  }
};

}  // namespace
}  // namespace butee::plugins::study_hdf5

BUTEE_PLUGIN(registrar) {
  (void)registrar;  // The module has no types; studies look up the function below.
}

extern "C" __attribute__((visibility("default"))) void* butee_study_hdf5() {
  return static_cast<butee::study::RowFormat*>(new butee::plugins::study_hdf5::Format);
}
