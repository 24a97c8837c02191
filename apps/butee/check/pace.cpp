#include "pace.hpp"

#include <algorithm>
#include <limits>

namespace butee::app::check {
namespace {

constexpr std::size_t kMostPoints = 4096;
constexpr int kPieces = 8;

}  // namespace

void Pace::add(double t, double value) {
  last_ = {t, value};
  if (++since_last_ < stride_) return;
  since_last_ = 0;
  marks_.push_back(last_);
  if (marks_.size() < kMostPoints) return;
  for (std::size_t i = 0; 2 * i + 1 < marks_.size(); ++i) marks_[i] = marks_[2 * i + 1];
  marks_.resize(marks_.size() / 2);
  stride_ *= 2;
}

double Pace::at(double t) const {
  const auto next = std::lower_bound(marks_.begin(), marks_.end(), t,
                                     [](const Mark& before, double instant) { return before.t < instant; });
  const Mark to = next == marks_.end() ? last_ : *next;
  const Mark from = next == marks_.begin() ? Mark{begin_, 0.0} : *(next - 1);
  return to.t > from.t ? from.value + (to.value - from.value) * (t - from.t) / (to.t - from.t) : to.value;
}

std::optional<double> Pace::foretell(double end) const {
  const double span = last_.t - begin_;
  if (marks_.empty() || !(span > 0.0)) return std::nullopt;
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0.0;
  for (int i = 0; i < kPieces; ++i) {
    const double from = begin_ + span * i / kPieces, to = begin_ + span * (i + 1) / kPieces;
    const double pace = (at(to) - at(from)) * kPieces / span;
    slowest = std::min(slowest, pace);
    fastest = std::max(fastest, pace);
  }
  const double rest = end - last_.t, foretold = last_.value / span * (end - begin_);
  if (last_.value + rest * fastest > kUneven * foretold) return std::nullopt;
  if (foretold > kUneven * (last_.value + rest * slowest)) return std::nullopt;
  return foretold;
}

}  // namespace butee::app::check
