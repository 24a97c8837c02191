#pragma once

#include <cstdint>

namespace butee::study {

/// One of several processes that share a study; it owns the chains whose number is `index` modulo
/// `count`.
struct Shard {
  std::int64_t index = 0, count = 1;
};

}  // namespace butee::study
