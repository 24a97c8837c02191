#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>

#include "butee/study/team.hpp"

namespace butee::study {

/// Distributes the chains 0 ... count - 1 of a study to the threads of all processes of a team; a
/// thread gets the next one when it has finished one.
///
/// A process takes several chains at a time if they are short: as many as take kPatience, but no
/// more than its share of half of the remaining ones.
class BUTEE_EXPORT Dealer {
 public:
  static constexpr std::chrono::milliseconds kPatience{500};

  /// `team` must outlive this object; `threads` is the number of threads of each of its processes.
  Dealer(Team& team, std::int64_t count, int threads);

  /// The next chain; `count` or more if none is left. Thread-safe.
  std::int64_t next();
  /// The number of chains distributed to all processes, as far as known to this one.
  std::int64_t handed_out() const { return handed_out_; }
  void look() { handed_out_ = team_.add(0); }

 private:
  using Clock = std::chrono::steady_clock;

  std::int64_t portion() const;

  Team& team_;
  std::int64_t count_, takers_;
  std::mutex mutex_;
  std::int64_t next_ = 0, end_ = 0;  ///< range of the current portion
  std::int64_t taken_ = 0;           ///< number of chains taken by this process
  Clock::time_point begin_ = Clock::now();
  std::atomic<std::int64_t> handed_out_{0};
};

}  // namespace butee::study
