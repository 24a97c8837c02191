#pragma once

#include <memory>
#include <string>

#include "butee/study/table.hpp"

namespace butee::study {

/// A file of rows that is only added to.
class BUTEE_EXPORT RowSink {
 public:
  virtual ~RowSink() = default;
  /// Adds whole rows, row_bytes() each. On return the operating system has them: a process that is killed later loses
  /// none, one that is killed within loses whole rows. Throws RunError.
  virtual void append(std::span<const std::byte> rows) = 0;
  /// Ends the file; an error cannot hide behind it. Throws RunError.
  virtual void close() = 0;
};

/// The rows of a file, one that is being written or whose writer was killed included: all that are whole.
class BUTEE_EXPORT RowSource {
 public:
  virtual ~RowSource() = default;
  virtual std::int64_t size() const = 0;
  /// False where the row is damaged, or was not written as a whole.
  virtual bool read(std::int64_t index, std::span<std::byte> row) = 0;
};

/// A format of files of rows.
class BUTEE_EXPORT RowFormat {
 public:
  virtual ~RowFormat() = default;
  virtual std::string name() const = 0;       ///< "csv"
  virtual std::string extension() const = 0;  ///< ".csv"
  /// Throws RunError where the file cannot be made.
  virtual std::unique_ptr<RowSink> create(const std::string& path, const Layout& layout, const std::string& title) = 0;
  /// Throws RunError where it cannot be opened, or holds other columns. Of a file that its writer was killed in the
  /// beginning of it has no rows.
  virtual std::unique_ptr<RowSource> open(const std::string& path, const Layout& layout) = 0;
};

BUTEE_EXPORT std::unique_ptr<RowFormat> csv_format();
/// The format of the module study_hdf5. Throws InputError where that is not installed.
BUTEE_EXPORT std::unique_ptr<RowFormat> hdf5_format();
/// "hdf5", "csv", or "" for hdf5 where its module is installed, else csv.
BUTEE_EXPORT std::unique_ptr<RowFormat> row_format(const std::string& name);

}  // namespace butee::study
