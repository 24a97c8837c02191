#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "butee/config/parameter.hpp"
#include "butee/core/types.hpp"

namespace butee::model {

/// A quantity recorded at every node, or a column of the history.
struct Field {
  std::string name;    ///< "u"
  std::string unit;    ///< "m"
  bool whole = false;  ///< its values are small integers
};

/// Nodes drawn as one line, as indices into FieldLayout::nodes.
struct FieldLine {
  std::string name;
  std::vector<Index> nodes;
};

/// The recorded nodes, their positions, and the lines drawn between them.
struct FieldLayout {
  std::string title;
  std::vector<std::string> nodes;                ///< "string:17"
  std::vector<double> coordinates;               ///< m, along the node's beam; 0 for a lone node
  std::vector<std::array<double, 3>> positions;  ///< m, at rest, in space: along the beam, along u, across
  std::vector<FieldLine> lines;                  ///< a node in no line is drawn as a point
  std::vector<Field> fields;
  std::vector<Field> columns;  ///< of a row of the history: "t", "mid.u", ..., "h"; empty in readers
};

/// Writes the fields of a run, record by record, and its history, row by row. Every function throws
/// RunError if writing fails.
class BUTEE_EXPORT FieldWriter {
 public:
  virtual ~FieldWriter() = default;
  /// The record at time `t` in s: all nodes of the first field, then of the next. Times ascend.
  virtual void append(double t, std::span<const double> values) = 0;
  /// A row of the history, one value for each of FieldLayout::columns. Ignored by formats that do
  /// not store rows.
  virtual void append_row(std::span<const double> /*values*/) {}
  /// Flushes everything to disk. Data written earlier stay readable at any instant.
  virtual void finish() = 0;
};

/// Reads the fields of a run. Throws RunError.
class BUTEE_EXPORT FieldReader {
 public:
  virtual ~FieldReader() = default;
  virtual const FieldLayout& layout() const = 0;
  /// times of the records, s
  virtual const std::vector<double>& times() const = 0;
  /// One field of one record, at all nodes.
  virtual void read(std::size_t record, std::size_t field, std::span<double> values) = 0;
};

/// A file format for fields; `name` is its name in [output] formats.
struct FieldFormat {
  std::string name, summary;
  std::vector<config::Parameter> parameters;  ///< none at present
  /// Makes a writer for an existing folder.
  std::function<std::unique_ptr<FieldWriter>(const std::string& folder, const FieldLayout& layout)> make;
  /// Opens a folder for reading.
  std::function<std::unique_ptr<FieldReader>(const std::string& folder)> open;
};

}  // namespace butee::model
