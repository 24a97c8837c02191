#pragma once

#include "butee/core/bytes.hpp"
#include "butee/time/simulation.hpp"

namespace butee::time {

/// Converts a snapshot to bytes, for files and messages, and back. read_snapshot() throws RunError
/// if the bytes hold no snapshot.
BUTEE_EXPORT void write_snapshot(const Snapshot& snapshot, ByteWriter& to);
BUTEE_EXPORT Snapshot read_snapshot(ByteReader& from);

}  // namespace butee::time
