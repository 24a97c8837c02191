#pragma once

#include <cstdint>
#include <functional>

#include "butee/study/dealer.hpp"
#include "butee/study/rows.hpp"
#include "butee/study/shard.hpp"

namespace butee::study {

/// How far a study is.
struct Progress {
  std::int64_t done = 0, total = 0;  ///< runs, those of earlier sessions included
  std::int64_t fresh = 0;            ///< done since it was begun or gone on with
  std::int64_t failed = 0;           ///< of these
};

struct PerformOptions {
  int threads = 0;  ///< 0: as many as the process may use processors
  Shard shard{};
  Dealer* dealer = nullptr;         ///< hands out the chains where several processes share them; null: all of the shard
  std::function<bool()> goes_on{};  ///< asked some times a second, by the calling thread
  std::function<void(const Progress&)> report{};  ///< likewise
  std::function<void()> serve{};                  ///< likewise, a hundred times a second
};

/// The processors that this process may use.
BUTEE_EXPORT int processor_count();

/// Does the runs of a study that are not done yet and adds their rows; a Store has begun. False where it was
/// told not to go on. Rows depend neither on the number of threads nor on their order. Throws what writing throws.
BUTEE_EXPORT bool perform(const Study& study, const Layout& layout, Rows& rows, const PerformOptions& options);

}  // namespace butee::study
