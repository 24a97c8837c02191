#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <butee/export.hpp>

namespace butee::study {

/// A column of the rows of a study.
struct Column {
  enum class Type { number, integer, text };

  std::string name, unit;
  Type type = Type::number;
  std::size_t length = 1;  ///< number of numbers in a row; for a text, its bytes
  bool is_cost = false;    ///< may differ between two studies that give the same results
};

/// The columns of a study and their positions in a row of bytes: 8 for each number, `length` for a
/// text.
class BUTEE_EXPORT Layout {
 public:
  explicit Layout(std::vector<Column> columns);

  const std::vector<Column>& columns() const { return columns_; }
  std::size_t offset(std::size_t column) const { return offsets_[column]; }
  std::size_t row_bytes() const { return row_bytes_; }
  /// The index of the column of a name. Throws LogicError if there is none.
  std::size_t find(const std::string& name) const;

 private:
  std::vector<Column> columns_;
  std::vector<std::size_t> offsets_;
  std::size_t row_bytes_ = 0;
};

/// A row. Numbers that are not set are NaN, integers 0, texts empty; all NaNs have the same bits.
class BUTEE_EXPORT Row {
 public:
  /// `layout` must outlive this object.
  explicit Row(const Layout& layout);
  Row(const Layout& layout, std::span<const std::byte> bytes);

  void set(std::size_t column, double value, std::size_t entry = 0);
  void set_integer(std::size_t column, std::int64_t value);
  /// A text that is too long is truncated.
  void set_text(std::size_t column, const std::string& text);

  double number(std::size_t column, std::size_t entry = 0) const;
  std::int64_t integer(std::size_t column) const;
  std::string text(std::size_t column) const;

  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  const Layout* layout_;
  std::vector<std::byte> bytes_;
};

/// The cells of a row for a CSV file, and its header line: columns of several numbers are NAME[1], NAME[2], ...
BUTEE_EXPORT std::string csv_header(const Layout& layout);
BUTEE_EXPORT std::string csv_line(const Layout& layout, const Row& row);
/// The row of a line written by csv_line(). Throws RunError if the line is invalid.
BUTEE_EXPORT Row from_csv(const Layout& layout, const std::string& line);
/// The cells of a line of CSV, without quotes.
BUTEE_EXPORT std::vector<std::string> cells_of(const std::string& line);

}  // namespace butee::study
