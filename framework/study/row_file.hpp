#pragma once

#include <memory>
#include <string>

#include "butee/study/table.hpp"

namespace butee::study {

/// A file of rows to which rows are only appended.
class BUTEE_EXPORT RowSink {
 public:
  virtual ~RowSink() = default;
  /// Appends whole rows, row_bytes() each. On return the operating system has them: a process
  /// killed later loses none, and one killed during the call loses only whole rows. Throws
  /// RunError.
  virtual void append(std::span<const std::byte> rows) = 0;
  /// Closes the file and reports errors. Throws RunError.
  virtual void close() = 0;
};

/// The complete rows of a file, which may still be written or whose writer may have been killed.
class BUTEE_EXPORT RowSource {
 public:
  virtual ~RowSource() = default;
  virtual std::int64_t size() const = 0;
  /// False if the row is damaged or incomplete.
  virtual bool read(std::int64_t index, std::span<std::byte> row) = 0;
};

/// A format of files of rows.
class BUTEE_EXPORT RowFormat {
 public:
  virtual ~RowFormat() = default;
  virtual std::string name() const = 0;       ///< "csv"
  virtual std::string extension() const = 0;  ///< ".csv"
  /// Throws RunError if the file cannot be created.
  virtual std::unique_ptr<RowSink> create(const std::string& path, const Layout& layout, const std::string& title) = 0;
  /// Throws RunError if it cannot be opened, or contains other columns. A file whose writer was
  /// killed while creating it has no rows.
  virtual std::unique_ptr<RowSource> open(const std::string& path, const Layout& layout) = 0;
};

BUTEE_EXPORT std::unique_ptr<RowFormat> csv_format();
/// The format of the module study_hdf5. Throws InputError if that is not installed.
BUTEE_EXPORT std::unique_ptr<RowFormat> hdf5_format();
/// "hdf5", "csv", or "" for hdf5 if its module is installed, else csv.
BUTEE_EXPORT std::unique_ptr<RowFormat> row_format(const std::string& name);

}  // namespace butee::study
