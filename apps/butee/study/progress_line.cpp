#include "progress_line.hpp"

#include <cstdio>
#include <string>

#include <butee/core/format.hpp>
#include <butee/core/terminal.hpp>

namespace butee::app::studies {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenLines = 10s;

}  // namespace

std::string time_span(double time) {
  if (time < 9.5) return formatted("%.2g s", time);
  if (time < 99.5) return formatted("%.0f s", time);
  return time < 5940.0 ? formatted("%.0f min", time / 60.0) : formatted("%.1f h", time / 3600.0);
}

ProgressLine::ProgressLine(bool is_wanted)
    : is_wanted_(is_wanted), is_terminal_(is_terminal(stderr)), begin_(Clock::now()), drawn_(begin_) {}

ProgressLine::~ProgressLine() {
  if (is_on_screen_) std::fputs("\r\033[K", stderr);
}

void ProgressLine::report(const study::Progress& progress) {
  if (!is_wanted_ || progress.total == 0) return;
  const auto now = Clock::now();
  if (!is_terminal_ && now - drawn_ < kBetweenLines) return;
  drawn_ = now;
  const double past = std::chrono::duration<double>(now - begin_).count();
  std::string text = formatted("%3.0f %%  %lld of %lld runs",
                               100.0 * static_cast<double>(progress.done) / static_cast<double>(progress.total),
                               static_cast<long long>(progress.done), static_cast<long long>(progress.total));
  if (progress.failed > 0) text += formatted(", %lld without results", static_cast<long long>(progress.failed));
  if (progress.fresh > 0) {
    const double pace = static_cast<double>(progress.fresh) / past;
    text += formatted("  %.3g runs/s  ", pace) + time_span(static_cast<double>(progress.total - progress.done) / pace) +
            " left";
  }
  std::fprintf(stderr, is_terminal_ ? "\r%s\033[K" : "%s\n", text.c_str());
  std::fflush(stderr);
  is_on_screen_ = is_terminal_;
}

}  // namespace butee::app::studies
