#pragma once

#include <string>

#include "butee/config/value.hpp"

namespace butee::config {

/// Applies one `key=value` of the command line to the document: a dotted path with indices
/// (`integrator.time_step=1e-6`, `contact[0].stiffness=1e7`), and a value in TOML syntax; a value
/// that is not valid TOML is taken as a string. An empty value (`contact[0].regularization=`)
/// removes the key from the document. Messages name `origin` and the assignment. Throws InputError for a path that does
/// not exist.
BUTEE_EXPORT void apply_override(Document& document, const std::string& assignment,
                                 const std::string& origin = "--set");

/// The same with a value given as an object; messages name `key=value`.
BUTEE_EXPORT void apply_override(Document& document, const std::string& key, Value value);

/// The value at a key with dots and indices, or nullptr if there is none. Throws InputError for an
/// invalid key.
BUTEE_EXPORT const Value* find_value(const Document& document, const std::string& key);

}  // namespace butee::config
