#pragma once

#include "butee/config/value.hpp"
#include "butee/core/bytes.hpp"

namespace butee::python {

/// Converts a document with the locations of its values to bytes, for pickles, and back. Throws
/// RunError if the bytes are damaged.
std::vector<std::byte> to_bytes(const config::Document& document);
config::Document to_document(std::span<const std::byte> bytes);

/// Removes the sources that no value refers to any more, except the first.
void drop_unused_sources(config::Document& document);

}  // namespace butee::python
