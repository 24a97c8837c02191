#pragma once

#include "butee/config/value.hpp"
#include "butee/core/bytes.hpp"

namespace butee::python {

/// A document with the places of its values, for pickles, and back. Throws RunError where the bytes are damaged.
std::vector<std::byte> to_bytes(const config::Document& document);
config::Document to_document(std::span<const std::byte> bytes);

/// Takes away the sources that no value comes from any longer, all but the first.
void drop_unused_sources(config::Document& document);

}  // namespace butee::python
