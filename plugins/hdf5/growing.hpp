#pragma once

#include <chrono>

#include "handle.hpp"

namespace butee::plugins::hdf5 {

/// After this time buffered data are written to disk if they are as much as the last chunk on disk
/// holds.
inline constexpr auto kPatience = std::chrono::seconds(2);

void make_group(hid_t file, const char* name);

/// Creates an empty dataset that can grow in its first dimension; `packed`: compressed.
Handle make_growing(hid_t file, const std::string& path, hid_t type, const Sizes& chunk, Sizes size, bool packed);

/// Appends rows to a dataset that has `before` rows.
void extend(hid_t set, std::size_t before, std::size_t rows, const double* values);

}  // namespace butee::plugins::hdf5
