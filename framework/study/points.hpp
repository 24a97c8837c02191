#pragma once

#include <string>
#include <vector>

#include "butee/config/value.hpp"

namespace butee::study {

/// Points as CSV: a line of names, then a line for each point.
struct PointTable {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;  ///< line numbers in the file, one entry per row
};

/// Reads CSV; empty lines and those that begin with # are skipped. Throws InputError, without the
/// file's name, if a line has a different number of cells than the first.
BUTEE_EXPORT PointTable read_points(const std::string& text);

/// A cell without blanks around it, interpreted as by `--set`: a value in TOML syntax, or else a text.
BUTEE_EXPORT config::Value value_of(const std::string& cell);

}  // namespace butee::study
