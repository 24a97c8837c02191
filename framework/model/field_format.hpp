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

/// A quantity that is kept at every node, or a column of the history.
struct Field {
  std::string name;    ///< "u"
  std::string unit;    ///< "m"
  bool whole = false;  ///< its values are small whole numbers
};

/// Nodes that are drawn as one line, as indices into FieldLayout::nodes.
struct FieldLine {
  std::string name;
  std::vector<Index> nodes;
};

/// The nodes whose fields are kept, where they stand, and what is drawn between them.
struct FieldLayout {
  std::string title;
  std::vector<std::string> nodes;                ///< "string:17"
  std::vector<double> coordinates;               ///< m, along the own beam; 0 for a lone node
  std::vector<std::array<double, 3>> positions;  ///< m, at rest: along the beam, along u, across; in space
  std::vector<FieldLine> lines;                  ///< a node in none of them is a point
  std::vector<Field> fields;
  std::vector<Field> columns;  ///< of a row of the history: "t", "mid.u", ..., "h"; a reader leaves it empty
};

/// Takes the fields of a run, record by record, and its history, row by row. Every function throws RunError where
/// writing fails.
class BUTEE_EXPORT FieldWriter {
 public:
  virtual ~FieldWriter() = default;
  /// The record of instant `t` in s: all nodes of the first field, then of the next. Times ascend.
  virtual void append(double t, std::span<const double> values) = 0;
  /// A row of the history, one value for each of FieldLayout::columns. Formats without a place for rows ignore it.
  virtual void append_row(std::span<const double> /*values*/) {}
  /// Puts everything on disk. What was on disk before stays readable at any instant.
  virtual void finish() = 0;
};

/// Gives the fields of a run back. Throws RunError.
class BUTEE_EXPORT FieldReader {
 public:
  virtual ~FieldReader() = default;
  virtual const FieldLayout& layout() const = 0;
  /// s, of the records
  virtual const std::vector<double>& times() const = 0;
  /// One field of one record, at all nodes.
  virtual void read(std::size_t record, std::size_t field, std::span<double> values) = 0;
};

/// A file format for fields, by the name that [output] formats gives it.
struct FieldFormat {
  std::string name, summary;
  std::vector<config::Parameter> parameters;  ///< none so far
  /// Writes into a folder that exists.
  std::function<std::unique_ptr<FieldWriter>(const std::string& folder, const FieldLayout& layout)> make;
  /// Reads from there.
  std::function<std::unique_ptr<FieldReader>(const std::string& folder)> open;
};

}  // namespace butee::model
