#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "butee/model/dofs.hpp"

namespace butee::model {

/// The motion of all free DOFs at one instant.
struct SavedMotion {
  double t = 0.0;  ///< s
  Vector x, v;     ///< m or rad, m/s or rad/s
};

/// Motions that a run keeps for others to start from, and what tells its structure from another: the file `states.bin`
/// of a result folder.
struct BUTEE_EXPORT SavedMotions {
  static constexpr const char* kFile = "states.bin";

  SavedMotions() = default;
  /// Of a structure, without motions yet.
  SavedMotions(const NodeTable& nodes, const DofTable& table);

  /// In which way the structure differs from another one, or "".
  std::string difference_from(const NodeTable& nodes, const DofTable& table) const;

  struct Group {
    std::string name;
    std::vector<double> coordinates;  ///< m; empty for a lone node
    bool operator==(const Group&) const = default;
  };

  std::vector<Group> groups;
  std::vector<NodalDof> free;
  std::vector<SavedMotion> motions;  ///< ascending in time; the last is where the run ended
};

/// As bytes with a mark, a version of the format and a checksum.
BUTEE_EXPORT std::vector<std::byte> to_bytes(const SavedMotions& saved);
/// Throws RunError where the bytes are damaged or of another format.
BUTEE_EXPORT SavedMotions to_saved_motions(std::span<const std::byte> bytes);

}  // namespace butee::model
