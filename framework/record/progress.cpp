#include "butee/record/progress.hpp"

#include <algorithm>
#include <cmath>

#include "butee/core/format.hpp"
#include "butee/core/terminal.hpp"

namespace butee::record {
namespace {

using namespace std::chrono_literals;

constexpr auto kSilence = 700ms;
constexpr auto kBetweenDrawings = 100ms;
constexpr auto kBetweenLines = 10s;
/// Approximate interval between clock reads, s; reading at every step would cost as much as a small
/// step.
constexpr double kBetweenLooks = 0.02;
constexpr std::int64_t kMostStride = 1 << 20;
/// The time over which the pace is averaged, s.
constexpr double kMemory = 5.0;
constexpr int kWidestBar = 30, kNarrowestBar = 5;

double seconds(Progress::Clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

/// "47 s", "12 min", "3.4 h"
std::string span_of(double time) {
  if (time < 99.5) return formatted("%.0f s", time);
  return time < 5940.0 ? formatted("%.0f min", time / 60.0) : formatted("%.1f h", time / 3600.0);
}

}  // namespace

Progress::Style Progress::standard_style() {
  const bool bar = is_terminal(stderr);
  return {bar, stderr, bar ? kSilence : Clock::duration{kBetweenLines}, bar ? kBetweenDrawings : kBetweenLines,
          terminal_width(stderr)};
}

Progress::Progress(dynamics::Dynamics& dynamics, double end_time, Style style)
    : dynamics_(dynamics),
      end_time_(end_time),
      style_(style),
      displacement_(dynamics.stop_count()),
      penetration_(dynamics.stop_count()) {}

Progress::~Progress() {
  clear();
}

void Progress::start(const time::State& state) {
  begin_ = looked_ = drawn_ = Clock::now();
  t_ = looked_t_ = state.t;
  x_ = state.x;
}

/// The first step gives the time at which the run continues.
void Progress::restore(ByteReader&) {
  begin_ = looked_ = drawn_ = Clock::now();
  looked_t_ = -1.0;
}

void Progress::step(const time::AcceptedStep& step) {
  if (looked_t_ < 0.0) t_ = looked_t_ = step.from.t;
  steps_ += (step.to.t - step.from.t) / step.h;
  const bool last = step.to.t >= end_time_;
  if (--until_look_ > 0 && !last) return;
  t_ = step.to.t;
  h_ = step.h;
  x_ = step.to.x;
  look();
}

void Progress::look() {
  const auto now = Clock::now();
  const double past = seconds(now - looked_);
  if (past < 0.5 * kBetweenLooks) stride_ = std::min(2 * stride_, kMostStride);
  if (past > kBetweenLooks) stride_ = std::max<std::int64_t>(stride_ / 2, 1);
  until_look_ = stride_;
  if (past > 0.0) {
    const double weight = std::max(1.0 - std::exp(-past / kMemory), past / (seconds(now - begin_) + past));
    pace_ += weight * ((t_ - looked_t_) / past - pace_);
  }
  looked_ = now;
  looked_t_ = t_;
  if (now - begin_ >= style_.silence && now - drawn_ >= style_.interval && t_ < end_time_) draw(now);
}

Index Progress::closed_stops() {
  dynamics_.stops().displacement(x_, displacement_);
  dynamics_.stops().penetration(displacement_, penetration_);
  return (penetration_.array() > 0.0).count();
}

std::string Progress::words(double past) {
  std::string text = formatted("%3.0f %%  t = %.4g of %.4g s", 100.0 * t_ / end_time_, t_, end_time_);
  const auto fits = [&](const std::string& more) {
    return !style_.bar || static_cast<int>(text.size() + more.size()) + kNarrowestBar + 4 < style_.width;
  };
  const auto add = [&](const std::string& more) {
    if (fits(more)) text += more;
  };
  if (pace_ > 0.0 && t_ < end_time_) add("  " + span_of((end_time_ - t_) / pace_) + " left");
  if (h_ > 0.0) add(formatted("  h = %.1e s", h_));
  if (dynamics_.stop_count() > 0)
    add(formatted("  %lld of %lld stops closed", static_cast<long long>(closed_stops()),
                  static_cast<long long>(dynamics_.stop_count())));
  if (past > 0.0) add(formatted("  %.3g steps/s", steps_ / past));
  return text;
}

void Progress::draw(Clock::time_point now) {
  drawn_ = now;
  const std::string text = words(seconds(now - begin_));
  if (!style_.bar) {
    std::fprintf(style_.stream, "%s\n", text.c_str());
  } else {
    const int room = std::clamp(style_.width - static_cast<int>(text.size()) - 4, 0, kWidestBar);
    const int filled = std::clamp(static_cast<int>(t_ / end_time_ * room), 0, room);
    std::fprintf(style_.stream, "\r[%s%s] %s\033[K", std::string(static_cast<std::size_t>(filled), '#').c_str(),
                 std::string(static_cast<std::size_t>(room - filled), '.').c_str(), text.c_str());
    on_screen_ = true;
  }
  std::fflush(style_.stream);
}

void Progress::clear() {
  if (!on_screen_) return;
  on_screen_ = false;
  std::fputs("\r\033[K", style_.stream);
  std::fflush(style_.stream);
}

void Progress::finish() {
  clear();
  if (!style_.bar && x_.size() > 0) draw(Clock::now());
}

}  // namespace butee::record
