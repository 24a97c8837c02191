#include "elements/matrix_market.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <vector>

#include "butee/core/error.hpp"
#include "butee/core/text.hpp"

namespace butee::elements {
namespace {

constexpr std::size_t kLongestShown = 40;
constexpr const char* kHeader = "\"%%MatrixMarket matrix coordinate real symmetric\"";

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// Reads a text line by line, and a line field by field.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  /// Advances to the next line; false at the end.
  bool next_line() {
    if (rest_.empty()) return false;
    const auto end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return true;
  }
  /// Advances to the next line that is neither empty nor a comment; false at the end.
  bool next_entry() {
    while (next_line()) {
      while (!line_.empty() && is_blank(line_.front())) line_.remove_prefix(1);
      if (!line_.empty() && line_.front() != '%') return true;
    }
    return false;
  }
  /// The next field of the line, "" at its end.
  std::string_view field() {
    while (!line_.empty() && is_blank(line_.front())) line_.remove_prefix(1);
    std::size_t end = 0;
    while (end < line_.size() && !is_blank(line_[end])) ++end;
    const std::string_view taken = line_.substr(0, end);
    line_.remove_prefix(end);
    return taken;
  }

  template <class Number>
  Number number(const std::string& what) {
    std::string_view text = field();
    const std::string_view whole = text;
    if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
    const auto value = whole_number<Number>(text);
    if (whole.empty()) refuse("lacks " + what);
    if (!value)
      refuse(what + ": \"" + printable(whole.substr(0, kLongestShown)) + "\" is not " +
             (std::is_integral_v<Number> ? "an integer" : "a number"));
    if constexpr (!std::is_integral_v<Number>)
      if (!std::isfinite(*value)) refuse(what + " is not finite");
    return *value;
  }
  void end_line() {
    if (const auto more = field(); !more.empty())
      refuse("has more than it should: \"" + printable(more.substr(0, kLongestShown)) + "\"");
  }
  [[noreturn]] void refuse(const std::string& complaint) const {
    throw InputError(":" + std::to_string(number_) + ": " + complaint);
  }
  std::size_t line() const { return number_; }

 private:
  std::string_view rest_, line_;
  std::size_t number_ = 0;
};

struct Header {
  bool is_coordinate = true;
  enum class Structure { general, symmetric, skew } structure = Structure::general;
};

Header read_header(Reader& reader) {
  std::array<std::string, 5> words;
  if (reader.next_line())
    for (std::string& word : words) {
      word = reader.field();
      std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    }
  if (words[0] != "%%matrixmarket" || words[1] != "matrix")
    throw InputError(std::string(":1: is not a Matrix Market file; such a file begins with a line such as ") + kHeader);
  Header header;
  header.is_coordinate = words[2] == "coordinate";
  if (words[2] != "coordinate" && words[2] != "array")
    reader.refuse("the format must be coordinate or array, not \"" + printable(words[2]) + "\"");
  if (words[3] != "real" && words[3] != "integer" && words[3] != "double")
    reader.refuse("entries must be real or integer, not \"" + printable(words[3]) + "\"");
  if (words[4] == "symmetric")
    header.structure = Header::Structure::symmetric;
  else if (words[4] == "skew-symmetric")
    header.structure = Header::Structure::skew;
  else if (words[4] != "general")
    reader.refuse("the structure must be general, symmetric or skew-symmetric, not \"" + printable(words[4]) + "\"");
  reader.end_line();
  return header;
}

struct Entry {
  Index row, column;
  double value;
  std::size_t line;
};

std::string place(Index row, Index column) {
  return "(" + std::to_string(row + 1) + ", " + std::to_string(column + 1) + ")";
}

void refuse_doubles(std::vector<Entry>& entries) {
  const auto before = [](const Entry& a, const Entry& b) {
    return a.column != b.column ? a.column < b.column : a.row != b.row ? a.row < b.row : a.line < b.line;
  };
  std::sort(entries.begin(), entries.end(), before);
  const auto twice = std::adjacent_find(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.column == b.column && a.row == b.row;
  });
  if (twice != entries.end())
    throw InputError(":" + std::to_string((twice + 1)->line) + ": entry " + place(twice->row, twice->column) +
                     " was given in line " + std::to_string(twice->line) + " before");
}

