#pragma once

#include <optional>
#include <vector>

#include "butee/config/parameters.hpp"

namespace butee::config {

/// The keys by which a table of the scene names columns of numbers in a text file: file, columns, skip, scale, and, as
/// model.toml has them, size and checksum.
BUTEE_EXPORT std::vector<Parameter> number_file_parameters();

/// An argument and its values, of equal length.
struct NumberTable {
  std::vector<double> arguments, values;
};

/// Reads the file that these keys name. The argument's column ascends. Returns nothing after a complaint about `file`
/// that names the file's line.
///
/// Columns are separated by commas, tabs or spaces, or by semicolons where the first line has one. Empty lines and
/// those that begin with # or % are left out, and so is a first line that begins with no number: it may name the
/// columns.
BUTEE_EXPORT std::optional<NumberTable> read_number_file(const Parameters& parameters, Diagnostics& diagnostics);

}  // namespace butee::config
