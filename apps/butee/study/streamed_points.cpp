#include "streamed_points.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <poll.h>
#include <unistd.h>

#include <butee/core/error.hpp>
#include <butee/core/log.hpp>
#include <butee/study/perform.hpp>
#include <butee/study/stream.hpp>

#include "../interruption.hpp"
#include "horizon.hpp"

namespace butee::app::studies {
namespace {

/// Lines of a file descriptor. Waits for the next one for as long as it is wanted.
class Lines {
 public:
  explicit Lines(int file) : file_(file) {}
  bool next(std::string& line, const std::function<bool()>& is_wanted) {
    constexpr int kMilliseconds = 100;
    std::size_t end = 0;
    while ((end = text_.find('\n')) == std::string::npos) {
      pollfd waiting{file_, POLLIN, 0};
      while (poll(&waiting, 1, kMilliseconds) <= 0)
        if (!is_wanted()) return false;
      char part[4096];
      const ssize_t got = read(file_, part, sizeof(part));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw InputError("--points: cannot be read: " + std::string(std::strerror(errno)));
      if (got == 0) break;
      text_.append(part, static_cast<std::size_t>(got));
    }
    if (end == std::string::npos && text_.empty()) return false;
    line = text_.substr(0, end);
    text_.erase(0, end == std::string::npos ? end : end + 1);
    return true;
  }

 private:
  int file_;
  std::string text_;
};

}  // namespace

int answer_points(const StreamedPoints& request) {
  std::ofstream to;
  int file = STDIN_FILENO;
  if (request.points != "-") {
    file = open(request.points.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) throw InputError("--points " + request.points + ": cannot be read");
    std::error_code none;
    if (std::filesystem::equivalent(request.points, request.results, none))
      throw InputError("--results " + request.results + ": is the file of the points; name another one");
  }
  Lines lines(file);
  std::string header, first;
  const auto next = [&](std::string& line, const std::function<bool()>& is_wanted) {
    while (lines.next(line, is_wanted)) {
      while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
      if (!line.empty() && line.front() != '#') return true;
    }
    return false;
  };
  const auto always = [] { return true; };
  if (!next(header, always) || !next(first, always))
    throw InputError("--points " + request.points +
                     ": holds no points: a line with the keys, then a line for each point");
  study::Study study = study::load_study(
      request.model.model, {request.model.overrides, request.model.plugins, header + "\n" + first + "\n", horizon_of});
  if (study.plan.follow() != study::Follow::no)
    throw InputError("study.follow: points given one by one are not a sweep; set it to false");
  study::check_streamed_points(study);
  const study::Layout layout = streamed_layout(study);
  if (request.results != "-") {
    to.open(request.results, std::ios::binary);
    if (!to) throw InputError("--results " + request.results + ": cannot be written");
  }
  std::ostream& out = request.results == "-" ? std::cout : to;
  watch_for_interruption();
  const auto goes_on = [] { return interruption() == nullptr; };
  bool has_first = true;
  const auto next_point = [&](std::string& line, const std::function<bool()>& is_wanted) {
    if (!has_first) return next(line, is_wanted);
    has_first = false;
    line = first;
    return true;
  };
  std::int64_t answered = -1;  // The first line holds the names.
  const auto respond = [&](const std::string& line) {
    ++answered;
    out << line << '\n' << std::flush;
    if (!out) throw RunError("--results " + request.results + ": cannot be written");
  };
  const std::int64_t failed = study::answer(
      study, layout, request.threads > 0 ? request.threads : study::processor_count(), {next_point, respond, goes_on});
  if (interruption() == nullptr) {
    if (failed > 0)
      log::warning(std::to_string(failed) + " of " + std::to_string(answered) +
                   " points have no results; their rows give the reasons");
    return failed == 0 || failed < answered ? kDone : kFailed;
  }
  log::error(std::string("interrupted by ") + interruption() + "; " +
             (request.results == "-" ? "standard output" : request.results) + " holds the rows of finished points");
  return kFailed;
}

}  // namespace butee::app::studies