class MatrixReader {
 public:
  MatrixReader(Reader& reader, Header header) : reader_(reader), header_(header) {
    if (!reader_.next_entry()) throw InputError(": ends before the size of the matrix");
    const auto rows = reader_.number<std::int64_t>("the number of rows");
    const auto columns = reader_.number<std::int64_t>("the number of columns");
    count_ = header_.is_coordinate ? reader_.number<std::int64_t>("the number of entries") : 0;
    reader_.end_line();
    if (rows < 1 || rows != columns)
      reader_.refuse("the matrix must be square, not " + std::to_string(rows) + " x " + std::to_string(columns));
    if (rows > std::numeric_limits<int>::max() / 8 || count_ < 0)
      reader_.refuse("the size must be below " + std::to_string(std::numeric_limits<int>::max() / 8) +
                     " rows, with 0 or more entries");
    size_ = rows;
  }

  SparseMatrix read() {
    if (header_.is_coordinate)
      read_coordinates();
    else
      read_array();
    if (reader_.next_entry())
      reader_.refuse("there are more entries than the " + std::to_string(count_) + " that the header states");
    refuse_doubles(entries_);
    std::vector<Eigen::Triplet<double>> triplets;
    for (const Entry& entry : entries_) {
      const auto i = static_cast<int>(entry.row), j = static_cast<int>(entry.column);
      triplets.emplace_back(i, j, entry.value);
      if (header_.structure != Header::Structure::general && i != j)
        triplets.emplace_back(j, i, header_.structure == Header::Structure::skew ? -entry.value : entry.value);
    }
    SparseMatrix matrix(size_, size_);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    return matrix;
  }

 private:
  void read_coordinates() {
    for (std::int64_t i = 0; i < count_; ++i) {
      next_entry(i);
      const auto row = reader_.number<std::int64_t>("the row"), column = reader_.number<std::int64_t>("the column");
      if (row < 1 || row > size_ || column < 1 || column > size_)
        reader_.refuse("entry " + place(row - 1, column - 1) + " lies outside the matrix of " + std::to_string(size_) +
                       " rows; rows and columns count from 1");
      add(row - 1, column - 1);
      reader_.end_line();
    }
  }

  void read_array() {
    const bool is_general = header_.structure == Header::Structure::general;
    const Index below = header_.structure == Header::Structure::skew ? 1 : 0;
    for (Index column = 0; column < size_; ++column) count_ += is_general ? size_ : size_ - column - below;
    std::int64_t read = 0;
    for (Index column = 0; column < size_; ++column)
      for (Index row = is_general ? 0 : column + below; row < size_; ++row) {
        next_entry(read++);
        add(row, column);
        reader_.end_line();
      }
  }

  void next_entry(std::int64_t read) {
    if (!reader_.next_entry())
      throw InputError(": ends after " + std::to_string(read) + " of " + std::to_string(count_) + " entries");
  }

  void add(Index row, Index column) {
    const auto value = reader_.number<double>("the value of entry " + place(row, column));
    if (header_.structure != Header::Structure::general && row < column)
      reader_.refuse("entry " + place(row, column) +
                     " lies above the diagonal; of a symmetric or skew-symmetric matrix the file contains only the "
                     "lower triangle");
    if (header_.structure == Header::Structure::skew && row == column)
      reader_.refuse("entry " + place(row, column) + " lies on the diagonal, which is zero in a skew-symmetric matrix");
    if (value != 0.0) entries_.push_back({row, column, value, reader_.line()});
  }

  Reader& reader_;
  Header header_;
  Index size_ = 0;
  std::int64_t count_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace

SparseMatrix read_matrix_market(std::string_view text) {
  Reader reader(text);
  const Header header = read_header(reader);
  return MatrixReader(reader, header).read();
}

}  // namespace butee::elements
