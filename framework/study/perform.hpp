#pragma once

#include <cstdint>
#include <functional>

#include "butee/study/store.hpp"

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
  std::function<bool()> goes_on{};                ///< asked some times a second, by the calling thread
  std::function<void(const Progress&)> report{};  ///< likewise
};

/// The processors that this process may use.
BUTEE_EXPORT int processor_count();

/// Does the runs of a study that are not done yet and adds their rows to the store, which has begun. False where it was
/// told not to go on. Rows depend neither on the number of threads nor on their order. Throws what writing throws.
BUTEE_EXPORT bool perform(const Study& study, const Layout& layout, Store& store, const PerformOptions& options);

}  // namespace butee::study
