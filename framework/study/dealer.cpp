#include "butee/study/dealer.hpp"

#include <algorithm>

namespace butee::study {

Dealer::Dealer(Team& team, std::int64_t count, int threads)
    : team_(team), count_(count), takers_(std::int64_t{team.size()} * threads) {}

std::int64_t Dealer::portion() const {
  if (taken_ == 0) return 1;
  const std::chrono::duration<double> past = Clock::now() - begin_, patience = kPatience;
  const double affordable = patience.count() * static_cast<double>(taken_) / std::max(past.count(), 1e-6);
  const auto fair = static_cast<double>((count_ - std::min(count_, handed_out_.load())) / (2 * takers_));
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::min(affordable, fair)));
}

std::int64_t Dealer::next() {
  const std::lock_guard guard(mutex_);
  if (next_ == end_) {
    const std::int64_t size = portion();
    next_ = team_.add(size);
    end_ = next_ + size;
    handed_out_ = end_;
  }
  ++taken_;
  return next_++;
}

}  // namespace butee::study
