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
  std::size_t index;  ///< index in the tables of linalg/kernel/dispatch.hpp
};

/// Best first.
const std::vector<Target>& all_targets() {
  static const std::vector<Target> kAll = [] {
    std::vector<Target> all;
#if HWY_TARGETS & HWY_AVX3
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd"))
      all.push_back({"avx512", 0});
#endif
#if HWY_TARGETS & HWY_AVX2
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
        __builtin_cpu_supports("bmi2"))
      all.push_back({"avx2", 1});
#endif
#if HWY_TARGETS & HWY_SSSE3
    if (__builtin_cpu_supports("ssse3")) all.push_back({"ssse3", 2});
#endif
#if HWY_TARGETS & HWY_NEON
    all.push_back({"neon", 3});
#endif
#if HWY_TARGETS & HWY_EMU128
    all.push_back({HWY_ARCH_X86 ? "sse2" : "generic", 4});
#endif
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
