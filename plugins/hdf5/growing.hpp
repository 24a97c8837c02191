#pragma once

#include <chrono>

#include "handle.hpp"

namespace butee::plugins::hdf5 {

/// What waits in memory goes to disk after so long, where it is as much as the chunk on disk holds.
inline constexpr auto kPatience = std::chrono::seconds(2);

void make_group(hid_t file, const char* name);

/// A dataset that grows in its first dimension, empty at first; `packed`: compressed.
Handle make_growing(hid_t file, const std::string& path, hid_t type, const Sizes& chunk, Sizes size, bool packed);

/// Appends rows behind the first `before`.
void extend(hid_t set, std::size_t before, std::size_t rows, const double* values);

}  // namespace butee::plugins::hdf5
