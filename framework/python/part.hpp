#pragma once

#include <memory>
#include <mutex>

#include "butee/embed/structure.hpp"
#include "butee/python/session.hpp"

namespace butee::python {

/// A structure for one thread at a time, with the data needed to make it again elsewhere.
class Part {
 public:
  Part(const Session& session, std::vector<std::string> forced);

  /// The structure, during the lifetime of the lock. Throws RunError if another thread uses it.
  struct Locked {
    embed::Structure& structure;
    std::unique_lock<std::mutex> lock;
    embed::Structure* operator->() const { return &structure; }
  };
  Locked use();

  const Session& session() const { return session_; }
  const std::vector<std::string>& forced() const { return forced_; }
  /// The free DOFs of `forced`, in its order.
  const std::vector<Index>& forced_dofs() const { return forced_dofs_; }

 private:
  Session session_;
  std::vector<std::string> forced_;
  embed::Structure structure_;
  std::vector<Index> forced_dofs_;
  std::mutex mutex_;
};

/// Converts a snapshot to bytes, and back; throws RunError if the bytes are damaged.
std::vector<std::byte> to_bytes(const embed::Structure::Snapshot& snapshot);
embed::Structure::Snapshot to_snapshot(std::span<const std::byte> bytes);

}  // namespace butee::python
