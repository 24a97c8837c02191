#include "butee/study/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"
#include "butee/record/csv_writer.hpp"

namespace butee::study {
namespace {

/// Writes a cell in quotes if it contains a comma or quotes; line breaks become spaces.
void append_text(std::string& line, std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }, ' ');
  if (text.find_first_of(",\"") == std::string::npos) {
    line += text;
    return;
  }
  line += '"';
  for (const char c : text) {
    if (c == '"') line += '"';
    line += c;
  }
  line += '"';
}

}  // namespace

Layout::Layout(std::vector<Column> columns) : columns_(std::move(columns)) {
  for (const Column& column : columns_) {
    offsets_.push_back(row_bytes_);
    row_bytes_ += column.type == Column::Type::text ? column.length : 8 * column.length;
  }
}

std::size_t Layout::find(const std::string& name) const {
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if (columns_[i].name == name) return i;
  throw LogicError("a study has no column " + name);
}

Row::Row(const Layout& layout) : layout_(&layout), bytes_(layout.row_bytes()) {
  for (std::size_t i = 0; i < layout.columns().size(); ++i)
    if (const Column& column = layout.columns()[i]; column.type == Column::Type::number)
      for (std::size_t k = 0; k < column.length; ++k) set(i, std::numeric_limits<double>::quiet_NaN(), k);
}

Row::Row(const Layout& layout, std::span<const std::byte> bytes)
    : layout_(&layout), bytes_(bytes.begin(), bytes.end()) {
  require(bytes.size() == layout.row_bytes(), "a row of this layout");
}

void Row::set(std::size_t column, double value, std::size_t entry) {
  if (!std::isfinite(value)) value = std::numeric_limits<double>::quiet_NaN();
  std::memcpy(bytes_.data() + layout_->offset(column) + 8 * entry, &value, sizeof value);
}

void Row::set_integer(std::size_t column, std::int64_t value) {
  std::memcpy(bytes_.data() + layout_->offset(column), &value, sizeof value);
}

void Row::set_text(std::size_t column, const std::string& text) {
  const std::size_t room = layout_->columns()[column].length;
  std::size_t size = std::min(room, text.size());
  // Text in UTF-8 is cut between characters, before a byte that begins one.
  while (size > 0 && size < text.size() && (static_cast<unsigned char>(text[size]) & 0xC0U) == 0x80U) --size;
  std::memset(bytes_.data() + layout_->offset(column), 0, room);
  std::memcpy(bytes_.data() + layout_->offset(column), text.data(), size);
}

double Row::number(std::size_t column, std::size_t entry) const {
  double value = 0.0;
  std::memcpy(&value, bytes_.data() + layout_->offset(column) + 8 * entry, sizeof value);
  return value;
}

std::int64_t Row::integer(std::size_t column) const {
  std::int64_t value = 0;
  std::memcpy(&value, bytes_.data() + layout_->offset(column), sizeof value);
  return value;
}

std::string Row::text(std::size_t column) const {
  const auto* begin = reinterpret_cast<const char*>(bytes_.data() + layout_->offset(column));
  return {begin, std::find(begin, begin + layout_->columns()[column].length, '\0')};
}

std::string csv_header(const Layout& layout) {
  std::string line;
  for (const Column& column : layout.columns()) {
    const bool is_list = column.type == Column::Type::number && column.length > 1;
    for (std::size_t k = 0; k < (is_list ? column.length : 1); ++k) {
      if (!line.empty()) line += ',';
      append_text(line, is_list ? column.name + "[" + std::to_string(k + 1) + "]" : column.name);
    }
  }
  return line;
}

std::string csv_line(const Layout& layout, const Row& row) {
  std::string line;
  for (std::size_t i = 0; i < layout.columns().size(); ++i) {
    const Column& column = layout.columns()[i];
    if (i > 0) line += ',';
    if (column.type == Column::Type::text) append_text(line, row.text(i));
    if (column.type == Column::Type::integer) line += std::to_string(row.integer(i));
    if (column.type == Column::Type::number)
      for (std::size_t k = 0; k < column.length; ++k) {
        if (k > 0) line += ',';
        record::append_number(line, row.number(i, k));
      }
  }
  return line;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && is_quoted && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += '"';
      ++i;
    } else if (c == '"') {
      is_quoted = !is_quoted;
    } else if (c == ',' && !is_quoted) {
      cells.emplace_back();
    } else if (c != '\r') {
      cells.back() += c;
    }
  }
  return cells;
}

Row from_csv(const Layout& layout, const std::string& line) {
  const std::vector<std::string> cells = cells_of(line);
  std::size_t wanted = 0;
  for (const Column& column : layout.columns()) wanted += column.type == Column::Type::text ? 1 : column.length;
  if (cells.size() != wanted)
    throw RunError("a line needs " + std::to_string(wanted) + " cells; it has " + std::to_string(cells.size()));
  Row row(layout);
  auto cell = cells.begin();
  const auto read = [&](auto& value) {
    const auto number = whole_number<std::remove_reference_t<decltype(value)>>(*cell);
    if (!number) throw RunError("\"" + *cell + "\" is not a number");
    value = *number;
  };
  for (std::size_t i = 0; i < layout.columns().size(); ++i) {
    const Column& column = layout.columns()[i];
    if (column.type == Column::Type::text) {
      row.set_text(i, *cell++);
      continue;
    }
    for (std::size_t k = 0; k < column.length; ++k, ++cell) {
      if (column.type == Column::Type::integer) {
        std::int64_t value = 0;
        read(value);
        row.set_integer(i, value);
      } else if (!cell->empty()) {
        double value = 0.0;
        read(value);
        row.set(i, value, k);
      }
    }
  }
  return row;
}

}  // namespace butee::study
