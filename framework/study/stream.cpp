#include "butee/study/stream.hpp"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <thread>

#include "butee/core/log.hpp"
#include "butee/study/points.hpp"
#include "butee/study/worker.hpp"

namespace butee::study {
namespace {

constexpr std::size_t kTextLength = 120;
/// Number of lines read ahead, for each thread.
constexpr std::size_t kReadAhead = 4;

class Answering {
 public:
  Answering(const Study& study, const Layout& layout, int threads, const Stream& stream)
      : study_(study), layout_(layout), threads_(threads), stream_(stream) {}

  std::int64_t perform() {
    const log::WithoutWarnings quiet;
    stream_.respond(csv_header(layout_));
    std::vector<std::jthread> threads;
    try {
      for (int i = 0; i < threads_; ++i) threads.emplace_back([this] { work(); });
      read();
    } catch (...) {
      end();  // The threads wait for points, and are joined.
      throw;
    }
    threads.clear();
    if (error_) std::rethrow_exception(error_);
    return failed_;
  }

 private:
  struct Point {
    std::int64_t number;
    std::string line;
  };

  void read() {
    std::int64_t number = 0;
    const auto is_wanted = [this] { return goes_on(); };
    for (std::string line; goes_on() && stream_.next(line, is_wanted);) {
      if (line.empty() || line.front() == '#') continue;
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] {
        return waiting_.size() < kReadAhead * static_cast<std::size_t>(threads_) || error_ || has_stopped_;
      });
      waiting_.push_back({number++, line});
      changed_.notify_all();
    }
    end();
  }
  void end() {
    const std::lock_guard guard(mutex_);
    is_over_ = true;
    changed_.notify_all();
  }

  bool goes_on() const { return !is_broken_ && (!stream_.goes_on || stream_.goes_on()); }

  void work() {
    try {
      Worker worker(study_, layout_);
      for (;;) {
        Point point;
        {
          std::unique_lock lock(mutex_);
          changed_.wait(lock, [&] { return !waiting_.empty() || is_over_; });
          if (waiting_.empty()) return;
          if (!goes_on()) break;
          point = std::move(waiting_.front());
          waiting_.pop_front();
          changed_.notify_all();
        }
        const auto row = row_of(worker, point);
        if (!row) break;
        respond(point.number, *row);
      }
      // Interrupted: the reader may wait for room.
      const std::lock_guard guard(mutex_);
      has_stopped_ = true;
      changed_.notify_all();
    } catch (...) {
      const std::lock_guard guard(mutex_);
      if (!error_) error_ = std::current_exception();
      is_broken_ = true;
      changed_.notify_all();
    }
  }

  std::optional<Row> row_of(Worker& worker, const Point& point) {
    std::vector<config::Value> values;
    for (const std::string& cell : cells_of(point.line)) values.push_back(value_of(cell));
    if (values.size() == study_.plan.axes().size()) {
      Motion start;
      return worker.perform(point.number, values, start, [this] { return goes_on(); });
    }
    Row row(layout_);
    row.set_integer(layout_.find(kRunColumn), point.number);
    row.set_integer(layout_.find(kPointColumn), point.number);
    row.set_text(layout_.find(kStatusColumn), "refused");
    row.set_text(layout_.find(kReasonColumn), "the line needs a cell for each of the " +
                                                  std::to_string(study_.plan.axes().size()) +
                                                  " keys that vary; it has " + std::to_string(values.size()));
    return row;
  }

  void respond(std::int64_t number, const Row& row) {
    const std::lock_guard guard(output_);
    if (row.text(layout_.find(kStatusColumn)) != "completed") ++failed_;
    ready_.emplace(number, csv_line(layout_, row));
    for (auto first = ready_.begin(); first != ready_.end() && first->first == next_; first = ready_.erase(first)) {
      stream_.respond(first->second);
      ++next_;
    }
  }

  const Study& study_;
  const Layout& layout_;
  int threads_;
  const Stream& stream_;
  std::mutex mutex_, output_;
  std::condition_variable changed_;
  std::deque<Point> waiting_;
  bool is_over_ = false, has_stopped_ = false;
  std::atomic<bool> is_broken_{false};
  std::exception_ptr error_;
  std::map<std::int64_t, std::string> ready_;
  std::int64_t next_ = 0, failed_ = 0;
};

}  // namespace

Layout streamed_layout(const Study& study) {
  const Layout plain = layout_of(study);
  std::vector<Column> columns = plain.columns();
  const std::size_t end = plain.find(kStatusColumn);
  for (std::size_t i = end - study.plan.axes().size(); i < end; ++i) {
    columns[i].type = Column::Type::text;
    columns[i].length = kTextLength;
  }
  return Layout(std::move(columns));
}

std::int64_t answer(const Study& study, const Layout& layout, int threads, const Stream& stream) {
  return Answering(study, layout, threads, stream).perform();
}

}  // namespace butee::study
