#pragma once

#include <optional>
#include <string>

#include "butee/config/value.hpp"

namespace butee::config {

/// Parses the text of a TOML file. Throws InputError ("name:line: what is wrong") if it is not
/// valid TOML.
BUTEE_EXPORT Document parse_toml(const std::string& text, const std::string& name);

/// Reads and parses a file. Throws InputError if it cannot be read.
BUTEE_EXPORT Document load_toml(const std::string& path);

/// A single value in TOML syntax ("1e-6", "[1, 2]", "\"text\""), or nothing if it is not valid
/// TOML.
BUTEE_EXPORT std::optional<Value> parse_toml_value(const std::string& text);

/// The value in TOML syntax on one line.
BUTEE_EXPORT std::string to_toml(const Value& value);

/// A whole document: keys of a table before its sub-tables, otherwise in the order of the file.
BUTEE_EXPORT std::string write_toml(const Table& root);

}  // namespace butee::config
