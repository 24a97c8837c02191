#pragma once

#include <optional>
#include <string>

#include "butee/core/target.hpp"
#include "butee/linalg/counters.hpp"
#include "butee/record/result_folder.hpp"
#include "butee/time/snapshot.hpp"

namespace butee::record {

/// A run on its way, as a file keeps it.
struct Checkpoint {
  std::string method;                    ///< canonical name
  std::string target = butee::target();  ///< the instruction set of the kernels
  std::string compiled_for = butee::compiled_for();
  std::uint64_t model = 0;    ///< checksum of model.toml
  std::uint64_t history = 0;  ///< bytes of history.csv that belong to it
  double setup_seconds = 0.0;
  linalg::Counters counters;
  time::Snapshot snapshot;
};

/// As bytes with a mark, the version of the format and of the program, and a checksum.
BUTEE_EXPORT std::vector<std::byte> to_bytes(const Checkpoint& checkpoint);
/// Throws RunError where the bytes are damaged or of another version.
BUTEE_EXPORT Checkpoint to_checkpoint(std::span<const std::byte> bytes);

/// The checkpoints of a result folder: the newest and the one before it. Whatever happens while one is written, a whole
/// one stays.
class BUTEE_EXPORT CheckpointFolder {
 public:
  explicit CheckpointFolder(const ResultFolder& folder) : folder_(folder) {}

  /// Throws RunError where it cannot be written; those before it are left alone then.
  void write(const Checkpoint& checkpoint) const;

  /// The newest that is whole and that belongs to the model and the history in the folder; one that is not is taken
  /// away with a warning. Throws InputError where model.toml is not what the checkpoint was written for, and where it
  /// was written with another instruction set, whose bits differ.
  std::optional<Checkpoint> newest() const;

  /// Takes both away.
  void clear() const;

 private:
  std::optional<Checkpoint> read(const std::string& name) const;

  ResultFolder folder_;
};

}  // namespace butee::record
