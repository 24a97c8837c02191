#include "butee/study/perform.hpp"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <sched.h>
#include <system_error>
#include <thread>

#include "butee/core/error.hpp"
#include "butee/core/log.hpp"

namespace butee::study {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenReports = 100ms, kBetweenServices = 10ms;
/// The interval at which a running sweep is saved to disk.
constexpr auto kBetweenKeeps = 1s;

/// Data shared by the threads of a study.
class Pool {
 public:
  Pool(const Study& study, const Layout& layout, Rows& rows, const PerformOptions& options)
      : study_(study), layout_(layout), rows_(rows), options_(options), status_(layout.find(kStatusColumn)) {
    progress_.done = rows.done_count();
    progress_.total = study.plan.run_count();
    if (options.shard.count > 1) count_shard();
    at_first_ = progress_.done;
  }

  bool perform() {
    const int count = options_.threads > 0 ? options_.threads : processor_count();
    const log::WithoutWarnings quiet;
    std::vector<std::jthread> threads;
    running_ = count;
    try {
      for (int i = 0; i < count; ++i) threads.emplace_back([this] { work(); });
    } catch (const std::system_error& error) {
      const std::size_t started = threads.size();
      goes_on_ = false;
      threads.clear();
      rows_.flush();
      throw RunError(std::to_string(count) + " threads cannot be started, only " + std::to_string(started) + ": " +
                     error.what() + "; use fewer");
    }
    try {
      wait();
    } catch (...) {
      goes_on_ = false;  // or the threads would go on with the whole study
      throw;
    }
    threads.clear();
    rows_.flush();
    if (error_) std::rethrow_exception(error_);
    return goes_on_;
  }

 private:
  void count_shard() {
    progress_.total = progress_.done = 0;
    for (std::int64_t c = options_.shard.index; c < study_.plan.chain_count(); c += options_.shard.count) {
      const Plan::Chain chain = study_.plan.chain(c);
      for (std::int64_t i = 0; i < chain.length; ++i) progress_.done += rows_.is_done(chain.at(i)) ? 1 : 0;
      progress_.total += chain.length;
    }
  }

  void wait() {
    std::unique_lock lock(mutex_);
    auto reported = std::chrono::steady_clock::now();
    while (running_ > 0) {
      if (options_.serve) {
        changed_.wait_for(lock, kBetweenServices);
        lock.unlock();
        options_.serve();
        lock.lock();
        if (running_ > 0 && std::chrono::steady_clock::now() - reported < kBetweenReports) continue;
        reported = std::chrono::steady_clock::now();
      } else {
        changed_.wait_for(lock, kBetweenReports);
      }
      const Progress now = progress_of_all();
      lock.unlock();
      rows_.flush();
      if (options_.report) options_.report(now);
      if (options_.goes_on && !options_.goes_on()) goes_on_ = false;
      lock.lock();
    }
  }

  /// If several processes share the chains, distributed chains count as done.
  Progress progress_of_all() {
    Progress all = progress_;
    if (options_.dealer == nullptr) return all;
    options_.dealer->look();
    const std::int64_t handed = std::min(options_.dealer->handed_out(), study_.plan.chain_count());
    const std::int64_t passed = handed * (all.total / study_.plan.chain_count());
    all.done = std::max(all.done, passed);
    all.fresh = all.done - at_first_;
    return all;
  }

  std::int64_t next_chain() {
    if (options_.dealer != nullptr) return options_.dealer->next();
    return options_.shard.index + next_.fetch_add(1) * options_.shard.count;
  }

  void work() {
    try {
      Worker worker(study_, layout_);
      while (goes_on_) {
        const std::int64_t chain = next_chain();
        if (chain >= study_.plan.chain_count()) break;
        perform_chain(worker, chain);
      }
    } catch (...) {
      const std::lock_guard guard(mutex_);
      if (!error_) error_ = std::current_exception();
      goes_on_ = false;
    }
    const std::lock_guard guard(mutex_);
    --running_;
    changed_.notify_all();
  }

  void perform_chain(Worker& worker, std::int64_t index) {
    const Plan::Chain chain = study_.plan.chain(index);
    const bool is_sweep = study_.plan.follow() != Follow::no;
    std::int64_t left = 0;
    for (std::int64_t i = 0; i < chain.length; ++i) left += rows_.is_done(chain.at(i)) ? 0 : 1;
    if (left == 0) return;
    Motion motion;
    std::int64_t i = 0;
    if (is_sweep)
      if (const std::int64_t kept = rows_.kept(index, motion); kept >= 0) i = (kept - chain.first) * chain.step + 1;
    // After a power failure the motion may be on disk and the rows before it not.
    for (std::int64_t before = 0; before < i; ++before)
      if (!rows_.is_done(chain.at(before))) {
        i = 0;
        motion = {};
      }
    auto kept_at = std::chrono::steady_clock::now();
    for (; i < chain.length && goes_on_; ++i) {
      const std::int64_t run = chain.at(i);
      // A run of a sweep whose row exists is repeated only for its motion.
      const auto row = worker.perform(run, motion, [this] { return goes_on_.load(std::memory_order_relaxed); });
      if (!row) return;
      if (!rows_.is_done(run)) add(*row);
      if (!is_sweep || motion.is_empty() || std::chrono::steady_clock::now() - kept_at < kBetweenKeeps) continue;
      rows_.keep(index, run, motion);
      kept_at = std::chrono::steady_clock::now();
    }
    if (is_sweep && i == chain.length) rows_.forget(index);
  }

  void add(const Row& row) {
    rows_.append(row);
    const std::lock_guard guard(mutex_);
    ++progress_.done;
    ++progress_.fresh;
    if (row.text(status_) != "completed") ++progress_.failed;
  }

  const Study& study_;
  const Layout& layout_;
  Rows& rows_;
  const PerformOptions& options_;
  std::size_t status_;
  std::atomic<std::int64_t> next_{0};
  std::atomic<bool> goes_on_{true};
  std::mutex mutex_;
  std::condition_variable changed_;
  int running_ = 0;
  Progress progress_;
  std::int64_t at_first_ = 0;  ///< number of runs done before
  std::exception_ptr error_;
};

}  // namespace

int processor_count() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

bool perform(const Study& study, const Layout& layout, Rows& rows, const PerformOptions& options) {
  return Pool(study, layout, rows, options).perform();
}

}  // namespace butee::study
