#include "butee/core/target.hpp"

#include <atomic>
#include <cstdlib>
#include <hwy/highway.h>
#include <mutex>

#include "butee/core/error.hpp"

namespace butee {
namespace {

struct Target {
  std::string name;
  std::size_t index;
};

const char* name_of(std::int64_t set) {
  switch (set) {
#if HWY_ARCH_X86
    case HWY_AVX3:
      return "avx512";
    case HWY_AVX2:
      return "avx2";
    case HWY_SSSE3:
      return "ssse3";
    case HWY_EMU128:
      return "sse2";
#else
    case HWY_EMU128:
      return "generic";
#endif
#if HWY_ARCH_ARM
    case HWY_NEON:
      return "neon";
#endif
    default:
      return hwy::TargetName(set);
  }
}

std::size_t index_of(std::int64_t set) {
#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0
  static_cast<void>(set);
  return 0;
#else
  hwy::ChosenTarget chosen;
  chosen.Update(set);
  return chosen.GetIndex();
#endif
}

/// The best first; the lowest bit is the best set.
const std::vector<Target>& all_targets() {
  static const std::vector<Target> kAll = [] {
    std::vector<Target> all;
    // These need no asking: nothing of the library would run without the one, and every processor has the other.
    const std::int64_t there = (hwy::SupportedTargets() | HWY_STATIC_TARGET | HWY_BASELINE_SCALAR) & HWY_TARGETS;
    for (std::int64_t rest = there; rest != 0; rest &= rest - 1) {
      const std::int64_t set = rest & ~(rest - 1);
      all.push_back({name_of(set), index_of(set)});
    }
    return all;
  }();
  return kAll;
}

std::string listed(const std::vector<Target>& all) {
  std::string text;
  for (const Target& one : all) text += (text.empty() ? "" : ", ") + one.name;
  return text;
}

const Target& find(const std::vector<Target>& all, const std::string& name) {
  for (const Target& one : all)
    if (one.name == name) return one;
  throw InputError("BUTEE_TARGET=" + name + ": this processor and this butee have the instruction sets " + listed(all) +
                   "; name one of them, or leave the variable unset");
}

std::mutex choosing;
Target chosen;
std::atomic<bool> is_chosen = false;

void take(const Target& target) {
  chosen = target;
  is_chosen.store(true, std::memory_order_release);
}

const Target& chosen_target() {
  if (is_chosen.load(std::memory_order_acquire)) return chosen;
  const std::lock_guard lock(choosing);
  if (!is_chosen) {
    const auto& all = all_targets();
    const char* name = std::getenv("BUTEE_TARGET");
    take(name == nullptr || *name == '\0' ? all.front() : find(all, name));
  }
  return chosen;
}

}  // namespace

const std::string& target() {
  return chosen_target().name;
}

std::string compiled_for() {
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
  return "x86-64-v4";
#elif defined(__AVX2__) && defined(__FMA__)
  return "x86-64-v3";
#elif defined(__SSE4_2__)
  return "x86-64-v2";
#elif defined(__x86_64__)
  return "x86-64";
#else
  return "other";
#endif
}

std::vector<std::string> targets() {
  std::vector<std::string> names;
  for (const Target& one : all_targets()) names.push_back(one.name);
  return names;
}

void choose_target(const std::string& name) {
  const std::lock_guard lock(choosing);
  take(find(all_targets(), name));
}

std::size_t target_index() {
  return chosen_target().index;
}

}  // namespace butee
