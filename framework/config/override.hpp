#pragma once

#include <string>

#include "butee/config/value.hpp"

namespace butee::config {

/// Applies one `key=value` of the command line to the document: a dotted path with indices
/// (`integrator.time_step=1e-6`, `contact[0].stiffness=1e7`), the value in TOML syntax or, where it is not valid
/// TOML, taken as a string. Nothing behind the sign (`contact[0].regularization=`) takes the key out of the document.
/// Throws InputError for a path that cannot be followed.
BUTEE_EXPORT void apply_override(Document& document, const std::string& assignment);

/// The same with a value that is there already; messages name `key=value`.
BUTEE_EXPORT void apply_override(Document& document, const std::string& key, Value value);

/// The value at a key with dots and indices, or nullptr if there is none. Throws InputError for what is no such
/// key.
BUTEE_EXPORT const Value* find_value(const Document& document, const std::string& key);

}  // namespace butee::config
