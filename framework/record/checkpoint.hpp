#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "butee/core/target.hpp"
#include "butee/linalg/counters.hpp"
#include "butee/record/result_folder.hpp"
#include "butee/time/snapshot.hpp"

namespace butee::record {

/// A run in progress, as stored in a file.
struct Checkpoint {
  std::string method;                    ///< canonical name
  std::string target = butee::target();  ///< the instruction set of the kernels
  std::string compiled_for = butee::compiled_for();
  std::uint64_t model = 0;    ///< checksum of model.toml
  std::uint64_t history = 0;  ///< bytes of history.csv up to the checkpoint
  double setup_seconds = 0.0;
  linalg::Counters counters;
  time::Snapshot snapshot;
};

/// Converts to bytes with a mark, the versions of the format and of the program, and a checksum.
BUTEE_EXPORT std::vector<std::byte> to_bytes(const Checkpoint& checkpoint);
/// Throws RunError if the bytes are damaged, InputError if they are of another version.
BUTEE_EXPORT Checkpoint to_checkpoint(std::span<const std::byte> bytes);

/// The checkpoints of a result folder: the newest and the one before it. If writing one is
/// interrupted, a complete one remains.
class BUTEE_EXPORT CheckpointFolder {
 public:
  explicit CheckpointFolder(const ResultFolder& folder) : folder_(folder) {}

  /// Throws RunError if the checkpoint cannot be written; earlier ones are then unchanged.
  void write(const Checkpoint& checkpoint) const;

  /// The newest complete checkpoint that belongs to the model and the history in the folder; others
  /// are removed with a warning. Throws InputError if model.toml differs from that of the
  /// checkpoint, or if the checkpoint was written with another instruction set, whose results
  /// differ in the last bits.
  std::optional<Checkpoint> newest() const;

  /// Removes both.
  void clear() const;

 private:
  std::optional<Checkpoint> read(const std::string& name) const;

  ResultFolder folder_;
};

}  // namespace butee::record
