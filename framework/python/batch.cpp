#include "butee/python/batch.hpp"

#include <algorithm>
#include <system_error>

#include "butee/core/error.hpp"

namespace butee::python {
namespace {

using namespace std::chrono_literals;

/// The largest number of waiting results of a thread, and the number if they hold more than
/// kMostBytes together.
constexpr std::size_t kMostWaiting = 64, kMostLargeWaiting = 4, kMostBytes = std::size_t{1} << 24U;
/// The interval at which the consumer is woken if runs are short.
constexpr auto kBetweenWakes = 5ms;

std::size_t bytes_of(const Columns& columns) {
  std::size_t bytes = 0;
  for (const auto& column : columns.values) bytes += column.capacity() * sizeof(double);
  return bytes;
}

std::size_t bytes_of(const Batch::Done& done) {
  if (done.outcome == nullptr) return 0;
  return bytes_of(done.outcome->history) + bytes_of(done.outcome->energy) +
         done.outcome->impacts.size() * sizeof(record::Impact);
}

class StopWatch final : public Watch {
 public:
  explicit StopWatch(const std::atomic<bool>& stop) : stop_(stop) {}
  const char* look(double) override { return stop_.load(std::memory_order_relaxed) ? "Python" : nullptr; }

 private:
  const std::atomic<bool>& stop_;
};

}  // namespace

Batch::Batch(const Session& session, std::vector<std::string> keys, std::vector<Values> points, std::size_t threads)
    : document_(session.document()),
      scene_(session.shared()),
      keys_(std::move(keys)),
      points_(std::move(points)),
      thread_count_(std::min(threads, points_.size())),
      handed_at_(std::chrono::steady_clock::now()) {
  try {
    for (std::size_t i = 0; i < thread_count_; ++i) threads_.emplace_back([this] { work(); });
  } catch (const std::system_error& error) {
    const std::size_t started = threads_.size();
    stop();
    throw RunError(std::to_string(thread_count_) + " threads cannot be started, only " + std::to_string(started) +
                   ": " + error.what() + "; use fewer");
  }
}

Batch::~Batch() {
  stop();
}

void Batch::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  left_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool Batch::is_full() const {
  const std::size_t most = waiting_bytes_ > kMostBytes ? kMostLargeWaiting : kMostWaiting;
  return waiting_.size() >= most * thread_count_;
}

bool Batch::is_time() const {
  return is_full() || handed_count_ + waiting_.size() == points_.size() ||
         (!waiting_.empty() && std::chrono::steady_clock::now() - handed_at_ > kBetweenWakes);
}

std::optional<Batch::Done> Batch::next(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  if (handed_.empty()) {
    came_.wait_for(lock, patience, [this] { return is_time(); });
    handed_.swap(waiting_);
    handed_count_ += handed_.size();
    handed_at_ = std::chrono::steady_clock::now();
    waiting_bytes_ = 0;
    left_.notify_all();
  }
  if (handed_.empty()) return std::nullopt;
  Done done = std::move(handed_.front());
  handed_.pop_front();
  ++taken_;
  return done;
}

void Batch::work() {
  plugin::Catalogue catalogue = scene_->catalogue;
  while (true) {
    std::size_t point = 0;
    {
      std::unique_lock lock(mutex_);
      left_.wait(lock, [this] { return stop_ || !is_full(); });
      if (stop_ || next_ == points_.size()) return;
      point = next_++;
    }
    Done done = done_of(point, catalogue);
    const std::lock_guard lock(mutex_);
    waiting_bytes_ += bytes_of(done);
    waiting_.push_back(std::move(done));
    if (is_time()) came_.notify_one();
  }
}

Batch::Done Batch::done_of(std::size_t point, plugin::Catalogue& catalogue) {
  Done done{point, nullptr, nullptr};
  try {
    std::vector<Assignment> assignments;
    for (std::size_t k = 0; k < keys_.size(); ++k) assignments.emplace_back(keys_[k], points_[point][k]);
    config::Document document = document_;
    assign(document, assignments);
    scene::Scene scene = scene::read_scene(std::move(document), catalogue);
    StopWatch watch(stop_);
    done.outcome = perform(scene, {}, watch);
  } catch (...) {
    done.error = std::current_exception();
  }
  return done;
}

}  // namespace butee::python
