#pragma once

#include <cstdint>
#include <functional>

#include "butee/study/dealer.hpp"
#include "butee/study/rows.hpp"
#include "butee/study/shard.hpp"

namespace butee::study {

/// The progress of a study.
struct Progress {
  std::int64_t done = 0, total = 0;  ///< runs, including those of earlier sessions
  std::int64_t fresh = 0;            ///< runs done since it was started or continued
  std::int64_t failed = 0;           ///< failed ones among `fresh`
};

struct PerformOptions {
  int threads = 0;  ///< 0: the number of processors available to the process
  Shard shard{};
  Dealer* dealer = nullptr;         ///< distributes the chains if several processes share them; null: all chains of the
                                    ///< shard
  std::function<bool()> goes_on{};  ///< called some times a second, by the calling thread
  std::function<void(const Progress&)> report{};  ///< likewise
  std::function<void()> serve{};                  ///< likewise, a hundred times a second
};

/// The number of processors available to this process.
BUTEE_EXPORT int processor_count();

/// Does the remaining runs of a study and adds their rows; a Store must have begun. False if it was
/// told to stop. Rows depend neither on the number of threads nor on their order. Throws any error
/// of writing.
BUTEE_EXPORT bool perform(const Study& study, const Layout& layout, Rows& rows, const PerformOptions& options);

}  // namespace butee::study
