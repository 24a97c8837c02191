#pragma once

#include "butee/study/worker.hpp"

namespace butee::study {

/// Stores the rows of a study, and the state of its sweeps.
class BUTEE_EXPORT Rows {
 public:
  virtual ~Rows() = default;
  virtual bool is_done(std::int64_t run) const = 0;
  virtual std::int64_t done_count() const = 0;
  /// Adds a row. Thread-safe.
  virtual void append(const Row& row) = 0;
  virtual void flush() = 0;
  /// Saves the motion of a sweep after its run `run`, for continuation.
  virtual void keep(std::int64_t chain, std::int64_t run, const Motion& motion) = 0;
  /// The last saved run of a sweep, with its motion; -1 if there is none.
  virtual std::int64_t kept(std::int64_t chain, Motion& motion) const = 0;
  virtual void forget(std::int64_t chain) = 0;
};

}  // namespace butee::study
