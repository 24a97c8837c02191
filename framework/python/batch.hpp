#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "butee/python/outcome.hpp"
#include "butee/python/session.hpp"

namespace butee::python {

/// Runs of one scene with varied values, point by point, on threads that do not use Python.
///
/// Results of short runs are delivered in groups, since waking the consumer interrupts a computing
/// thread. The number of waiting results is bounded, so that memory does not grow with the number
/// of points.
class Batch {
 public:
  /// One point's outcome, or the error.
  struct Done {
    std::size_t point = 0;
    std::shared_ptr<Outcome> outcome;
    std::exception_ptr error;
  };

  /// Values of a point, one for each key; nothing: the key is removed.
  using Values = std::vector<std::optional<config::Value>>;

  Batch(const Session& session, std::vector<std::string> keys, std::vector<Values> points, std::size_t threads);
  ~Batch();
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;

  std::size_t size() const { return points_.size(); }
  std::size_t taken() const { return taken_; }  ///< number of results delivered by next()
  /// Waits for the next result, in any order; nothing if it took longer than `patience`.
  std::optional<Done> next(std::chrono::milliseconds patience);

 private:
  void stop();  ///< ends and joins the threads
  void work();
  Done done_of(std::size_t point, plugin::Catalogue& catalogue);
  bool is_full() const;
  bool is_time() const;

  config::Document document_;
  std::shared_ptr<scene::Scene> scene_;  ///< its catalogue is copied by each thread
  std::vector<std::string> keys_;
  std::vector<Values> points_;
  std::size_t thread_count_;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;
  std::condition_variable came_, left_;
  std::deque<Done> waiting_, handed_;  ///< not yet announced to the consumer; next to be delivered
  std::size_t waiting_bytes_ = 0, handed_count_ = 0, next_ = 0;
  std::chrono::steady_clock::time_point handed_at_;
  std::atomic<std::size_t> taken_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace butee::python
