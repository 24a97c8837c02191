#pragma once

#include "butee/study/worker.hpp"

namespace butee::study {

/// Keeps the rows of a study, and where its sweeps stand.
class BUTEE_EXPORT Rows {
 public:
  virtual ~Rows() = default;
  virtual bool is_done(std::int64_t run) const = 0;
  virtual std::int64_t done_count() const = 0;
  /// Adds a row. For any thread.
  virtual void append(const Row& row) = 0;
  virtual void flush() = 0;
  /// Where a sweep stands after its run `run`, for going on.
  virtual void keep(std::int64_t chain, std::int64_t run, const Motion& motion) = 0;
  /// The last run of a sweep that is kept, with its motion; -1 where there is none.
  virtual std::int64_t kept(std::int64_t chain, Motion& motion) const = 0;
  virtual void forget(std::int64_t chain) = 0;
};

}  // namespace butee::study
