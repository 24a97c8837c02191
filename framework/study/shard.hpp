#pragma once

#include <cstdint>

namespace butee::study {

/// One of several processes that share a study: those chains are its own whose number is `index` modulo `count`.
struct Shard {
  std::int64_t index = 0, count = 1;
  bool owns(std::int64_t chain) const { return chain % count == index; }
};

}  // namespace butee::study
