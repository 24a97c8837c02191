#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>

#include "butee/study/team.hpp"

namespace butee::study {

/// Hands the chains 0 ... count - 1 of a study out to the threads of all processes of a team, each as soon as the one
/// before is done.
///
/// A process takes several at a time where they are short: as many as take kPatience, but no more than its share of
/// half of what is left.
class BUTEE_EXPORT Dealer {
 public:
  static constexpr std::chrono::milliseconds kPatience{500};

  /// `team` must outlive it; `threads` of each of its processes.
  Dealer(Team& team, std::int64_t count, int threads);

  /// The next chain; `count` or more where none is left. For any thread.
  std::int64_t next();
  /// How many have been handed out to all processes, as far as this one knows.
  std::int64_t handed_out() const { return handed_out_; }
  void look() { handed_out_ = team_.add(0); }

 private:
  using Clock = std::chrono::steady_clock;

  std::int64_t portion() const;

  Team& team_;
  std::int64_t count_, takers_;
  std::mutex mutex_;
  std::int64_t next_ = 0, end_ = 0;  ///< of the portion
  std::int64_t taken_ = 0;           ///< chains, by this process
  Clock::time_point begin_ = Clock::now();
  std::atomic<std::int64_t> handed_out_{0};
};

}  // namespace butee::study
