#include "butee/python/batch.hpp"

#include <algorithm>

namespace butee::python {
namespace {

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
      most_waiting_(4 * threads) {
  threads = std::min(threads, points_.size());
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Batch::~Batch() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  left_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

std::optional<Batch::Done> Batch::next(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  if (!came_.wait_for(lock, patience, [this] { return !waiting_.empty(); })) return std::nullopt;
  Done done = std::move(waiting_.front());
  waiting_.pop_front();
  ++taken_;
  left_.notify_one();
  return done;
}

void Batch::work() {
  plugin::Catalogue catalogue = scene_->catalogue;
  while (true) {
    std::size_t point = 0;
    {
      std::unique_lock lock(mutex_);
      left_.wait(lock, [this] { return stop_ || waiting_.size() < most_waiting_; });
      if (stop_ || next_ == points_.size()) return;
      point = next_++;
    }
    Done done = done_of(point, catalogue);
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(done));
    came_.notify_one();
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
