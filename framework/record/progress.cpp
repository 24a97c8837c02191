#include "butee/record/progress.hpp"

#include <cstdio>
#include <string>
#include <unistd.h>

namespace butee::record {
namespace {

using namespace std::chrono_literals;

/// Reading the clock at every step would cost as much as a small step.
constexpr std::int64_t kStepsBetweenLooks = 256;
constexpr auto kSilence = 1s;
constexpr auto kBetweenDrawings = 100ms;
constexpr int kWidth = 30;

}  // namespace

bool has_terminal() {
  return isatty(STDERR_FILENO) == 1;
}

void ProgressBar::start(const time::State& state) {
  begin_t_ = state.t;
  begin_ = drawn_ = Clock::now();
  steps_ = 0;
  look_again_ = kStepsBetweenLooks;
}

void ProgressBar::restore(ByteReader&) {
  start({});
  begin_t_ = -1.0;
}

void ProgressBar::step(const time::AcceptedStep& step) {
  if (begin_t_ < 0.0) begin_t_ = step.from.t;
  if (++steps_ < look_again_) return;
  look_again_ = steps_ + kStepsBetweenLooks;
  const auto now = Clock::now();
  if (now - begin_ < kSilence || now - drawn_ < kBetweenDrawings) return;
  drawn_ = now;
  draw(step.to.t, step.h);
}

void ProgressBar::draw(double t, double h) {
  shown_ = true;
  const double done = t / end_time_;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
  const int filled = static_cast<int>(done * kWidth);
  const std::string bar =
      std::string(static_cast<std::size_t>(filled), '#') + std::string(static_cast<std::size_t>(kWidth - filled), '.');
  std::fprintf(stderr, "\r[%s] %3.0f %%  t = %.4g of %.4g s  h = %.2e s  %.3g steps/s  %.0f s left \033[K", bar.c_str(),
               100.0 * done, t, end_time_, h, static_cast<double>(steps_) / seconds,
               t > begin_t_ ? seconds * (end_time_ - t) / (t - begin_t_) : 0.0);
  std::fflush(stderr);
}

void ProgressBar::finish() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

}  // namespace butee::record
