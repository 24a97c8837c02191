#pragma once

#include <optional>
#include <vector>

#include "butee/config/parameters.hpp"

namespace butee::config {

/// The keys by which a table of the scene refers to columns of numbers in a text file: file,
/// columns, skip, scale, and, in model.toml, size and checksum.
BUTEE_EXPORT std::vector<Parameter> number_file_parameters();

/// An argument and its values, of equal length.
struct NumberTable {
  std::vector<double> arguments, values;
};

/// Reads the file that these keys name. The column of arguments must ascend. Returns nothing after
/// an error message about `file` with the line in the file.
///
/// Columns are separated by commas, tabs or spaces, or by semicolons if the first line has one.
/// Empty lines and lines that begin with # or % are skipped; so is a first line that does not begin
/// with a number, which may name the columns.
BUTEE_EXPORT std::optional<NumberTable> read_number_file(const Parameters& parameters, Diagnostics& diagnostics);

}  // namespace butee::config
