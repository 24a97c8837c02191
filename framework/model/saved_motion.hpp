#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "butee/model/dofs.hpp"

namespace butee::model {

/// The motion of all free DOFs at one instant, relative to a common base.
struct SavedMotion {
  double t = 0.0;  ///< s
  Vector x, v;     ///< m or rad, m/s or rad/s
  Vector contact;  ///< state of the contacts (time::contact_memory), or empty
};

/// Motions that a run saves as starting points for other runs, with data that identify the
/// structure: the file `states.bin` of a result folder.
struct BUTEE_EXPORT SavedMotions {
  static constexpr const char* kFile = "states.bin";

  SavedMotions() = default;
  /// Takes the structure, without motions yet.
  SavedMotions(const NodeTable& nodes, const DofTable& table);

  /// The first difference from another structure, or "".
  std::string difference_from(const NodeTable& nodes, const DofTable& table) const;

  struct Group {
    std::string name;
    std::vector<double> coordinates;  ///< m; empty for a lone node
    bool operator==(const Group&) const = default;
  };

  std::vector<Group> groups;
  std::vector<NodalDof> free;
  bool in_space = false;              ///< the supports moved one by one, so that the motion is that in space
  bool has_base = false;              ///< a base moved
  std::vector<std::string> contacts;  ///< contact_names() of that run
  std::vector<SavedMotion> motions;   ///< ascending in time; the last is the end of the run
};

/// Converts to bytes with a mark, a format version and a checksum.
BUTEE_EXPORT std::vector<std::byte> to_bytes(const SavedMotions& saved);
/// Throws RunError if the bytes are damaged or of another format.
BUTEE_EXPORT SavedMotions to_saved_motions(std::span<const std::byte> bytes);

}  // namespace butee::model
